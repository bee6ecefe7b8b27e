"""SPI and PWM as the firmware has them, on the board; the same in CPython and in real MicroPython."""

import pytest

from hil_sim.journal import SPI
from hil_sim.worlds import cpython, micropython
from hil_sim.worlds.costs import BOOT_US
from tests.bench_fakes import bench_of

SPI_ON_17 = "from machine import SPI\ncs = Pin(17, Pin.OUT, value=1)\nspi = SPI(0, 8_000_000)\n"
PWM = "from machine import PWM\n"


@pytest.fixture(autouse=True, params=[cpython, micropython], ids=["cpython", "micropython"])
def world(request, monkeypatch):
    """Each test runs in both worlds."""
    monkeypatch.setattr("tests.bench_fakes.EXECUTE", request.param.execute)


def run(tmp_path, main, **options):
    """Run a firmware for a while and return its bench, closed; `said` is what it printed, line by line."""
    bench = bench_of(tmp_path, main, **options)
    bench.clock.run_until(BOOT_US + 100_000)
    bench.close()
    bench.said = "".join(bench.world.console).split("\n")[:-1]
    return bench


STATUS = """
cs.value(0)
spi.write(b'\\x03\\x0e')
got = spi.read(1)
cs.value(1)
print(got)
"""


def test_the_can_controller_answers_on_the_board(tmp_path):
    assert run(tmp_path, SPI_ON_17 + STATUS).said == ["b'\\x80'"]


def test_a_buffer_is_filled_in_place(tmp_path):
    main = "b = bytearray(b'\\x03\\x0e\\x00')\ncs.value(0)\nspi.write_readinto(b, b)\ncs.value(1)\nprint(b[2])"

    assert run(tmp_path, SPI_ON_17 + main).said == ["128"]


def test_without_chip_select_nothing_answers(tmp_path):
    assert run(tmp_path, SPI_ON_17 + "print(spi.read(2))").said == ["b'\\x00\\x00'"]


def test_on_other_pins_nothing_answers(tmp_path):
    main = "spi = SPI(0, 8_000_000, sck=Pin(2), mosi=Pin(3), miso=Pin(4))" + STATUS

    assert run(tmp_path, SPI_ON_17 + main).said == ["b'\\x00'"]


ADC_PINS = "sck=Pin(14), mosi=Pin(15), miso=Pin(12)"


@pytest.mark.parametrize(
    ("pins", "low", "heard"), [(ADC_PINS, 13, 0x800), (ADC_PINS, 11, 0x400), ("", 13, 0), (ADC_PINS, 10, 0)]
)
def test_the_converters_answer_on_their_own_pins_of_the_second_bus(tmp_path, pins, low, heard):
    main = f"""
from machine import SPI
cs = Pin({low}, Pin.OUT, value=0)
spi = SPI(1, 1_000_000, {pins})
b = bytearray(b'\\x06\\x40\\x00')
spi.write_readinto(b, b)
print((b[1] & 15) << 8 | b[2])
while True: time.sleep_ms(5)
"""
    bench = bench_of(tmp_path, main)
    bench.board.adc.inputs.update({1: lambda: 1.65, 9: lambda: 0.825})
    bench.clock.run_until(BOOT_US + 10_000)
    bench.close()

    assert bench.world.console == [f"{heard}\n"]


def test_a_reset_ends_an_instruction_that_was_under_way(tmp_path):
    main = "if reset_cause() == 1:\n cs.value(0)\n spi.write(b'\\x90')\n reset()\nwhile True: time.sleep_ms(5)"
    bench = bench_of(tmp_path, SPI_ON_17 + main)
    chip = bench.board.can.can
    chip.flags.set(1)
    bench.clock.run_until(BOOT_US + 15_000)
    bench.close()

    assert not chip.registers[0x2C] & 1


def test_a_reset_lets_go_of_the_chip(tmp_path):
    main = "if reset_cause() == 1:\n cs.value(0)\n spi.write(b'\\x02')\n reset()\n" + STATUS

    assert run(tmp_path, SPI_ON_17 + main).said == ["b'\\x80'"]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("SPI(2)", "SPI(2) doesn't exist"),
        ("SPI(0, sck=Pin(3))", "bad SCK pin"),
        ("SPI(0, mosi=Pin(11))", "bad MOSI pin"),
        ("SPI(1, miso=Pin(16))", "bad MISO pin"),
        ("spi.write_readinto(b'ab', bytearray(1))", "buffers must be the same length"),
    ],
)
def test_what_the_port_refuses_is_refused_in_its_words(tmp_path, call, message):
    assert run(tmp_path, SPI_ON_17 + f"try: {call}\nexcept ValueError as error: print(error)").said == [message]


