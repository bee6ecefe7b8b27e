"""Frames that no host of ours sends: on a bus anybody may send anything."""

import pytest

from hil_sim.devices.canframe import Frame
from hil_sim.devices.canstation import CanStation
from host.canlink import CanLink
from host.robot import Robot
from protocol import frames, messages
from protocol.canbus import Segmenter
from tests.can_robots import opened


@pytest.fixture
def bus():
    """A bus with one robot, number 1."""
    with opened("can:softrig:circular?body=still@1") as bus:
        yield bus


@pytest.fixture
def robot(bus):
    """That robot, armed."""
    robot = Robot(CanLink(bus, 1))
    robot.connect()
    robot.arm()
    return robot


@pytest.fixture
def stranger(bus):
    """Somebody else on its bus."""
    return CanStation(bus.observers[1].board.can_wire, 500_000)


@pytest.mark.parametrize("extended", [False, True], ids=["standard", "extended"])
def test_a_frame_that_only_asks_for_a_stop_is_none(robot, stranger, extended):
    """It carries no data: what stands in the controller's buffer is of the frame before it."""
    for frame in (Frame(0, b"STOPP"), Frame(0, b"", extended, remote=True, length=4)):
        stranger.send(frame)
        list(robot.listen(20))

    assert robot.status().state == "armed"


def test_a_host_without_a_number_is_not_taken_for_the_serial_line(robot, stranger, bus):
    board = bus.observers[1].board
    hello = messages.HELLO.pack(version=frames.VERSION, session=9, attach=0, nonce_a=0, nonce_b=0)
    board.uart.host_read(bus.observers[1].clock.now_us)

    for frame in Segmenter(1, 0, False).feed(frames.encode(frames.seal(messages.HELLO.number, 0, 0, hello, 0, 0))):
        stranger.send(Frame(frame.identifier, frame.data, True))
        list(robot.listen(5))
    list(robot.listen(50))

    assert board.uart.host_read(bus.observers[1].clock.now_us) == b""
    assert robot.status().state == "armed"
