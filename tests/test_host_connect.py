"""Finding out who a robot is: quickly when it is known, surely when the line is bad."""

import random

import pytest

from host.dictionaries import cache_folder
from host.errors import LinkLost, Silent
from host.robot import Robot
from protocol import messages
from tests.fake_robot import LABELS, FakeLine, FakeRobot


class RealLine(FakeLine):
    """A line like one to a real robot: what the host remembers may help it."""

    repeatable = False


class LossyLine(RealLine):
    """Loses single bytes, as many as the share says."""

    share = 0.005

    def _damaged(self, data):
        return bytes(byte for byte in data if self._random.random() >= self.share)


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    """A cache of this test's own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


def asked(peer):
    return [name for _, name, _ in peer.orders]


def connected(line):
    robot = Robot(line)
    robot.connect()
    return robot


def test_a_known_robot_is_connected_in_one_round_trip_and_the_first_order_in_two():
    connected(RealLine(FakeRobot()))
    peer = FakeRobot()
    line = RealLine(peer)

    robot = connected(line)
    assert asked(peer) == ["hello"]
    robot.status()

    assert asked(peer) == ["hello", "status_request"]
    assert line.now_ms - 1000 <= 2 * 10  # two exchanges of one step each way


def test_an_unknown_robot_is_read_once_and_then_known():
    first, second = FakeRobot(), FakeRobot()

    connected(RealLine(first))
    robot = connected(RealLine(second))

    assert asked(first).count("dictionary") > 10
    assert asked(second) == ["hello"]
    assert robot.profile.labels == tuple(LABELS)


def test_a_damaged_memory_costs_a_reading():
    connected(RealLine(FakeRobot()))
    (file,) = cache_folder().iterdir()
    file.write_bytes(file.read_bytes()[:-1] + b"?")
    peer = FakeRobot()

    robot = connected(RealLine(peer))

    assert "dictionary" in asked(peer)
    assert robot.profile.labels == tuple(LABELS)


def test_on_a_line_that_repeats_itself_every_run_is_like_the_first():
    peers = [FakeRobot(), FakeRobot()]
    for peer in peers:
        connected(FakeLine(peer))

    assert peers[0].orders == peers[1].orders
    assert not cache_folder().exists()


@pytest.mark.parametrize("seed", range(12))
def test_a_stranger_is_learnt_over_a_line_that_loses_half_a_percent_of_its_bytes(seed):
    line = LossyLine(FakeRobot(), seed=seed)

    robot = connected(line)

    assert robot.profile.labels == tuple(LABELS)
    assert line.now_ms - 1000 < 15_000


def test_the_words_of_the_dictionary_are_read_from_the_robot():
    texts = connected(LossyLine(FakeRobot(), seed=3)).help_texts()

    assert texts == {"fire": "Heat coils for a limited time.", "fire.hold_ms": "Off again after this long."}


def test_a_robot_that_gives_no_words_is_not_waited_for_for_ever():
    peer = FakeRobot()
    robot = connected(RealLine(peer))
    peer.deaf = True

    with pytest.raises(LinkLost, match="did not give the help texts"):
        robot.help_texts()


def test_a_viewer_may_read_the_words():
    peer = FakeRobot()
    peer.role = messages.VIEWER
    robot = Robot(RealLine(peer))
    robot.connect(watch_only=True)

    assert "fire" in robot.help_texts()


def test_a_robot_face_is_usable_again_after_a_robot_that_only_restarts(monkeypatch):
    """Whatever comes of it, it comes soon: a stop that nobody answered must not silence every later complaint."""
    peer = FakeRobot()
    line = RealLine(peer)
    robot = connected(line)
    robot.arm()
    step = peer.step
    peer.step = lambda now_ms, data: (peer.restart(boot=random.Random(now_ms).randrange(99)), step(now_ms, b""))[1]

    with pytest.raises(LinkLost):
        robot.status()
    with pytest.raises(Silent):
        robot.stop()
    begun_ms = line.now_ms
    with pytest.raises(LinkLost):
        robot.clear()

    assert line.now_ms - begun_ms < 10_000
