"""The serial line: ten bits a byte to the microsecond, and buffers that end."""

from hypothesis import given
from hypothesis import strategies as st

from hil_sim.devices.uart import Uart
from hil_sim.devices.wire import Wire


def open_uart(baud: int = 115_200) -> Uart:
    uart = Uart(115_200)
    uart.open(baud, 0)
    return uart


def test_a_byte_arrives_ten_bits_after_it_was_sent():
    wire = Wire(115_200)

    wire.send(b"ab", now_us=1000)

    assert wire.take(1086) == b""
    assert wire.take(1087) == b"a"  # 86.8 us
    assert wire.take(1173) == b""
    assert wire.take(1174) == b"b"  # 173.6 us


def test_bytes_queue_behind_each_other_without_drift():
    wire = Wire(115_200)

    arrival_us = [wire.send(b"x", now_us=0) for _ in range(11_520)]

    assert arrival_us[-1] == 1_000_000


def test_an_idle_line_starts_anew():
    wire = Wire(115_200)
    wire.send(b"x", now_us=0)

    assert wire.send(b"y", now_us=500) == 587


@given(st.lists(st.tuples(st.integers(0, 3000), st.binary(min_size=1, max_size=40)), max_size=20), st.data())
def test_however_often_one_looks_the_same_bytes_arrive_at_the_same_times(writes, data):
    once, often, got_once, got_often = Wire(57_600), Wire(57_600), b"", b""
    now_us = 0
    for pause_us, chunk in writes:
        now_us += pause_us
        assert once.send(chunk, now_us) == often.send(chunk, now_us)
        got_often += often.take(now_us + data.draw(st.integers(0, 2000)))
        now_us += 2000

    got_once += once.take(now_us)
    got_often += often.take(now_us)

    assert got_once == got_often


def test_the_receive_buffer_keeps_256_bytes_and_counts_the_rest():
    uart = open_uart()

    uart.host_write(bytes(300), 0)

    assert uart.any(1_000_000) == 256
    assert uart.overruns == 44
    assert uart.read(1000, 1_000_000) == bytes(256)


def test_a_buffer_that_is_read_in_time_loses_nothing():
    uart = open_uart()
    uart.host_write(bytes(300), 0)

    got = uart.read(1000, 20_000) + uart.read(1000, 40_000)

    assert len(got) == 300
    assert uart.overruns == 0


def test_the_transmit_buffer_takes_256_bytes_and_then_what_has_left_it():
    uart = open_uart()

    assert uart.write(bytes(300), 0) == 256
    assert uart.write(b"x", 0) == 0
    assert uart.write(bytes(300), 869) == 10


def test_bytes_that_arrive_before_the_port_is_open_are_lost():
    uart = Uart(115_200)
    uart.host_write(b"early", 0)

    uart.open(115_200, 1000)
    uart.host_write(b"late", 1000)

    assert uart.read(100, 10_000) == b"late"


def test_a_reset_cuts_off_what_is_still_on_its_way_to_the_host():
    uart = open_uart()
    uart.write(b"abcdef", 0)

    uart.close(300)

    assert uart.host_read(10_000) == b"abc"


def test_a_cut_cable_loses_what_is_on_it_and_what_is_sent_until_it_is_joined():
    uart = open_uart()
    uart.host_write(b"abc", 0)
    uart.write(b"123", 0)

    uart.cut(200)
    uart.host_write(b"lost", 300)
    uart.write(b"lost", 300)
    uart.join(5000)
    uart.host_write(b"d", 5000)
    uart.write(b"4", 5000)

    assert uart.read(100, 10_000) == b"abd"
    assert uart.host_read(10_000) == b"124"


def test_a_wrong_baud_rate_makes_noise_of_every_byte():
    uart = open_uart(baud=9600)

    uart.host_write(b"hello", 0)
    heard = uart.read(100, 100_000)

    assert len(heard) == 5
    assert heard != b"hello"
    assert uart.misread == 5
