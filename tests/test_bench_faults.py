"""Faults of the netlist on a bench with hardly any firmware: what breaks, and where the current goes."""

import pytest

from hil_sim.faults.happening import BEGUN, MENDED, schedule
from hil_sim.faults.table import CELL, JOINT, TABLE
from hil_sim.journal import FAULT
from tests.bench_fakes import bench_of

HEATING = "begin()\nbeat.toggle()\nset_output(0, 1000)\n"
FOR_EVER = "while True: beat_for(1000)"
WATCHED = """
def word(register, value): i2c.writeto_mem(0x40, register, bytes((value >> 8, value & 255)))
word(0, 0x42AF)  # a value every 9.8 ms
word(7, 2400)    # 300 mA in 20 mohm
word(6, 0x8001)  # shunt over limit, latched
"""
CONVERSIONS_US = 2 * 9_792  # the one in which it happens, and one that sees nothing else
EACH_A = 2.0 / (9.5 + 0.5 + 0.02)


@pytest.fixture
def bench(tmp_path):
    bench = bench_of(tmp_path, WATCHED + HEATING + FOR_EVER, keep_journal=True)
    bench.run(0.2)
    assert bench.supply.current_a == pytest.approx(EACH_A)
    yield bench
    bench.close()


def test_a_shorted_coil_takes_the_current_of_its_wires_and_no_heat(bench):
    warm = bench.coil("A").peak_degc
    schedule(bench, bench.clock.now_us, "coil-short:A")

    bench.run(0.0001)
    assert bench.supply.current_a == pytest.approx(2.0 / (0.02 + 0.5 + 0.02), rel=1e-3)
    assert bench.supply.power_w[0] < 0.001 * 3.7**2 * 9.5
    bench.run(0.1)

    assert bench.coil("A").peak_degc == pytest.approx(warm, abs=0.01)


def test_alert_opens_the_outputs_without_the_firmware(bench):
    schedule(bench, 300_000, "coil-short:A")

    bench.run(0.3)

    assert 300_000 < bench.coil("A").off_at_us <= 300_000 + CONVERSIONS_US
    assert not bench.board.enabled
    assert bench.world.running


def test_without_the_monostable_alert_and_the_emergency_stop_reach_nothing(bench):
    for name in ("monostable-bypassed", "coil-short:A", "estop-open"):
        schedule(bench, 300_000, name)

    bench.run(0.3)

    assert bench.coil("A").on_at_us > 480_000  # it follows the heartbeat


def test_without_the_monostable_a_reset_enables_the_outputs(tmp_path):
    """The hazard that the monostable is there for: the pull-down of a pin at rest says "on" to an active-low OE."""
    bench = bench_of(tmp_path, HEATING + FOR_EVER)
    bench.run(0.2)
    for name in ("monostable-bypassed", "contactor-welded", "hang"):
        schedule(bench, 300_000, name)
    bench.run(0.2)

    bench.board.reset_processor(3)

    assert bench.board.enabled
    assert bench.coil_gate("A") == 1.0
    bench.run(1.0)
    assert bench.coil_gate("A") == 1.0
    bench.close()


def test_with_the_monostable_a_reset_leaves_the_outputs_open_although_the_contactor_is_welded(bench):
    for name in ("contactor-welded", "hang"):
        schedule(bench, 300_000, name)

    bench.run(0.3)

    assert bench.coil("A").off_at_us <= 350_000


def test_a_stuck_mosfet_heats_its_coil_until_the_contactor_opens(bench):
    stuck = schedule(bench, 300_000, "mosfet-stuck:B")
    schedule(bench, 350_000, "reset")  # which drops PWR_EN

    bench.run(0.16)

    assert (bench.coil("B").on_at_us, bench.coil("B").off_at_us) == (300_000, 350_000)
    stuck.mend()


def test_a_welded_contactor_and_a_stuck_mosfet_leave_nothing_to_switch_off_with(bench):
    for name in ("contactor-welded", "mosfet-stuck:B"):
        schedule(bench, 300_000, name)
    schedule(bench, 350_000, "reset")

    bench.run(0.16)

    assert bench.coil_gate("B") == 1.0


def test_a_supply_that_sags_gives_less_and_comes_back(bench):
    schedule(bench, 300_000, "supply-sag:40", for_us=50_000)

    bench.run(0.11)
    assert bench.supply.current_a == pytest.approx(0.6 * EACH_A)
    bench.run(0.05)

    assert bench.supply.current_a == pytest.approx(EACH_A)


