"""Orders to joints at their edges, on robots that somebody might build: nothing raises, jumps or grows."""

import json
from itertools import pairwise

import pytest

from firmware.jointlimits import ServoLimits
from firmware.joints import Joints
from firmware.profile import Profile
from protocol import codes, messages, program, variables
from tests.firmware_bench import FINGERS, Rig, refusal, run_program
from tests.hil_rig import HilRig
from tests.odd_robots import MIXED, ODD, PINCH, fingers, rig_of, without
from tests.small_integers import Small

R, L = 0b01, 0b10
GRIP = program.move(R, 250, 100) + program.move(L, -250, 100) + program.delay(100)


class Unplugged:
    """A servo that nobody sees."""

    def pulse(self, width_ns: int) -> None:
        """Nothing turns."""

    off = pulse


def commanded(rig) -> list[int]:
    """Return the angles that the joints are told."""
    return list(rig.core.limbs.joints.commanded_centi)


def steps(rig, ms: int) -> list[int]:
    """Let time pass and return by how much the first joint was told to turn in each control step."""
    told = [commanded(rig)[0]]
    for _ in range(0, ms, 5):
        rig.run(5)
        told.append(commanded(rig)[0])
    return [abs(after - before) for before, after in pairwise(told)]


@pytest.fixture
def armed():
    rig = Rig(FINGERS)
    rig.arm()
    return rig


@pytest.fixture
def gripping(armed):
    """Fingers that hold an object 2.5 degrees inward."""
    armed.move(R, 250, over_ms=100, hold_ms=60000)
    armed.move(L, -250, over_ms=100, hold_ms=60000)
    armed.run(200)
    return armed


@pytest.fixture
def mixed(tmp_path):
    rig = rig_of(tmp_path, MIXED)
    rig.arm()
    return rig


def test_a_program_that_is_behind_its_time_turns_no_joint_back(armed):
    """Ops without a delay take the time of the program: 32 of them a control step."""
    dawdling = program.repeat(2000) + program.delay(0) + program.next_()
    code = program.move(R, 2000, 1000) + dawdling + program.move(R, -2000, 4000)

    run_program(armed, code + program.halt())

    assert max(steps(armed, 1500)) <= 10  # of 2000 centidegrees a second, or 1000


def test_no_number_of_a_movement_is_beyond_the_small_integers_of_a_board():
    limits = ServoLimits(PINCH["servo"] | {"least_centi": -9000, "most_centi": 9000})
    limits.slew_centi_per_s = Small(limits.slew_centi_per_s)
    joints = Joints([Unplugged()], 0, limits)
    joints.commanded_centi = joints._start_centi = joints._target_centi = [Small(-9000)]
    joints.move(1, 9000, 65535, 60000, Small(1 << 29))
    joints._start_centi, joints._target_centi = [Small(-9000)], [Small(9000)]

    for passed_ms in (0, 1, 32768, 65534, 65535):
        joints.update(Small((1 << 29) + passed_ms))
        joints.write()
        assert joints.commanded_centi[0] == pytest.approx(-9000 + 18000 * passed_ms / 65535, abs=1)


def test_no_number_of_the_loop_is_beyond_the_small_integers_of_a_board(gripping):
    loop = gripping.core.limbs.orient
    loop._gain, loop._camera._stale_ms = Small(30_000), 1000
    gripping.say(messages.ORIENT, target_centideg=32767, time_ms=65535, hold_ms=60000)
    gripping.board.watcher.frozen = True
    gripping.run(300)

    gripping.board.watcher.frozen, gripping.board.watcher.centideg = False, -32767
    gripping.run(3000)

    assert loop.active
    assert sum(commanded(gripping)) == 2 * -2000


def test_the_loop_jumps_by_no_more_than_a_frames_way_after_frames_were_lost(gripping):
    gripping.say(messages.ORIENT, target_centideg=0, time_ms=5000, hold_ms=5000)
    gripping.run(50)
    gripping.board.watcher.frozen = True
    gripping.run(80)
    gripping.board.watcher.frozen, gripping.board.watcher.centideg = False, -3000

    assert 100 < max(steps(gripping, 40)) <= 360  # 36000 centidegrees a second, in the time between two frames


