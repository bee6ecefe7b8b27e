"""A body driven beyond what its solver bears is said to have come apart; its figures are never reported as a run."""

import pytest

from hil_sim.address import parse
from hil_sim.assembly import assemble
from hil_sim.robots.file import RobotFileError
from hil_sim.soundness import CameApart, Soundness
from host.errors import LinkLost
from host.link import open_link
from host.robot import Robot
from tests.bench_fakes import FakePlant, bench_of


def seen(x: float = 0.0, node: float = 20.0, degc: float = 25.0) -> dict:
    return {"hub": [x, 0.0, 0.1], "nodes": [[x + node, 0.0], [x, node]], "coils": {"A": {"degc": degc}}}


class Flying(FakePlant):
    def snapshot(self):
        return seen(node=20.0 if len(self.calls) < 150 else 1e9)


def test_a_robot_that_rolls_downhill_holds_together():
    watch = Soundness()

    for second in range(1000):
        watch.look(seen(x=1000.0 * second), second / 2)


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (seen(node=2e5), "2e\\+05 mm from the hub, at most 100000"),
        (seen(node=float("nan")), "numbers are none"),
        (seen(degc=float("inf")), "numbers are none"),
        (seen(x=1e6), "hub went 1e\\+06 mm in 0.5 s"),
    ],
)
def test_what_no_robot_can_do_is_told_with_its_time(wrong, told):
    watch = Soundness()
    watch.look(seen(), 1.0)

    with pytest.raises(CameApart, match=f"came apart by 1.50 s, .*{told}"):
        watch.look(wrong, 1.5)


def test_a_body_that_comes_apart_ends_the_bench(tmp_path):
    bench = bench_of(tmp_path, "time.sleep_ms(5000)", plant=Flying())

    with pytest.raises(CameApart, match=r"by 1\.00 s"):
        bench.run(5.0)


def test_a_body_that_is_none_from_the_start_is_a_mistake_of_its_numbers():
    with pytest.raises(RobotFileError, match="circular cannot be built from these numbers"):
        assemble(parse("circular?set=coils.turns_count:1"))


def test_a_host_is_told_that_the_body_came_apart():
    robot = Robot(open_link("sim:circular?set=start.settle_s:0&set=coils.wire_diameter_mm:10"))

    with pytest.raises(LinkLost, match="the body of the bench came apart"):
        watch(robot)


def watch(robot):
    """Connect, and listen for a second."""
    with robot:
        robot.connect()
        list(robot.listen(1000))
