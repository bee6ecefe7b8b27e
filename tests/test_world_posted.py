"""What firmware orders without an answer, pins, watchdog, sleep: done at its time and in its order in both worlds."""

import pytest

from hil_sim.journal import PIN
from hil_sim.worlds import cpython, micropython
from hil_sim.worlds.costs import BOOT_US
from tests.bench_fakes import bench_of


@pytest.fixture(autouse=True, params=[cpython, micropython], ids=["cpython", "micropython"])
def world(request, monkeypatch):
    """Each test runs in both worlds."""
    monkeypatch.setattr("tests.bench_fakes.EXECUTE", request.param.execute)


def said(bench) -> list[str]:
    """Return what the firmware printed, line by line."""
    return "".join(bench.world.console).split("\n")[:-1]


def run(tmp_path, main):
    """Run a firmware for a while and return its bench, closed."""
    bench = bench_of(tmp_path, main, keep_journal=True)
    bench.clock.run_until(BOOT_US + 200_000)
    bench.close()
    return bench


def beats(bench) -> list[tuple[int, bytes]]:
    """Return when the heartbeat pin moved since the boot, and to what."""
    noted = bench.journal.kept()
    return [(time_us - BOOT_US, level) for time_us, kind, pin, level in noted if (kind, pin) == (PIN, 3)]


def test_the_clock_that_is_read_after_it_has_run_on_by_what_it_cost(tmp_path):
    main = """
wdt = WDT(timeout=1000)
begun = time.ticks_us()
beat.value(1); a = time.ticks_us()
wdt.feed(); b = time.ticks_us()
time.sleep_us(700); c = time.ticks_us()
time.sleep_ms(70); d = time.ticks_us()
time.sleep_us(-5); e = time.ticks_us()
time.sleep_us(0); f = time.ticks_us()
print([time.ticks_diff(x, begun) for x in (a, b, c, d, e, f)])
"""

    assert said(run(tmp_path, main)) == ["[2, 4, 705, 70706, 70708, 70710]"]


def test_what_firmware_orders_last_is_done_before_it_ends(tmp_path):
    bench = run(tmp_path, "beat.value(1)\ntime.sleep_ms(3)\nbeat.value(0)")

    (up_us, up), (down_us, down) = beats(bench)
    assert (up, down, down_us - up_us) == (b"\x01", b"\x00", 3001)
    assert [crash.time_us for crash in bench.crashes] == [BOOT_US + down_us]


def test_pins_move_when_they_are_set_and_not_when_the_next_answer_comes(tmp_path):
    bench = run(tmp_path, "for level in (1, 0, 1, 0):\n    beat.value(level)\n    time.sleep_ms(20)\nprint('done')")

    times_us = [time_us for time_us, _ in beats(bench)]
    assert [time_us - times_us[0] for time_us in times_us] == [0, 20_001, 40_002, 60_003]


def test_nothing_that_was_ordered_after_an_interrupted_sleep_is_done(tmp_path):
    main = """
try:
    time.sleep_ms(50)
    beat.value(1)
    time.ticks_us()
    print(beat.value())
except KeyboardInterrupt:
    print(beat.value(), time.ticks_us())
while True: time.sleep_ms(5)
"""
    bench = bench_of(tmp_path, main)
    bench.clock.run_until(BOOT_US + 20_000)
    bench.world.interrupt()
    bench.clock.run_until(BOOT_US + 100_000)
    bench.close()

    assert said(bench) == [f"0 {BOOT_US + 20_002}"]
