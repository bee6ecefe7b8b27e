"""Which program a board runs: the slot of its boot record, a new one on trial, and the way back from a bad one."""

import pytest

from firmware.core import Core
from firmware.profile import Profile
from firmware.trial import Trial
from hil_sim.worlds import cpython, micropython
from host.deploy.bootrecord import BootRecord
from protocol import codes, messages
from tests.firmware_bench import Table
from tests.slot_bench import CONFIRMED, NOWHERE, PROFILE, REAL, fields, record, said, slot_bench, small

WORLDS = pytest.mark.parametrize("execute", [cpython.execute, micropython.execute], ids=["cpython", "micropython"])
BOTH = {"a": small("a"), "b": small("b")}


def program(run: str) -> dict[str, bytes]:
    """Return the files of a slot whose program is one function body."""
    return {"firmware/main.py": f"import time\ndef run(loud, is_new, settled):\n    {run}\n".encode()}


def settled(bench, seconds: float = 1.0):
    """Run a bench for a while and return it, closed."""
    bench.run(seconds)
    bench.close()
    return bench


@WORLDS
def test_a_board_without_a_record_runs_slot_a_and_writes_nothing(execute):
    bench = settled(slot_bench(BOTH, execute=execute))

    assert said(bench) == ["a", "softrig: slot a is healthy"]
    assert bench.board.flash.operations == 0


@WORLDS
def test_a_new_program_confirms_its_slot(execute):
    bench = settled(slot_bench(BOTH, record(1, tries=3, fallback=0), execute))

    assert said(bench) == ["b", "softrig: slot b is healthy"]
    assert fields(bench) == (1, CONFIRMED, 0, 0)


def test_the_firmware_confirms_itself_after_five_healthy_seconds():
    bench = slot_bench({"a": small("a"), "b": REAL}, record(1, tries=3, fallback=0))

    bench.run(4.9)
    assert fields(bench) == (1, 2, 0, 0)
    bench.run(1.0)

    assert fields(bench) == (1, CONFIRMED, 0, 0)
    assert bench.world.resets == 0
    bench.close()


BAD = {
    "raises at import": {"firmware/main.py": b"raise ValueError('bad')"},
    "is not there": {},
    "is no Python": {"firmware/main.py": b"def run(:"},
    "raises": program("raise ValueError('bad')"),
    "ends": program("return"),
    "hangs": program("while True: time.sleep_ms(5)"),
    "trips at once": {**REAL, "robot.json": REAL["robot.json"].replace(b'"chip": 96', b'"chip": 98')},
}


@WORLDS
@pytest.mark.parametrize("what", BAD)
def test_a_bad_program_is_tried_three_times_and_rolled_back_by_itself(what, execute):
    slots = {"a": small("a"), "b": BAD[what]}

    bench = settled(slot_bench(slots, record(1, tries=3, fallback=0), execute), 3 * 10 + 3)

    assert said(bench)[-1] == "softrig: slot a is healthy"
    assert fields(bench) == (0, CONFIRMED, NOWHERE, 0)
    assert bench.world.resets == 3


def test_a_program_that_dies_before_it_was_healthy_has_used_a_try():
    bench = slot_bench({"a": small("a"), "b": REAL}, record(1, tries=3, fallback=0))
    bench.run(3)
    bench.world.hang()

    bench.run(3)

    assert fields(bench) == (1, 1, 0, 0)
    bench.close()


def test_an_open_emergency_stop_is_not_the_programs_fault():
    bench = slot_bench({"a": small("a"), "b": REAL}, record(1, tries=3, fallback=0))
    bench.board.set_estop(False)

    bench.run(6)

    assert fields(bench) == (1, CONFIRMED, 0, 0)
    bench.close()


def test_a_bad_first_program_leaves_the_board_to_its_console():
    bench = settled(slot_bench({"a": program("raise ValueError")}, record(0, tries=3)), 4 * 9)

    assert said(bench)[-1] == "softrig: service"
    assert bench.world.resets == 3


@WORLDS
def test_the_service_mark_counts_once(execute):
    bench = slot_bench(BOTH, record(1, service=1), execute)
    bench.run(0.5)
    assert said(bench) == ["softrig: service"]
    assert not bench.board.powered

    bench.world.reset()
    settled(bench)

    assert said(bench)[1:2] == ["b"]


def test_the_strap_leaves_the_board_to_its_console():
    bench = slot_bench(BOTH, record(1))
    bench.board.gpio.sources[22] = lambda: 0

    settled(bench, 20)

    assert said(bench) == ["softrig: service"]
    assert bench.world.resets == 0  # and no watchdog


def test_ctrl_c_on_the_console_switches_off_and_asks_for_service():
    bench = slot_bench({"a": REAL})
    bench.run(1)

    bench.world.interrupt()
    settled(bench)

    assert said(bench) == ["softrig: service"]
    assert bench.world.resets == 1
    assert not bench.board.powered


def test_a_record_that_is_torn_in_both_copies_is_no_record():
    bench = slot_bench(BOTH, record(1)[:-1])
    bench.board.flash.store("boot.0", b"")

    assert said(settled(bench))[0] == "a"


