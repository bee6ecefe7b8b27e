"""PWM of the processor, and the servo that is driven with it."""

import pytest

from hil_sim.clock import Clock
from hil_sim.devices.pwm import PwmSlices
from hil_sim.devices.servo import Servo
from hil_sim.journal import Journal
from hil_sim.worlds.costs import BOOT_US
from tests.bench_fakes import bench_of

FRAME_US = 20_000.0


@pytest.fixture
def servo() -> Servo:
    return Servo()


@pytest.mark.parametrize(
    ("width_us", "angle_deg"), [(500, -90), (1000, -45), (1500, 0), (2500, 90), (450, -90), (2590, 90)]
)
def test_the_width_of_the_pulse_is_the_angle_within_the_range(servo, width_us, angle_deg):
    servo.pulsed(0, width_us, FRAME_US)

    assert servo.commanded_deg(width_us) == pytest.approx(angle_deg)


def test_a_servo_without_pulses_is_limp(servo):
    assert servo.commanded_deg(1_000_000) is None


@pytest.mark.parametrize(("width_us", "period_us"), [(399, FRAME_US), (2601, FRAME_US), (1500, 25_001), (1500, 3000)])
def test_what_is_no_servo_pulse_moves_nothing(servo, width_us, period_us):
    servo.pulsed(0, width_us, period_us)

    assert servo.commanded_deg(1_000_000) is None


def test_a_pulse_is_known_at_its_end(servo):
    servo.pulsed(0, 1500, FRAME_US)
    servo.pulsed(20_000, 2000, FRAME_US)

    assert servo.commanded_deg(21_999) == pytest.approx(0)
    assert servo.commanded_deg(22_000) == pytest.approx(45)


def test_a_change_within_the_dead_band_moves_nothing(servo):
    servo.pulsed(0, 1500, FRAME_US)
    servo.pulsed(20_000, 1504, FRAME_US)
    assert servo.commanded_deg(40_000) == pytest.approx(0)

    servo.pulsed(40_000, 1505, FRAME_US)

    assert servo.commanded_deg(60_000) == pytest.approx(0.45)


def test_a_servo_goes_limp_100_ms_after_its_last_pulse(servo):
    servo.pulsed(0, 1500, FRAME_US)
    servo.pulsed(40_000, 0, FRAME_US)

    assert servo.commanded_deg(139_999) == pytest.approx(0)
    assert servo.commanded_deg(140_000) is None


def test_two_changes_within_a_frame_leave_the_last(servo):
    servo.pulsed(20_000, 1000, FRAME_US)
    servo.pulsed(20_000, 2000, FRAME_US)

    assert servo.commanded_deg(25_000) == pytest.approx(45)


def test_a_new_level_is_taken_over_when_the_counter_wraps():
    clock, told = Clock(), []
    slices = PwmSlices(clock, Journal())
    slices.watch(8, lambda *pulses: told.append(pulses))
    counter, channel = slices.of(8)
    counter.div16, counter.top, counter.enabled = 16 * 100, 24_999, True  # 20 ms

    clock.run_until(30_000)
    counter.levels[channel] = 1875
    slices.connect(8)

    assert told == [(40_000, pytest.approx(1500), pytest.approx(20_000))]


PWM = "from machine import PWM\n"


def run(tmp_path, main, **options):
    bench = bench_of(tmp_path, PWM + main, **options)
    bench.clock.run_until(BOOT_US + 100_000)
    bench.close()
    return bench


def said(bench) -> list[str]:
    return "".join(bench.world.console).split("\n")[:-1]


def test_the_port_rounds_as_it_was_measured(tmp_path):
    bench = run(tmp_path, "p = PWM(Pin(8), freq=50, duty_ns=1_500_000)\nprint(p.freq(), p.duty_ns(), p.duty_u16())")

    assert said(bench) == ["50 1500005 4915"]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("p.freq(1)", "freq too small"),
        ("p.freq(7)", "freq too small"),
        ("p.freq(100_000_000)", "freq too large"),
        ("p.duty_ns(25_000_000)", "duty larger than period"),
    ],
)
def test_what_the_port_refuses_is_refused_in_its_words(tmp_path, call, message):
    bench = run(tmp_path, f"p = PWM(8, freq=50)\ntry: {call}\nexcept ValueError as error: print(error)")

    assert said(bench) == [message]


def test_a_duty_stays_when_the_frequency_changes(tmp_path):
    main = "p = PWM(Pin(8), 50, duty_ns=1_500_000)\np.freq(60)\nprint(p.freq(), abs(p.duty_ns() - 1_500_000) < 200)"

    assert said(run(tmp_path, main)) == ["60 True"]


def test_the_two_pins_of_a_slice_share_their_frequency(tmp_path):
    main = "p = PWM(Pin(8), freq=50, duty_u16=100)\nq = PWM(Pin(9), freq=100, duty_u16=200)\nprint(p.freq(), q.freq())"

    assert said(run(tmp_path, main)) == ["100 100"]


def test_full_duty_is_always_on(tmp_path):
    bench = run(tmp_path, "p = PWM(Pin(8), freq=50, duty_u16=65535)\nprint(p.duty_u16())")

    counter, channel = bench.board.pulses.of(8)
    assert counter.width_us(channel) == counter.period_us
    assert said(bench) == ["65535"]


def test_nothing_is_put_out_before_both_are_set(tmp_path):
    bench = run(tmp_path, "p = PWM(Pin(8))\np.duty_u16(1000)")

    assert not bench.board.pulses.of(8)[0].enabled


def test_a_servo_on_the_board_follows_the_pulses(tmp_path):
    bench = run(tmp_path, "p = PWM(Pin(8), freq=50, duty_ns=2_000_000)\nwhile True: time.sleep_ms(5)")

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
        return run(tmp_path, f"p = PWM(Pin(8), freq=50, duty_ns={ns})", keep_journal=True).trace_sha256()

    assert trace(1_500_000) == trace(1_500_000)
    assert trace(1_500_000) != trace(1_600_000)