def test_a_brown_out_ends_the_firmware_and_it_starts_anew(bench):
    schedule(bench, 300_000, "brown-out", for_us=50_000)

    bench.run(0.14)
    assert not bench.world.running
    assert bench.board.pwm[0x60].outputs[0] == (0.0, 0.0)
    bench.run(0.2)

    assert bench.world.running
    assert bench.coil_gate("A") == 1.0  # this firmware heats again; ours asks for `arm`


@pytest.mark.parametrize("task", ["control", "receive", "send"])
def test_a_task_hangs_when_it_next_comes_to_its_line(tmp_path, task):
    uart = "uart = UART(0)\ndef serve(): uart.read(); beat.toggle(); i2c.readfrom(0x40, 2); uart.write(b'x')\n"
    bench = bench_of(tmp_path, uart + HEATING + "while True: serve(); time.sleep_ms(5)")
    schedule(bench, 300_000, f"hang:{task}")

    bench.run(0.299)
    assert bench.coil_gate("A") == 1.0
    bench.run(0.2)

    assert bench.coil_gate("A") == 0.0
    assert bench.world.running is False
    bench.close()


def test_a_fault_and_its_end_stand_in_the_journal(bench):
    schedule(bench, 300_000, "i2c-nack:3", for_us=1000)

    bench.run(0.2)

    noted = [(at_us, which, data) for at_us, kind, which, data in bench.journal.kept() if kind == FAULT]
    assert noted == [(300_000, BEGUN, b"i2c-nack:3"), (301_000, MENDED, b"i2c-nack:3")]


def test_a_mended_fault_leaves_the_bench_as_it_was(tmp_path):
    """Each fault that can end and is of every robot is begun and ended; nothing of the board differs afterwards."""
    bench = bench_of(tmp_path, HEATING + FOR_EVER)
    bench.run(0.2)
    values = {"LABEL": "A", "TASK": ""}
    of_all = [row for row in TABLE if row.ends and not row.of and row.argument not in (JOINT, CELL)]
    for fault in (row for row in of_all if row.name != "brown-out"):
        form = fault.argument.form
        argument = f":{values.get(form, str(max(1, round(fault.argument.least))))}" if form else ""
        schedule(bench, bench.clock.now_us, fault.name + argument, for_us=1000, seed="1")
        bench.run(0.1)
        assert bench.supply.current_a == pytest.approx(EACH_A), fault.name

    board = bench.board
    assert board.bus.troubles == board.uart.inward.noises == board.uart.outward.noises == []
    assert (board.uart.inward.delay_us, board.uart.inward.baud, board.uart.connected) == (0, 115_200, True)
    assert bench.crashes == []
    bench.close()


def test_what_a_fault_draws_depends_on_its_seed_alone(tmp_path):
    heard = []
    for seed, read_every_s in (("1", 0.001), ("1", 0.05), ("2", 0.05)):
        bench = bench_of(
            tmp_path, "uart = UART(0, 115200)\nfor _ in range(99): uart.write(b'0123456789'); time.sleep_ms(5)"
        )
        schedule(bench, 0, "line-flip:100", seed=seed)
        data = b""
        for _ in range(round(0.6 / read_every_s)):
            bench.run(read_every_s)
            data += bench.board.uart.host_read(bench.clock.now_us)
        heard.append(data)
        bench.close()

    assert heard[0] == heard[1] != heard[2]


MISTAKES = [
    ("hang:everything", r"fault hang:everything: after the colon stands receive or control or send"),
    ("i2c-nack", r"fault i2c-nack: write i2c-nack:COUNT"),
    ("i2c-nack:many", r"after the colon stands COUNT from 1 to 1e\+06"),
    ("supply-sag:101", r"after the colon stands PERCENT from 1 to 100"),
    ("cable-cut:3", r"fault cable-cut:3: takes nothing"),
    ("imu-stuck", "this robot has no attitude sensor"),
]


@pytest.mark.parametrize(("name", "told"), MISTAKES)
def test_a_name_that_cannot_be_says_what_is_allowed(bench, name, told):
    with pytest.raises(ValueError, match=told):
        schedule(bench, bench.clock.now_us, name)


def test_what_happens_in_an_instant_cannot_be_ended(bench):
    with pytest.raises(ValueError, match="fault reset does not last: it cannot end"):
        schedule(bench, 300_000, "reset", for_us=1)