def test_the_newer_copy_of_the_record_counts():
    bench = slot_bench(BOTH, record(1, sequence=7))
    bench.board.flash.store("boot.0", record(0, sequence=6))

    assert said(settled(bench))[0] == "b"


@WORLDS
@pytest.mark.parametrize("absurd", [{"slot": 7}, {"slot": 1, "tries": 3, "sequence": 0xFFFFFFFF}])
def test_a_record_that_cannot_be_is_none(absurd, execute):
    bench = settled(slot_bench(BOTH, record(**absurd), execute))

    assert said(bench)[0] == "a"
    assert bench.world.crashes == []
    assert BootRecord.newest([record(**absurd)]) is None


def test_a_slot_that_is_not_there_is_nothing_to_fall_back_to():
    bench = settled(slot_bench(BOTH, record(0, tries=0, fallback=9)))

    assert said(bench) == ["softrig: service"]


def test_a_slot_is_not_confirmed_while_coils_are_tested():
    """That writes the flash, which stops the processor for longer than the heartbeat may rest."""
    core = Core(Table(), Profile(PROFILE), boot=1)
    core.step(5, b"", 512)
    calls = []
    trial = Trial(True, lambda: calls.append(1))
    core.control.selftest.begin(0)
    assert not trial.over(6000, core)
    assert calls == []

    core.control.selftest.cancel()
    trial.over(6005, core)
    assert calls == [1]


@pytest.mark.parametrize("operation", range(1, 9))
@pytest.mark.parametrize("what", ["is not there", "is well"])
def test_a_power_cut_at_any_write_to_the_record_ends_in_a_program_that_lives(what, operation):
    slots = {"a": small("a"), "b": BAD[what] if what in BAD else small("b")}
    bench = slot_bench(slots, record(1, tries=2, fallback=0))
    bench.board.flash.cut_at = operation

    settled(bench, 40)

    assert said(bench)[-1] == f"softrig: slot {'a' if what in BAD else 'b'} is healthy"
    assert fields(bench)[:2] == (0 if what in BAD else 1, CONFIRMED)


@pytest.mark.parametrize("operation", range(1, 9))
def test_a_power_cut_loses_no_record_but_the_one_that_was_being_written(operation):
    bench = slot_bench({"a": small("a"), "b": {}}, record(1, tries=3, fallback=0))
    bench.board.flash.cut_at = operation
    copies = ("boot.0", "boot.1")
    sequences = []

    for _ in range(400):
        bench.run(0.1)
        there = [bench.board.flash.read(path) for path in copies if path in bench.board.flash.paths()]
        sequences.append(BootRecord.newest(there).sequence)
    bench.close()

    assert sequences == sorted(sequences)


def test_a_hung_program_is_restarted_within_the_short_period_once_it_has_confirmed_itself():
    bench = slot_bench({"a": small("a"), "b": REAL}, record(1, tries=3, fallback=0))
    bench.run(6)
    assert fields(bench) == (1, CONFIRMED, 0, 0)

    bench.world.hang()
    bench.run(0.3)

    assert bench.world.resets == 1
    bench.close()


@WORLDS
def test_boot_tells_the_program_of_a_chip_that_answers_but_is_not_off(execute):
    bench = slot_bench({"a": program("print(loud)\n    while True: time.sleep_ms(5)")}, execute=execute)
    chip = bench.board.pwm[0x61]
    chip.reset = lambda: None
    chip._store_count = lambda register, byte: None
    chip.registers[6 + 4 * 15 + 3] = 0

    settled(bench)

    assert said(bench) == [str(0x61)]


@WORLDS
def test_boot_switches_off_what_the_chips_were_driving_when_the_processor_was_reset(execute):
    bench = slot_bench(BOTH, execute=execute)
    bench.run(0.1)
    for chip in bench.board.pwm.values():
        chip.reset = lambda: None  # and the general call is lost on it
        chip.write(chip.address, bytes((0, 0x20)))
        chip.write(chip.address, bytes((6, 0, 0x10, 0, 0)))

    bench.world.reset()
    settled(bench, 0.1)

    for chip in bench.board.pwm.values():
        assert chip.registers[0] == 0x30
        assert all(high & 0x10 for high in chip.registers[9:70:4])


def test_a_chip_that_is_not_off_trips_the_core():
    core = Core(Table(), Profile(PROFILE), 1, loud=0x61)

    core.step(0, b"", 1024)

    assert (core.state, core.code) == (messages.TRIPPED, codes.CHIP)


@WORLDS
def test_boot_clocks_a_chip_free_that_holds_the_data_line(execute):
    """A reset in the middle of a read leaves a chip waiting for its clock, with the data line low."""
    bench = slot_bench(BOTH, execute=execute)
    write, clocks = bench.board.gpio.write, []
    bench.board.gpio.write = lambda pin, level: (clocks.append(level) if pin == 5 else None, write(pin, level))
    bench.board.gpio.sources[4] = lambda: int(clocks.count(1) >= 3)

    settled(bench)

    assert clocks == [0, 1] * 3
    assert said(bench)[0] == "a"
