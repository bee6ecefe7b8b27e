"""Heat on the core alone: budgets, rests and the estimate of each coil's temperature."""

import pytest

from firmware.core import Core
from protocol import codes, messages
from tests.firmware_bench import Rig, refusal


@pytest.fixture
def rig():
    return Rig()


def test_a_coil_at_full_duty_trips_its_heat_budget_before_two_seconds(rig):
    rig.arm()

    rig.fire(1, duty_permille=1000, hold_ms=10_000)
    rig.run(2000)

    assert rig.core.code in (codes.HEAT_BUDGET, codes.OVER_TEMPERATURE)
    assert rig.events("tripped")[0].now_ms < 2000
    assert rig.events("tripped")[0].channel == 0


def test_boost_then_hold_stays_within_the_budget(rig):
    rig.arm()

    rig.fire(1, duty_permille=1000, hold_ms=700)
    rig.run(690)
    rig.fire(1, duty_permille=320, hold_ms=9000)
    rig.run(8000)

    assert rig.core.state == messages.ARMED
    assert rig.board.chip.duty_permille[0] == 320


def test_a_coil_that_was_on_as_long_as_it_may_must_rest(rig):
    rig.arm()
    rig.fire(1, duty_permille=100, hold_ms=10_000)
    rig.run(10_005)

    assert refusal(rig.fire(1)).code == codes.RESTING
    rig.run(1000)
    assert rig.fire(1)[0][0] == "ok"


def test_chained_orders_cannot_keep_a_coil_on_for_ever(rig):
    rig.arm()
    for _ in range(3):
        rig.fire(1, duty_permille=100, hold_ms=6000)
        rig.run(4000)

    assert rig.core.code == codes.ON_TOO_LONG


def test_an_off_and_an_on_in_one_step_are_no_pause(rig):
    """The output was never off, so its time goes on."""
    rig.arm()
    rig.fire(1, duty_permille=50, hold_ms=10_000)
    rig.run(8000)

    for duty_permille in (0, 50):
        fields = {"coils": 1, "duty_permille": duty_permille, "hold_ms": 10_000}
        rig.host.send(messages.FIRE.number, messages.FIRE.pack(**fields), rig.now_ms)
    rig.run(4000)

    assert rig.core.code == codes.ON_TOO_LONG


def test_an_offset_of_the_board_makes_no_estimate_cooler(rig):
    rig.board.decidegc = 450
    rig.core.sense.board_offset_decidegc = -100
    rig.run(400)

    assert rig.core.sense.board_decidegc == 350
    assert rig.core.sense._ambient_decidegc == 450


def test_a_coil_is_not_charged_for_the_time_before_it_was_switched_on(rig):
    rig.arm()
    rig.run(300)

    rig.fire(0b10000000, duty_permille=1000, hold_ms=100)
    rig.run(140)

    full_uw = 2_000_000 // 10_020 * (2_000_000 // 10_020) * 9500 // 1000
    assert rig.core.sense.heat_uj[7] == pytest.approx(full_uw * 100 // 1000, rel=0.05)


def test_what_has_transformed_takes_no_latent_heat_a_second_time(rig):
    """Else the estimate lags behind a coil that is heated in bursts, and the coil cooks before the trip."""

    def driven(duty_permille: int, until) -> int:
        """Return the milliseconds until the estimate of coil 0 is there."""
        sense, begun = rig.core.sense, rig.now_ms
        while not until(sense.temperature_millidegc[0]):
            rig.now_ms += 5
            sense.update(rig.now_ms, 1, [duty_permille])
        return rig.now_ms - begun

    first_ms = driven(1000, lambda t: t >= 75_000)
    driven(0, lambda t: t <= 60_000)
    second_ms = driven(1000, lambda t: t >= 75_000)

    sensible_ms = (75 - 60) * rig.profile.coil.heat_capacity_uj_per_k // 380
    assert first_ms > 400
    assert second_ms < 2 * sensible_ms


def test_a_reset_that_forgot_the_heat_takes_every_coil_as_hot():
    rig = Rig()
    core = Core(rig.board, rig.profile, boot=2, after_reset=True)
    core.step(0, b"", 1024)

    assert min(core.sense.temperature_millidegc) > 115_000
    for now_ms in range(5, 20_000, 5):
        core.step(now_ms, b"", 1024)
    assert max(core.sense.temperature_millidegc) < 30_000


def test_a_broken_thermistor_does_not_spoil_the_estimates(rig):
    rig.arm()
    rig.fire(1, duty_permille=1000, hold_ms=500)
    rig.run(500)
    before = rig.core.sense.temperature_millidegc[0]

    rig.board.decidegc = -9999
    rig.run(330)

    assert rig.core.code == codes.SENSOR
    assert 45_000 < rig.core.sense.temperature_millidegc[0] < before


def test_the_estimate_goes_on_cooling_while_the_monitor_is_gone(rig):
    """One step over ten silent seconds would make a coil colder than the air, and its next heat invisible."""
    rig.arm()
    rig.fire(1, duty_permille=1000, hold_ms=900)
    rig.run(900)

    rig.board.supply.absent = True
    rig.run(10_000)
    rig.board.supply.absent = False
    rig.run(100)

    assert min(rig.core.sense.temperature_millidegc) > 20_000
    assert max(rig.core.sense.temperature_millidegc) < 40_000


@pytest.mark.parametrize("gone", ["chip", "supply"])
def test_a_reset_takes_every_coil_as_hot_also_when_a_chip_does_not_answer(gone):
    rig = Rig()
    getattr(rig.board, gone).absent = True
    core = Core(rig.board, rig.profile, boot=2, after_reset=True)

    core.step(0, b"", 1024)

    assert min(core.sense.temperature_millidegc) > 115_000
