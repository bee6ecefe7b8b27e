"""Coils with less resistance than the profile says take more power; the firmware measures them and reckons with it."""

from contextlib import suppress

import pytest

from host.errors import Refused, SoftrigError
from protocol import codes
from tests.hil_rig import HilRig
from tests.invariants import TRIP_MARGIN_K

ROBOTS = ("circular", "sphere-a", "sphere-b")
SET = "&set=coils.resistivity_{phase}_uohm_m:{value}"


def of_wire(robot, martensite):
    """Return a robot whose wire has that resistivity when it is cold, and 0.92 of it when it is hot; 0.955 is right."""
    wire = {"martensite": martensite, "austenite": 0.92 * martensite}
    changes = "".join(SET.format(phase=phase, value=value) for phase, value in wire.items())
    return HilRig(f"sim:{robot}?body=still{changes}")


@pytest.mark.parametrize("martensite", [0.77, 0.85, 0.92])
@pytest.mark.parametrize("robot", ROBOTS)
def test_a_coil_of_less_resistance_stays_within_its_trip(robot, martensite):
    rig = of_wire(robot, martensite)
    coil = rig.bench.plant.labels[0]
    with suppress(SoftrigError):  # it trips, and says so
        rig.fire(coil, duty_percent=100, hold_s=5)
        rig.run(seconds=5)
    peak_degc = rig.bench.coil(coil).peak_degc
    rig.link.close()

    assert peak_degc < rig.robot.profile.coil.trip_degc + TRIP_MARGIN_K


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_coil_some_of_whose_turns_touch_is_refused(robot):
    """A third of the turns: 0.65 of the right resistance. Warm coils have less, so only a cold one can tell."""
    rig = of_wire(robot, 0.62)
    with pytest.raises(Refused) as told:
        rig.robot.arm()
    rig.link.close()

    assert told.value.code == codes.COIL_SHORT
