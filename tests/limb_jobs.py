"""Random legal orders to joints: fingers that grip and swing and turn what they hold, a press that goes and presses.

drive(robot, draw)              # over a host's face
payload(draw, profile)          # as it goes on the line
op(draw, profile)               # as a piece of a program
"""

from random import Random

from host.profile import Profile
from host.robot import Robot
from protocol import messages, program

DEEP = 0.15  # share of the moves of a press that may go to either end
HARD = 0.15  # and of the forces that may be as great as any


def drive(robot: Robot, draw: Random) -> None:
    """Send all joints somewhere, or have a loop drive them."""
    profile = robot.profile
    hold_ms = draw.choice((draw.randint(0, 5000), profile.servo.hold_max_ms))
    if not profile.press:
        right, left, over_ms = _swing(draw)
        for label, target in zip(profile.joint_labels, (right, left), strict=True):
            robot.move([label], target, over_ms, hold_ms)
        if draw.random() < 0.4:
            robot.orient(draw.randint(-500, 500), draw.randint(0, 3000), hold_ms)
    elif draw.random() < 0.5:
        robot.press(*_force(draw, profile), hold_ms)
    else:
        robot.move(profile.joint_labels, *_depth(draw, profile), hold_ms)


def payload(draw: Random, profile: Profile) -> tuple[messages.Message, bytes]:
    """Return a legal order."""
    hold_ms = draw.randint(0, 5000)
    if profile.press and draw.random() < 0.5:
        target_mn, over_ms, time_ms = _force(draw, profile)
        force = {"target_mn": target_mn, "over_ms": over_ms, "time_ms": time_ms, "hold_ms": hold_ms}
        return messages.PRESS, messages.PRESS.pack(**force)
    joint = draw.randrange(len(profile.joint_labels))
    *targets, over_ms = _depth(draw, profile) if profile.press else _swing(draw)
    fields = {"target_centi": targets[joint], "over_ms": over_ms, "hold_ms": hold_ms}
    return messages.MOVE, messages.MOVE.pack(joints=1 << joint, **fields)


def op(draw: Random, profile: Profile) -> bytes:
    """Return a piece of a program: an order, and most often a pause."""
    if not profile.press:
        right, left, over_ms = _swing(draw)
        moves = program.move(1, right, over_ms) + program.move(2, left, over_ms) + program.delay(over_ms)
        time_ms = draw.randint(0, 2000)
        turn = program.orient(draw.randint(-500, 500), time_ms) + program.delay(time_ms)
        return moves + draw.choice((b"", turn, program.delay(time_ms)))
    if draw.random() < 0.5:
        target_mn, over_ms, time_ms = _force(draw, profile)
        waits = draw.choice((time_ms, draw.randint(0, time_ms)))
        return program.press(target_mn, over_ms, time_ms) + program.delay(waits)
    target_centi, over_ms = _depth(draw, profile)
    return program.move(1, target_centi, over_ms) + program.delay(over_ms + draw.choice((0, draw.randint(0, 2000))))


def _swing(draw: Random) -> tuple[int, int, int]:
    """Return where the right finger and the left one are to go, and within which time: a grip, and a swing of both."""
    grip, swing = draw.randint(-300, 600), draw.randint(-1200, 1200)
    return swing + grip, swing - grip, draw.randint(150, 1500)


def _depth(draw: Random, profile: Profile) -> tuple[int, int]:
    """Return where the axis is to go, and a time in which it can from anywhere."""
    servo = profile.servo
    low, high = (servo.least_centi, servo.most_centi) if draw.random() < DEEP else (-200, 500)
    least_ms = (servo.most_centi - servo.least_centi) * 1000 // servo.slew_centi_per_s
    return draw.randint(low, high), draw.randint(least_ms, 3 * least_ms)


def _force(draw: Random, profile: Profile) -> tuple[int, int, int]:
    """Return a force, the time to it, and the time for which it is regulated."""
    most_mn = profile.load.most_mn if draw.random() < HARD else 6000
    over_ms = draw.choice((0, draw.randint(0, 1500)))
    return draw.randint(0, most_mn), over_ms, over_ms + draw.randint(0, 3000)