def test_one_error_on_the_bus_does_not_lose_the_camera(gripping):
    gripping.say(messages.ORIENT, target_centideg=0, time_ms=5000, hold_ms=5000)
    gripping.board.watcher.absent = True
    gripping.run(10)
    gripping.board.watcher.absent = False

    gripping.run(300)

    assert gripping.core.limbs.orient.active
    assert not gripping.events("lost")


def test_a_guard_trips_even_when_another_asks_for_an_object_that_nobody_sees(armed):
    turned = program.Condition(program.ORIENTATION, program.ANY, program.ABOVE, 3000, 0)
    strained = program.Condition(program.JOINT_CURRENT, program.ANY, program.ABOVE, 1000, L)
    run_program(armed, program.guard(turned) + program.guard(strained) + program.delay(9000) + program.halt())

    armed.core.limbs.camera.known = False
    armed.core.limbs.joints.current_ma[1] = armed.board.converter.ma[1] = 1100
    armed.board.watcher.absent = True
    armed.run(10)

    assert [trip.code for trip in armed.events("tripped")] == [codes.GUARD]


def test_a_camera_that_is_lost_before_the_program_turns_the_object_drops_nothing(armed):
    run_program(armed, GRIP + program.delay(500) + program.orient(500, 1000) + program.halt())
    armed.board.watcher.absent = True

    armed.run(800)

    assert [event.code for event in armed.events("aborted")] == [codes.CAMERA]
    assert commanded(armed) == [250, -250]


def test_a_program_that_is_cancelled_leaves_no_loop_behind(armed):
    run_program(armed, GRIP + program.orient(500, 60000) + program.delay(60000) + program.halt())
    armed.run(300)
    armed.say(messages.CANCEL)
    held = commanded(armed)

    armed.run(200)

    assert commanded(armed) == held
    assert not armed.core.limbs.orient.active


def test_a_program_that_is_cancelled_leaves_its_joints_where_they_are(armed):
    run_program(armed, program.move(R | L, 2000, 4000) + program.halt())
    armed.run(1000)
    armed.say(messages.CANCEL)
    held = commanded(armed)

    armed.run(500)

    assert commanded(armed) == held
    assert 400 < held[0] < 600


def test_a_program_that_turns_an_object_is_not_started_where_no_loop_is(tmp_path):
    rig = rig_of(tmp_path, ODD["no loop"])

    refused = refusal(run_program(rig, GRIP + program.orient(0, 100) + program.halt()))

    assert refused.code == codes.NO_CAMERA


def test_the_limit_that_is_told_is_the_one_that_was_broken(tmp_path):
    rig = rig_of(tmp_path, ODD["bent inward"])
    rig.arm()

    refused = [refusal(rig.move(R, angle)) for angle in (-500, -5001, 500)]

    assert [(each.code, each.limit) for each in refused] == [
        (codes.RANGE_LIMIT, -1000), (codes.RANGE_LIMIT, -5000), (codes.RANGE_LIMIT, -1000),
    ]  # fmt: skip


@pytest.mark.parametrize("name", sorted(ODD))
def test_the_usual_variables_of_any_robot_are_as_long_as_its_profile_says(tmp_path, name):
    rig = rig_of(tmp_path, ODD[name])
    rig.say(messages.SUBSCRIBE, slot=0, period_ms=50, on_change=0, variables=b"")
    rig.run(100)

    counts = variables.counts(len(rig.profile.coils), len(rig.profile.joints), 1 if rig.profile.camera else 0)
    record = next(body for kind, body in rig.got if kind == "telemetry")
    values = variables.unpack(variables.USUAL, variables.veiled(record.values), counts)
    told = dict(zip(variables.USUAL, values, strict=True))

    assert told[variables.number("state")] == messages.IDLE
    assert set(told[variables.number("coil_decidegc")]) <= {250}
    assert told[variables.number("commanded_centi")] == (-32768,) * counts[1]


