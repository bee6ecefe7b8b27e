"""Board, body and firmware in lock-step: the same run, whoever looks and however often."""

import pytest

from tests.bench_fakes import bench_of

CYCLING = """
begin()
uart = UART(0, baudrate=115200, tx=Pin(0), rx=Pin(1))
while True:
    for output in range(3):
        set_output(output, 200 + 100 * output)
        beat_for(37)
        set_output(output, 0)
        uart.write(bytes((output,)) + (uart.read() or b""))
"""


def test_two_runs_leave_the_same_trace(tmp_path):
    traces = []
    for _ in range(2):
        bench = bench_of(tmp_path, CYCLING)
        bench.board.host_write(b"hello")
        bench.run(1.0)
        traces.append(bench.trace_sha256())
        bench.close()

    assert traces[0] == traces[1]


def test_a_host_that_looks_all_the_time_changes_nothing(tmp_path):
    once, often = bench_of(tmp_path, CYCLING), bench_of(tmp_path, CYCLING)

    once.run(1.0)
    for _ in range(7919):
        often.clock.run_until(often.clock.now_us + 113)
        often.observe()
        often.board.uart.host_read(often.clock.now_us)
    often.clock.run_until(1_000_000)

    assert often.trace_sha256() == once.trace_sha256()
    assert often.plant.calls == once.plant.calls


def test_one_byte_more_from_the_host_changes_the_trace(tmp_path):
    traces = []
    for word in (b"hello", b"hellp"):
        bench = bench_of(tmp_path, "while True: time.sleep_ms(5)")
        bench.board.host_write(word)
        bench.run(0.1)
        traces.append(bench.trace_sha256())
        bench.close()

    assert traces[0] != traces[1]


def test_the_body_is_advanced_every_5_ms_and_at_each_change_of_a_gate(tmp_path):
    bench = bench_of(tmp_path, "begin()\nbeat.toggle()\ntime.sleep_ms(13)\nset_output(0, 500)\nbeat_for(1000)")

    bench.run(0.1)

    times_us = [sum(call[0] for call in bench.plant.calls[: n + 1]) for n in range(len(bench.plant.calls))]
    assert [time_us for time_us in times_us if time_us % 5000 == 0] == list(range(5000, 100_001, 5000))
    assert bench.coil("A").on_at_us in times_us
    bench.close()


def test_power_follows_the_duty_and_the_resistances(tmp_path):
    bench = bench_of(tmp_path, "begin()\nbeat.toggle()\nset_output(0, 500)\nbeat_for(1000)")

    bench.run(0.1)

    duty = 2048 / 4096
    current_a = 2.0 / (9.5 + 0.5 + 0.02)
    assert bench.plant.calls[-1][1][0] == pytest.approx(current_a**2 * 9.5 * duty)
    assert bench.plant.calls[-1][1][1:] == [0.0] * 7
    bench.plant.resistance[0] = 4.5
    bench.run(0.01)
    assert bench.plant.calls[-1][1][0] == pytest.approx((2.0 / 5.02) ** 2 * 4.5 * duty)
    bench.close()


def test_the_books_of_a_coil_add_up(tmp_path):
    main = """
begin()
beat.toggle()
for permille in (500, 0, 1000):
    set_output(0, permille)
    beat_for(100)
beat_for(1000)
"""
    bench = bench_of(tmp_path, main)

    bench.run(0.5)

    coil = bench.coil("A")
    assert [duty for _, duty in coil.history] == [0.5, 0.0, 1.0]
    assert coil.on_us(500_000) == coil.history[1][0] - coil.history[0][0] + 500_000 - coil.history[2][0]
    assert coil.energy_j == pytest.approx((coil.peak_degc - 25) / 10)
    bench.close()


def test_the_monitor_sees_the_current_of_the_coils(tmp_path):
    main = """
begin()
beat.toggle()
i2c.writeto_mem(0x40, 0x00, bytes((0x40, 0x3F)))  # shunt 8244 us, bus 140 us
i2c.writeto_mem(0x40, 0x05, bytes((0x02, 0x00)))  # 0.5 mA a bit on 20 mohm
for permille in (0, 1000, 500):
    set_output(0, permille)
    beat_for(30)
    print(int.from_bytes(i2c.readfrom_mem(0x40, 4, 2), "big"), int.from_bytes(i2c.readfrom_mem(0x40, 2, 2), "big"))
"""
    bench = bench_of(tmp_path, main)

    bench.run(0.2)

    current_ma = 2000 / 10.02
    read = [tuple(map(int, line.split())) for line in bench.world.console]
    expected_ma = [0, current_ma, current_ma / 2]
    assert [current / 2 for current, _ in read] == pytest.approx(expected_ma, rel=0.04)  # a conversion is 12.6 periods
    assert read[0][1] == 1600
    assert read[1][1] * 1.25 == pytest.approx(2000 - 0.02 * current_ma, abs=1.25)
    bench.close()


def test_a_short_conversion_of_a_pulsed_current_aliases(tmp_path):
    """PWM and monitor are not synchronous: single conversions scatter, their mean is right."""
    main = """
begin()
beat.toggle()
i2c.writeto_mem(0x40, 0x00, bytes((0x40, 0x07)))  # 140 us, no average
i2c.writeto_mem(0x40, 0x05, bytes((0x02, 0x00)))
set_output(0, 500)
for _ in range(200):
    beat_for(1)
    print(int.from_bytes(i2c.readfrom_mem(0x40, 4, 2), "big"))
"""
    bench = bench_of(tmp_path, main)

    bench.run(2)

    read = [int(line) / 2 for line in bench.world.console]
    assert min(read) == 0
    assert max(read) == pytest.approx(2000 / 10.02, abs=1)
    assert sum(read) / len(read) == pytest.approx(1000 / 10.02, rel=0.1)
    bench.close()


def test_the_supply_is_seen_also_while_it_is_switched_off(tmp_path):
    bench = bench_of(tmp_path, "time.sleep_ms(10)\nprint(i2c.readfrom_mem(0x40, 2, 2))")

    bench.run(0.1)

    assert bench.world.console == [f"{(1600).to_bytes(2, 'big')}\n"]
    bench.close()


def test_the_snapshot_names_the_duty_of_each_coil(tmp_path):
    bench = bench_of(tmp_path, "begin()\nbeat.toggle()\nset_output(1, 250)\nbeat_for(1000)")

    bench.run(0.1)

    assert bench.snapshot()["coils"]["B"]["duty"] == 0.25
    assert bench.snapshot()["coils"]["A"]["duty"] == 0
    bench.close()
