"""World T1: the firmware's files run in this process, each board in its own private import world.

`machine` and `time` are the bench's own modules, so an access to the hardware is a call. A reset drops the modules of
the firmware and imports them again.
"""

from hil_sim.worlds.files import Files
from hil_sim.worlds.machine import machine_module, time_module
from hil_sim.worlds.modules import Modules, gc_module, micropython_module, sys_module
from hil_sim.worlds.world import CTRL_C, Life

RUNS = ("boot.py", "main.py")


def execute(life: Life) -> None:
    """Run the firmware of one life of the processor."""
    given = {
        "machine": machine_module(life),
        "time": time_module(life),
        "micropython": micropython_module(life.heed),
        "gc": gc_module(),
        "sys": sys_module(life.say),
    }
    modules = Modules(life.image, given, life.say, Files(life).open)
    for path in RUNS:
        life.heed(CTRL_C)
        modules.run(path)
