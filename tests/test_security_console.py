"""The console of a robot that has a pairing key stays shut; only the strap and an order with the key open it."""

import pytest

from hil_sim.worlds import cpython, micropython
from hil_sim.worlds.costs import BOOT_US
from tests.slot_bench import record, said, slot_bench, small

WORLDS = pytest.mark.parametrize("execute", [cpython.execute, micropython.execute], ids=["cpython", "micropython"])
KEY = bytes(36)  # whatever it holds: a damaged key shuts the console too
FAILS = {"firmware/main.py": b"def run(loud, is_new, settled):\n    settled()\n    raise ValueError('bad')\n"}
LEAVES = {"firmware/main.py": b"def run(loud, is_new, settled):\n    raise KeyboardInterrupt\n"}


def keyed_bench(program, execute=cpython.execute, boot=None):
    """Return a bench with that program in slot a, and a key."""
    bench = slot_bench({"a": program}, boot, execute)
    bench.board.flash.store("key", KEY)
    return bench


@WORLDS
def test_ctrl_c_does_nothing_on_a_robot_with_a_key(execute):
    bench = keyed_bench(small("a"), execute)

    for _ in range(5):
        bench.run(0.1)
        bench.world.interrupt()
    bench.run(1)

    assert said(bench) == ["a", "softrig: slot a is healthy"]
    assert bench.world.resets == 0
    bench.close()


@WORLDS
def test_ctrl_c_opens_the_console_of_a_robot_without_one(execute):
    bench = slot_bench({"a": small("a")}, execute=execute)
    bench.run(0.5)

    bench.world.interrupt()
    bench.run(1)

    assert said(bench)[-1] == "softrig: service"
    bench.close()


@WORLDS
def test_ctrl_c_while_the_outputs_are_switched_off_after_a_reset_does_nothing(execute):
    bench = slot_bench({"a": small("a")}, execute=execute)

    bench.clock.run_until(BOOT_US + 1_000)
    bench.world.interrupt()
    bench.run(0.5)

    assert said(bench) == ["a", "softrig: slot a is healthy"]
    assert bench.crashes == []
    bench.close()


@WORLDS
def test_a_program_that_fails_is_followed_by_a_reset_not_by_the_console(execute):
    bench = keyed_bench(FAILS, execute)

    bench.run(0.4)

    assert bench.world.resets > 1
    assert bench.crashes == []
    bench.close()


def test_what_the_program_failed_of_is_said_before_the_reset():
    bench = keyed_bench(FAILS)

    bench.run(0.2)

    assert any("bad" in line for line in said(bench))
    bench.close()


@WORLDS
def test_a_program_that_was_ordered_to_opens_the_console_once(execute):
    bench = keyed_bench(LEAVES, execute)

    bench.run(0.9)

    assert said(bench) == ["softrig: service"]
    assert bench.world.resets == 1
    bench.close()


def test_the_strap_opens_the_console_of_any_robot():
    bench = keyed_bench(small("a"), boot=record(0))
    bench.board.gpio.sources[22] = lambda: 0

    bench.run(1)

    assert said(bench) == ["softrig: service"]
    bench.close()
