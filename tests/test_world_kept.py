"""What the robot keeps, under a real MicroPython: the same records, answers and trace as in CPython, cuts included."""

import pytest

from host.errors import LinkLost
from host.robot import Robot
from tests.hil_rig import HilRig

WORLDS = ("cpython", "micropython")
WRITE_OPERATIONS = 3


def kept(world, cut_at=0):
    """Trip a robot, set it up, cut its power in a write; return its trace and what a new host finds."""
    rig = HilRig(f"sim:circular?world={world}&body=still")
    rig.robot.calibrate()
    rig.fire("A", duty_percent=50, hold_s=0.2)
    rig.happens("estop-open")
    rig.run_alone(seconds=0.2)
    rig.happens("estop-close")
    rig.bench.board.flash.cut_at = cut_at
    try:
        rig.robot.change("node", 9)
    except LinkLost:
        rig.run_alone(seconds=0.3)
    host = Robot(rig.link)
    host.connect()
    found = host.faults(), host.settings(), rig.bench.board.flash.operations, rig.bench.trace_sha256()
    rig.link.close()
    return found


@pytest.mark.parametrize("cut_at", range(WRITE_OPERATIONS + 1))
def test_records_and_their_trace_are_the_same_in_both_worlds(cut_at):
    here, there = (kept(world, cut_at) for world in WORLDS)

    assert here == there
    faults, settings, operations, _ = here
    assert [fault.code for fault in faults] == [102]
    assert settings.node == (1 if cut_at else 9)
    assert all(settings.resistance_mohm.values())
    assert operations == 2 * WRITE_OPERATIONS + (cut_at or WRITE_OPERATIONS)