@pytest.mark.parametrize("name", sorted(ODD))
def test_every_variable_can_be_asked_of_any_robot(tmp_path, name):
    rig = rig_of(tmp_path, ODD[name])
    for number in range(len(variables.VARIABLES)):
        rig.say(messages.SUBSCRIBE, slot=number % 4, period_ms=5, on_change=number & 1, variables=bytes((number, 0)))

    assert not [body for kind, body in rig.got if kind == "refused"]
    assert {body.slot for kind, body in rig.got if kind == "telemetry"} == {0, 1, 2, 3}


def test_a_joint_beside_the_two_that_hold_the_object_may_move_while_it_is_turned(tmp_path):
    rig = rig_of(tmp_path, ODD["three joints"])
    rig.arm()
    rig.move(R | L, 0, over_ms=100, hold_ms=60000)
    rig.run(200)
    rig.say(messages.ORIENT, target_centideg=500, time_ms=5000, hold_ms=5000)

    rig.move(0b100, 500)

    assert rig.core.limbs.orient.active


def test_servos_beside_coils_are_no_current_that_nothing_explains(mixed):
    mixed.move(0b1100, 500, over_ms=500, hold_ms=60000)
    mixed.fire(0b01, duty_permille=300, hold_ms=4000)
    mixed.board.servo_ma = 800

    mixed.run(4000)

    assert not mixed.events("tripped")


def test_a_condition_on_a_joint_beside_coils_is_of_that_joint(mixed):
    above = program.Condition(program.POSITION, program.ALL, program.ABOVE, 400, 0b1000)
    moves = program.move(0b0100, -500, 100) + program.move(0b1000, 500, 100)

    run_program(mixed, moves + program.wait(above, 1000, program.ABORT) + program.halt())
    mixed.run(300)

    assert mixed.events("finished")


def test_a_program_that_the_camera_aborted_leaves_the_next_one_alone(armed):
    above = program.Condition(program.ORIENTATION, program.ANY, program.ABOVE, 3000, 0)
    run_program(armed, program.wait(above, 4000, program.ABORT) + program.halt())
    armed.board.watcher.absent = True
    armed.run(200)

    run_program(armed, program.move(R, 500, 100) + program.halt())
    armed.run(200)

    assert [event.code for event in armed.events("aborted")] == [codes.CAMERA]
    assert armed.events("finished")


@pytest.mark.parametrize(
    "servo",
    [
        {"least_centi": 100, "most_centi": -100}, {"least_centi": -9001}, {"most_centi": 9001},
        {"slew_centi_per_s": 0}, {"span_centi": 150}, {"ua_per_count": 20_000}, {"high_counts": 410},
        {"low_counts": 2000, "high_counts": 2100}, {"high_us": 400}, {"low_us": -1}, {"high_us": 5001}, {"pulse_hz": 0},
        {"pulse_hz": 40, "high_us": 24_000},
    ],
    ids=str,
)  # fmt: skip
def test_a_servo_of_which_numbers_would_not_fit_is_none(servo):
    with pytest.raises(ValueError, match="servo"):
        ServoLimits(PINCH["servo"] | servo)


@pytest.mark.parametrize(
    "data",
    [
        fingers(PINCH["channels"][:1]),
        MIXED | {"channels": MIXED["channels"][:2]},
        without(MIXED, "orient") | {"channels": MIXED["channels"][:2]},
    ],
    ids=["one joint", "no joint", "only a camera"],
)
def test_a_loop_needs_two_joints_and_a_camera_one(data):
    with pytest.raises(ValueError, match="joints"):
        Profile(json.dumps(data).encode())


def test_a_robot_is_armed_again_while_its_servos_still_slacken():
    """They hold for 100 ms after their last pulse, and the self-test takes what flows for a MOSFET that is stuck."""
    rig = HilRig("sim:fingers-experiment")
    rig.robot.arm()
    for label, centideg in (("R", 250), ("L", -250)):
        rig.robot.move([label], centideg, 500, 60000)
    rig.run(1.0)

    rig.robot.stop()
    rig.robot.clear()
    rig.robot.arm()

    assert rig.robot.status().state == "armed"
    assert all(joint.position is None for joint in rig.bench.joints)
