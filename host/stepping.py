"""A program that is gone through by hand: before each step it stands still, and an operator has it go on.

The robot says by `program_at` where in the code it stands, so that the step that would come next can be shown. Between
two records nothing is waited for: who holds the lease must be heard. Only on a line whose time does not pass meanwhile
(`waits`) the answer may be waited for.

    stepper = Stepper(robot, compiled, read, tell, is_streamed=False, waits=False)
    run(robot, compiled.program, progress, stepper=stepper.take)
"""

from __future__ import annotations

from collections.abc import Callable

from host.errors import Refused
from host.gait.compiler import Compiled
from host.records import Event, Record, Sample
from host.robot import ENDS, Robot
from host.robotclock import since
from host.stream import AT, SLOT, unrolled
from protocol import codes, program

HELP = "Enter: this step; a number: so many; r: run on, Enter pauses; q: end the program"
WAITING = HELP.replace(", Enter pauses", " to the end (virtual time: no key is heard meanwhile)")
RUN_ON, QUIT = "r", "q"


class Stepper:
    """Shows the steps of a program to whoever `tell` reaches, and obeys the lines that `read` returns.

    `read` is asked for a line when the program stands still, and, unless it `waits`, also while it runs; it returns
    None when there is none yet.
    """

    def __init__(
        self,
        robot: Robot,
        compiled: Compiled,
        read: Callable[[], str | None],
        tell: Callable[[str], None],
        is_streamed: bool = False,
        waits: bool = False,
    ) -> None:
        self._robot, self._compiled = robot, compiled
        self._read, self._tell = read, tell
        self._waits = waits
        self._marks = _Marks(compiled.code, is_streamed)
        self._paused: Event | None = None  # None: the program runs, or does not yet
        self._shown = self._runs = False  # shown: the step that comes next
        self._left = 0  # steps that go without being asked about
        self._ended = False
        self._tell(WAITING if self._waits else HELP)

    def take(self, record: Record) -> None:
        """Look at a record from the robot, and then for a line from the operator."""
        if isinstance(record, Event):
            self._note(record)
        elif isinstance(record, Sample) and record.slot == SLOT and not self._shown:
            self._show(record)
        if not self._ended and (self._shown or (self._runs and not self._waits)):
            line = self._read()
            if line is not None:
                self._try(line.strip().lower())

    def _note(self, event: Event) -> None:
        self._ended = self._ended or event.event in ENDS
        if event.event == "paused" and self._left:
            self._left -= 1
            self._robot.step()
        elif event.event == "paused":
            self._paused, self._shown, self._runs = event, False, False

    def _show(self, record: Sample) -> None:
        """Show which step comes next, once the robot has told where it stands."""
        paused = self._paused
        if paused is None or since(record.now_ms, paused.now_ms) < 0:
            return
        self._shown = True
        number = self._marks.at(record.values[AT]) if paused.step else self._marks.first()
        shown = number or paused.step
        self._tell(f"{'next is' if number else 'paused in'} step {shown}: {self._compiled.step(shown)}")

    def _try(self, line: str) -> None:
        """Obey a line, unless the program has ended meanwhile."""
        try:
            self._obey(line)
        except Refused as refused:
            if refused.code != codes.NOT_RUNNING:
                raise

    def _obey(self, line: str) -> None:
        """Do what a line says."""
        if line == QUIT:
            self._ended = True
            self._robot.cancel()
        elif self._runs:
            self._robot.pause()
        elif line == RUN_ON:
            self._leave()
            self._robot.resume()
        elif line == "" or (line.isascii() and line.isdigit() and int(line)):
            self._leave()
            self._left = int(line or 1) - 1
            self._robot.step()
        else:
            self._tell(WAITING if self._waits else HELP)

    def _leave(self) -> None:
        """Take it that the program runs."""
        self._paused, self._shown, self._runs = None, False, True


class _Marks:
    """The marks of the steps in a code, by how much of it has been passed."""

    def __init__(self, code: bytes, is_streamed: bool) -> None:
        self._code = code
        self._is_streamed = is_streamed
        self._stream = unrolled(code)
        self._op, self._op_at = next(self._stream), 0  # of the stream, where it was looked at last

    def first(self) -> int:
        """Return the number of the first step, 0: there is none."""
        return next((_step(op) for op in unrolled(self._code) if _step(op)), 0)

    def at(self, passed: int) -> int:
        """Return the number of the step whose mark stands there, 0: none."""
        if not self._is_streamed:
            return _step(self._code[passed : passed + 3])
        while self._op_at < passed:
            self._op_at += len(self._op)
            self._op = next(self._stream, program.halt())
        return _step(self._op)


def _step(op: bytes) -> int:
    """Return the number of the step that an op marks, 0: none."""
    return int(program.number(op, 1, 2)) if op[:1] == bytes((program.STEP,)) else 0
