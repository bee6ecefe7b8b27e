"""Machine code is loaded while a bench is built, never later: the loader would lose a Ctrl-C, or abort on it."""

import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from hil_sim import assembly
from hil_sim.link import open_link
from hil_sim.physics.compiled import prepare

RUN_A_HOT_SECOND = """
import sys
from numba.core.caching import Cache
from hil_sim.link import open_link
from host.robot import Robot

link = open_link(sys.argv[1])
loaded, load = [], Cache.load_overload
Cache.load_overload = lambda cache, *rest: loaded.append(cache._name) or load(cache, *rest)
with Robot(link) as robot:
    robot.connect()
    robot.subscribe(50)
    robot.arm()
    robot.fire(sys.argv[2:], duty_permille=600, hold_ms=500)
    for _ in robot.listen(1000):
        link.observer.observe(), link.observer.snapshot()
print(loaded)
"""


@pytest.mark.parametrize("robot", ["circular A B", "sphere-a A00m1 A10m1", "sphere-b A00m1 B10m1"])
def test_no_machine_code_is_loaded_once_the_line_is_open(robot):
    run = [sys.executable, "-c", RUN_A_HOT_SECOND, *f"sim:{robot}".split()]

    told = subprocess.run(run, capture_output=True, text=True, check=True)

    assert told.stdout == "[]\n"


def test_an_interrupt_while_the_bench_is_built_is_felt_when_it_stands(monkeypatch):
    stood = []

    def built(address):
        signal.raise_signal(signal.SIGINT)
        stood.append(address)
        return bench(address)

    bench = assembly.assemble
    monkeypatch.setattr(assembly, "assemble", built)

    with pytest.raises(KeyboardInterrupt):
        open_link("sim:circular")
    assert len(stood) == 1


def test_a_second_interrupt_does_not_wait_for_the_bench(monkeypatch):
    def never_built(address):
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        pytest.fail("the second interrupt was not felt")

    monkeypatch.setattr(assembly, "assemble", never_built)

    with pytest.raises(KeyboardInterrupt):
        open_link("sim:circular")


def test_stale_code_that_another_process_drops_at_the_same_time_is_no_error(monkeypatch, tmp_path):
    gone = tmp_path / "ring.march-1.nbi"
    monkeypatch.setattr(Path, "glob", lambda folder, pattern: [gone] if pattern == "*.nbi" else [Path(__file__)])
    code = SimpleNamespace(co_filename="ring.py")
    entry = SimpleNamespace(
        signatures=[], stats=SimpleNamespace(cache_path=tmp_path), py_func=SimpleNamespace(__code__=code)
    )

    assert prepare(entry)
