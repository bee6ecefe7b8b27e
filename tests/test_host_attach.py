"""A program that outlives its host, and the host that takes it up again."""

from binascii import crc32

import pytest

from host.errors import BadRequest, LinkLost, TakenOver
from host.robot import Robot
from host.run import IfLost, outliving, upload, watch
from protocol import program
from tests.hil_rig import HilRig

CODE = program.step(1) + program.delay(3000) + program.step(2) + program.delay(2000) + program.halt()


def quiet(stage, done):
    pass


@pytest.fixture
def working():
    """A robot on the bench that runs a program of five seconds, which outlives its host."""
    rig = HilRig("sim:circular?body=still")
    start(rig, outliving(compiled(rig)))
    yield rig
    rig.link.close()


def compiled(rig):
    return program.header(CODE, crc32(rig.robot.dictionary.split(b"\n\n", 1)[1])) + CODE


def start(rig, code):
    upload(rig.robot, code, quiet)
    rig.robot.arm()
    rig.robot.start()


def test_a_program_that_outlives_its_host_is_taken_up_and_its_end_is_told(working):
    gone = working.robot.talk.session.number
    working.run_alone(1)
    again = Robot(working.link)

    taken = again.attach()
    again.subscribe(50)
    ending = watch(again, quiet, IfLost())

    assert taken == gone
    assert ending.result == "done"
    assert ending.event.step in (0, 2)
    assert again.status().state == "idle"


def test_a_host_that_lives_loses_its_robot_to_the_one_that_takes_over(working):
    other = Robot(working.link)

    other.attach(working.robot.talk.session.number)

    assert other.status().lease_ms > 0
    with pytest.raises(LinkLost, match="another host has taken the robot over"):
        working.robot.status()


def test_a_host_whose_robot_was_taken_over_leaves_it_to_the_other(working):
    other = Robot(working.link)
    other.attach()
    with pytest.raises(TakenOver):
        working.robot.status()

    working.robot.leave()

    assert other.status().state == "running"


def test_the_program_goes_on_with_the_same_lease(working):
    other = Robot(working.link)
    other.attach()

    list(other.listen(2000))

    assert other.status().state == "running"
    assert other.status().lease_ms > 300


def test_a_program_that_was_taken_over_can_be_ended(working):
    working.run_alone(1)
    other = Robot(working.link)
    other.attach()

    other.cancel()
    other.disarm()

    assert other.status().state == "idle"


def test_a_session_that_holds_nothing_cannot_be_taken_over(working):
    with pytest.raises(BadRequest, match="session 5 has nothing to take over: the robot obeys session"):
        Robot(working.link).attach(5)


def test_a_program_that_does_not_outlive_its_host_is_not_there_to_be_taken_over():
    rig = HilRig("sim:circular?body=still")
    start(rig, compiled(rig))
    rig.run_alone(1)

    with pytest.raises(BadRequest, match="no program runs"):
        Robot(rig.link).attach()


def test_a_run_whose_robot_lives_on_through_a_cut_cable_ends_well():
    rig = HilRig("sim:circular?body=still")
    start(rig, outliving(compiled(rig)))
    rig.robot.subscribe(50)
    for at_s, fault in ((0.5, "cable-cut"), (3.5, "cable-join")):
        rig.later(at_s, fault)

    ending = watch(rig.robot, quiet, IfLost())

    assert ending.result == "done"
    (interruption,) = rig.robot.interruptions()
    assert interruption.cause == "the robot has fallen silent"
    assert interruption.for_ms == pytest.approx(3000 - 500, abs=700)


def test_a_run_through_a_cut_cable_without_that_flag_ends_with_the_lease():
    rig = HilRig("sim:circular?body=still")
    start(rig, compiled(rig))
    rig.robot.subscribe(50)
    for at_s, fault in ((0.5, "cable-cut"), (3.5, "cable-join")):
        rig.later(at_s, fault)

    ending = watch(rig.robot, quiet, IfLost())

    assert ending.result == "lease"
    assert ending.error().exit_code == 7
