"""The hardware's own protection: what switches the coils off when the firmware cannot."""

import pytest

from hil_sim.faults.happening import schedule
from tests.bench_fakes import bench_of

HEATING = "begin()\nbeat.toggle()\nset_output(0, 500)\n"
FOR_EVER = "while True: beat_for(1000)"


@pytest.fixture
def heating(tmp_path):
    bench = bench_of(tmp_path, HEATING + FOR_EVER)
    bench.run(0.2)
    assert bench.coil_gate("A") == pytest.approx(0.5)
    yield bench
    bench.close()


def test_a_heated_coil_warms_and_its_neighbour_does_not(heating):
    heating.run(1.0)

    assert heating.coil("A").peak_degc > 26
    assert heating.coil("B").peak_degc == 25.0


def test_a_hang_opens_the_outputs_50_ms_after_the_last_heartbeat(heating):
    schedule(heating, 300_000, "hang")

    heating.run(1.0)

    off_us = heating.coil("A").off_at_us
    assert 345_000 <= off_us <= 350_000  # the last edge came at most one beat of 5 ms before the hang
    assert heating.coil_gate("A") == 0


def test_a_crash_leaves_the_outputs_to_the_monostable(tmp_path):
    bench = bench_of(tmp_path, HEATING + "beat_for(100)\nraise RuntimeError")

    bench.run(1.0)

    crash_us = bench.crashes[0].time_us
    assert crash_us + 44_990 <= bench.coil("A").off_at_us <= crash_us + 50_000
    bench.close()


def test_the_emergency_stop_opens_the_outputs_at_once(heating):
    schedule(heating, 300_000, "estop-open")

    heating.run(1.0)

    assert heating.coil("A").off_at_us == 300_000


def test_the_emergency_stop_can_be_closed_again(heating):
    schedule(heating, 300_000, "estop-open")
    schedule(heating, 400_000, "estop-close")

    heating.run(1.0)

    assert heating.coil("A").on_at_us == 400_000


def test_a_reset_switches_the_supply_off_while_the_chip_drives_on(tmp_path):
    main = """
if reset_cause() == 1:
    begin()
    beat.toggle()
    set_output(0, 500)
    beat_for(100)
    reset()
beat_for(1000)
"""
    bench = bench_of(tmp_path, main)

    bench.run(0.3)

    assert bench.world.resets == 1
    assert bench.board.pwm[0x60].outputs[0] == (0.0, 0.5)
    assert bench.coil_gate("A") == 0
    bench.close()


def test_a_power_cycle_makes_the_chips_forget(heating):
    schedule(heating, 300_000, "power-cycle")

    heating.run(0.11)

    assert heating.board.pwm[0x60].outputs == [(0.0, 0.0)] * 16
    assert heating.coil("A").off_at_us == 300_000


def test_an_unknown_fault_is_refused_with_those_there_are(heating):
    with pytest.raises(ValueError, match=r"no fault 'hung': known are .*; did you mean hang\?"):
        schedule(heating, 300_000, "hung")


def test_a_fault_in_the_past_is_refused(heating):
    with pytest.raises(ValueError, match="time 1 us has passed"):
        schedule(heating, 1, "hang")


def test_a_broken_thermistor_reads_its_rail(tmp_path):
    bench = bench_of(tmp_path, "time.sleep_ms(50)\nprint(ADC(Pin(26)).read_u16())")
    schedule(bench, 40_000, "thermistor-open")

    bench.run(0.1)

    assert bench.world.console == ["65535\n"]
    bench.close()


def test_a_silent_monitor_does_not_answer(tmp_path):
    bench = bench_of(tmp_path, "time.sleep_ms(50)\ntry: i2c.readfrom(0x40, 2)\nexcept OSError: print('EIO')")
    schedule(bench, 40_000, "monitor-dead")

    bench.run(0.1)

    assert bench.world.console == ["EIO\n"]
    bench.close()