def test_a_transfer_costs_its_bits(tmp_path):
    main = "a = time.ticks_us()\nspi.write(bytes(100))\nprint(time.ticks_diff(time.ticks_us(), a))"

    assert run(tmp_path, SPI_ON_17 + main).said == [str(1 + 2 + -(-100 * 8_000_000 // 7_812_500))]


def test_what_goes_out_and_what_comes_in_are_in_the_journal(tmp_path):
    bench = run(tmp_path, SPI_ON_17 + STATUS, keep_journal=True)

    entries = [entry[2:] for entry in bench.journal.kept() if entry[1] == SPI]
    assert entries == [(0, b"\x03\x0e\x00\x00"), (0, b"\x00\x80")]


def test_the_port_rounds_as_it_was_measured(tmp_path):
    bench = run(
        tmp_path, PWM + "p = PWM(Pin(8), freq=50, duty_ns=1_500_000)\nprint(p.freq(), p.duty_ns(), p.duty_u16())"
    )

    assert bench.said == ["50 1500005 4915"]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("p.freq(1)", "freq too small"),
        ("p.freq(7)", "freq too small"),
        ("p.freq(100_000_000)", "freq too large"),
        ("p.duty_ns(25_000_000)", "duty larger than period"),
    ],
)
def test_pulses_that_the_port_refuses_are_refused_in_its_words(tmp_path, call, message):
    bench = run(tmp_path, PWM + f"p = PWM(8, freq=50)\ntry: {call}\nexcept ValueError as error: print(error)")

    assert bench.said == [message]


def test_a_duty_stays_when_the_frequency_changes(tmp_path):
    main = "p = PWM(Pin(8), 50, duty_ns=1_500_000)\np.freq(60)\nprint(p.freq(), abs(p.duty_ns() - 1_500_000) < 200)"

    assert run(tmp_path, PWM + main).said == ["60 True"]


def test_the_two_pins_of_a_slice_share_their_frequency(tmp_path):
    main = "p = PWM(Pin(8), freq=50, duty_u16=100)\nq = PWM(Pin(9), freq=100, duty_u16=200)\nprint(p.freq(), q.freq())"

    assert run(tmp_path, PWM + main).said == ["100 100"]


def test_full_duty_is_always_on(tmp_path):
    bench = run(tmp_path, PWM + "p = PWM(Pin(8), freq=50, duty_u16=65535)\nprint(p.duty_u16())")

    counter, channel = bench.board.pulses.of(8)
    assert counter.width_us(channel) == counter.period_us
    assert bench.said == ["65535"]


def test_nothing_is_put_out_before_both_are_set(tmp_path):
    bench = run(tmp_path, PWM + "p = PWM(Pin(8))\np.duty_u16(1000)")

    assert not bench.board.pulses.of(8)[0].enabled


def test_a_servo_on_the_board_follows_the_pulses(tmp_path):
    bench = run(tmp_path, PWM + "p = PWM(Pin(8), freq=50, duty_ns=2_000_000)\nwhile True: time.sleep_ms(5)")

    assert bench.board.servos[8].commanded_deg(bench.clock.now_us) == pytest.approx(45, abs=0.01)


@pytest.mark.parametrize("end", ["p.deinit()", "Pin(8, Pin.IN)", "reset()"])
def test_a_servo_goes_limp_when_its_pulses_end(tmp_path, end):
    main = f"if reset_cause() == 1:\n p = PWM(Pin(8), freq=50, duty_ns=2_000_000)\n time.sleep_ms(60)\n {end}\n"
    bench = bench_of(tmp_path, PWM + main + "while True: time.sleep_ms(5)")

    bench.clock.run_until(400_000)
    bench.close()

    assert bench.board.servos[8].commanded_deg(bench.clock.now_us) is None


def test_every_setting_of_a_pin_is_in_the_journal(tmp_path):
    def trace(ns):
        return run(tmp_path, PWM + f"p = PWM(Pin(8), freq=50, duty_ns={ns})", keep_journal=True).trace_sha256()

    assert trace(1_500_000) == trace(1_500_000)
    assert trace(1_500_000) != trace(1_600_000)
