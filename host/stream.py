"""A program that is sent while it runs: its loops unrolled as they come, never more of it ahead than the robot holds.

The robot keeps as much code as the largest program it takes whole, and says by the variable `program_at` how much of
the stream its sequencer has passed; the host fills that up. When an order is due and is not there the robot aborts the
program with its coils off (R37). After an abort or a jump it passes what comes until the label that it looks for.

    stream = Stream(robot, compiled.program)
    stream.begin()                  # as much as there is room for
    robot.subscribe(AT_MS, [AT], slot=SLOT)
    robot.start()
    for record in robot.watch():
        stream.take(record)         # what was passed makes room for more
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

from host.errors import Refused
from host.orders import PIECE
from host.records import Event, Record, Sample
from host.robot import Robot
from host.robotclock import since
from protocol import messages, program

AT, SLOT, AT_MS = "program_at", 2, 20
ROOM_LEFT = 4  # frames of the link that other orders may need
WORD = 1 << 16


class Stream:
    """One program (header and code) on its way to `robot`, which is connected; `refused` is why it takes no more."""

    def __init__(self, robot: Robot, code: bytes) -> None:
        self.refused: Refused | None = None
        self.sent = self.passed = 0  # bytes of code
        self._began_ms: int | None = None  # the robot's clock when the program began
        self._robot = robot
        self._header = streamed(code)
        self._pieces = pieces(code[program.HEADER_BYTES :])
        self._next = next(self._pieces, b"")
        self._most = robot.profile.program.bytes_max
        self._asked: deque[int] = deque()  # numbers of the orders that wait for their answers

    def begin(self) -> int:
        """Announce the program and send as much of it as the robot holds; return how many bytes."""
        self._robot.talk.order(messages.PROGRAM, header=self._header)
        while self._fits():
            self._robot.talk.answer(self._send())
        return self.sent

    def take(self, record: Record) -> None:
        """Send what there is room for, as a record from the robot may have made some."""
        if isinstance(record, Event) and record.event == "started":
            self._began_ms = record.now_ms
        elif isinstance(record, Sample) and record.slot == SLOT and self._is_ours(record):
            self.passed = record.values[AT]
        self._hear()
        while not self.refused and self._fits() and self._robot.talk.session.room() > ROOM_LEFT:
            self._asked.append(self._send())

    def _is_ours(self, record: Sample) -> bool:
        """Return whether a record tells of this program, not of one that ran before."""
        return self._began_ms is not None and since(record.now_ms, self._began_ms) >= 0

    def _fits(self) -> bool:
        return bool(self._next) and self.sent + len(self._next) - self.passed <= self._most

    def _send(self) -> int:
        """Send the next piece and return the number of its order."""
        seq = self._robot.talk.ask(messages.CODE, offset=self.sent % WORD, code=self._next)
        self.sent += len(self._next)
        self._next = next(self._pieces, b"")
        return seq

    def _hear(self) -> None:
        """Take the answers that have come; a robot that refuses a piece wants none of those behind it."""
        said = self._robot.talk.session.hearing.answers.said
        while self._asked and self._asked[0] in said:
            answer = said.pop(self._asked.popleft())
            if isinstance(answer, Refused):
                self.refused = self.refused or answer


def streamed(code: bytes) -> bytes:
    """Return the header of a program (header and code) that is streamed instead of uploaded."""
    head, body = program.read_header(code[: program.HEADER_BYTES]), code[program.HEADER_BYTES :]
    catches = (program.LABEL, program.ON_FAULT) in [(op[0], op[1]) for op in _ops(body) if len(op) > 1]
    flags = head.flags | program.STREAMED | (program.CATCHES if catches else 0)
    return bytes(program.header(b"", head.robot_crc, flags))


def pieces(code: bytes) -> Iterator[bytes]:
    """Yield the unrolled ops of a code in pieces, each of whole ops and as large as a message carries."""
    piece = b""
    for op in unrolled(code):
        if len(piece) + len(op) > PIECE:
            yield piece
            piece = b""
        piece += op
    yield piece


def unrolled(code: bytes) -> Iterator[bytes]:
    """Yield the ops of a code in the order in which its loops have them run, without the loops."""
    loops: list[list[int]] = []  # where the body begins, how many turns are left
    at = 0
    while at < len(code):
        op = code[at : at + program.SIZES[code[at]]]
        at += len(op)
        if op[0] == program.REPEAT:
            loops.append([at, program.number(op, 1, 2)])
        elif op[0] == program.NEXT:
            loops[-1][1] -= 1
            if loops[-1][1]:
                at = loops[-1][0]
            else:
                loops.pop()
        else:
            yield op


def _ops(code: bytes) -> Iterator[bytes]:
    """Yield the ops of a code as they stand."""
    at = 0
    while at < len(code):
        yield code[at : at + program.SIZES[code[at]]]
        at += program.SIZES[code[at]]
