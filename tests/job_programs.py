"""Programs of random legal orders for the jobs of jobs.py: with notes, jumps and ways after an abort, also streamed.

code = whole(ops, draw)
play(robot, program.header(code, robot.profile.crc) + code, draw, until_s)
"""

from contextlib import suppress
from random import Random

from host.errors import Refused
from host.robot import ENDS, Robot
from host.run import TELEMETRY_MS
from host.stream import AT, AT_MS, SLOT, Stream
from protocol import program
from protocol.program import Condition

NEVER = Condition(program.CURRENT, program.ANY, program.ABOVE, 0x7FFF, 0)
SOON = Condition(program.TIME, program.ANY, program.ABOVE, 0, 500)


def whole(ops: list[bytes], draw: Random) -> bytes:
    """Return a program of these ops, some turns of them, that ends, jumps or is aborted."""
    body = b"".join(program.step(1 + i) + op + program.note(1 + i) for i, op in enumerate(ops))
    loop = program.repeat(draw.randrange(1, 4)) + body + program.delay(1) + program.next_()
    ends = draw.choice((program.ABORT, program.CONTINUE, program.JUMP))
    late = program.wait(draw.choice((NEVER, SOON)), draw.randrange(300), ends) + program.delay(100)
    code = loop + late * draw.randrange(2) + program.label(0) + program.halt()
    if draw.random() < 0.5:
        code += program.label(program.ON_FAULT) + ops[0] + program.delay(200) + program.halt()
    return code


def play(robot: Robot, code: bytes, draw: Random, until_s: float) -> None:
    """Upload or stream a program and run it, perhaps with pauses, until it has ended or at `until_s`."""
    stream = Stream(robot, code) if draw.random() < 0.3 else None
    if stream:
        stream.begin()
        robot.subscribe(AT_MS, [AT], slot=SLOT)
    else:
        robot.upload(code[: program.HEADER_BYTES], code[program.HEADER_BYTES :])
    pauses = draw.choice((0.0, 0.2))
    robot.arm()
    robot.start(paused=draw.random() < pauses)
    while robot.link.now_s() < until_s:
        for record in robot.listen(100):
            if stream:
                stream.take(record)
            if getattr(record, "event", "") in ENDS:
                robot.subscribe(TELEMETRY_MS)
                return
        if draw.random() < pauses:
            with suppress(Refused):  # it has just ended
                draw.choice((robot.pause, robot.resume, robot.resume, robot.step))()
