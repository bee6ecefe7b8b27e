"""Scripts from Python, for notebooks and generators: a Gait collects statements and is text, tree or program.

Each method adds one statement and returns the Gait; blocks are opened by `with`. Numbers are in the unit of their name
(`duty` in %, `until` in C, `ms`, `s`); everything else is a text as in a script: "$duty", "2 * $time", "500 ms". What
makes no statement is refused at once with a ValueError; what a robot can do is told by `check`.

>>> gait = Gait("circular").param("duty", "60 %", "5 %", "90 %").guard("any.temperature > 110 C")
>>> with gait.define("push", "c") as (c,):
...     _ = gait.fire(c, duty="$duty", ms=600, until=95).wait(s=2)
>>> with gait.repeat(3):
...     _ = gait.call("push", "A").call("push", "B")
>>> print(gait.text(), end="")
gait 1
robot circular
param duty = 60 % [5 % .. 90 %]
guard any.temperature > 110 C
def push(c):
    fire $c at $duty for 600 ms until 95 C
    wait 2 s
repeat 3:
    push(A)
    push(B)
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple, Self

from host.gait import tree as trees
from host.gait.checker import check
from host.gait.compiler import Compiled, compile_script
from host.gait.forecast import draw, model_of
from host.gait.forms import phrases
from host.gait.forms.formatting import replace_file
from host.gait.forms.gathering import NAME, Gathering, plain
from host.gait.forms.layout import NOWHERE, Sheet
from host.gait.forms.phrases import Value
from host.gait.forms.writer import statement as head
from host.gait.script import Script, loads
from host.gait.verdict import Report
from host.link import open_link
from host.preview.picture import picture
from host.profile import Profile
from host.robot import Robot


class _Checked(NamedTuple):
    """What was checked, and for which robot."""

    sheet: Sheet
    compiled: Compiled
    address: str


class Gait(Gathering):
    """A script in the making, for the robot of that name."""

    def __init__(self, robot: str) -> None:
        super().__init__()
        self._checked: _Checked | None = None
        self._put(trees.Gait(Fraction(1), NOWHERE))
        self._put(phrases.statement(f"robot {robot}", trees.Robot, "robot"))

    def param(self, name: str, value: str, low: str | None = None, high: str | None = None) -> Self:
        """Add a value that the command line may change, within its range.

        >>> print(Gait("circular").param("step", "2 s", "1.3 s", "6 s").line())
        param step = 2 s [1.3 s .. 6 s]
        """
        if (low is None) != (high is None):
            raise ValueError("low and high are given both or not at all")
        least, most = (None if end is None else phrases.value(name, end) for end in (low, high))
        return self._put(trees.Param(phrases.own(name), phrases.value(name, value), least, most, NOWHERE))

    def include(self, path: str) -> Self:
        """Add the params, circles and defs of another file, named relative to this one."""
        return self._put(trees.Include(phrases.line(path), NOWHERE))

    def circle(self, name: str, *coils: str) -> Self:
        """Add coils that point down one after another while the robot rolls."""
        return self._put(trees.Circle(phrases.name(name), _some(coils), NOWHERE))

    def let(self, name: str, choice: str) -> Self:
        """Let the robot choose a coil of a circle and keep it.

        >>> print(Gait("sphere-a").let("next", "roll[down + 1]").line())
        let next = roll[down + 1]
        """
        return self._put(phrases.statement(f"let {phrases.name(name).text} = {choice}", trees.Let, "choice"))

    def guard(self, condition: str) -> Self:
        """Add a condition under which the robot switches everything off: "any.temperature > 110 C"."""
        return self._put(phrases.statement(f"guard {condition}", trees.Guard, "condition"))

    def fire(
        self,
        *coils: str,
        duty: Value,
        ms: Value | None = None,
        s: Value | None = None,
        time: str | None = None,
        until: Value | None = None,
        ramp: str | None = None,
        overlap: str | None = None,
    ) -> Self:
        """Heat coils with a duty in % for a time, or until they are so many C hot.

        >>> print(Gait("circular").fire("A", "C", duty=60, ms=600, overlap="200 ms").line())
        fire A C at 60 % for 600 ms overlap 200 ms
        """
        clauses = [_clause("at", phrases.value("duty", duty, "%")), _clause("for", phrases.time(ms, s, time))]
        clauses += [_clause("until", phrases.value("until", until, "C"))] if until is not None else []
        return self._put(trees.Fire(_some(coils), (*clauses, *_parts(ramp=ramp, overlap=overlap)), NOWHERE))

    def hold(
        self,
        *coils: str,
        at: Value,
        duty: Value,
        ms: Value | None = None,
        s: Value | None = None,
        time: str | None = None,
        overlap: str | None = None,
    ) -> Self:
        """Keep coils near so many C for a time: a duty in % below it, nothing above it.

        >>> print(Gait("circular").hold("A", at=80, duty=40, s=5).line())
        hold A at 80 C with 40 % for 5 s
        """
        ways = [_clause("at", phrases.value("at", at, "C")), _clause("with", phrases.value("duty", duty, "%"))]
        clauses = (*ways, _clause("for", phrases.time(ms, s, time)), *_parts(overlap=overlap))
        return self._put(trees.Hold(_some(coils), clauses, NOWHERE))

    def move(self, *joints: str, to: str, over: str, overlap: str | None = None) -> Self:
        """Bring joints to a position within a time.

        >>> print(Gait("fingers").move("R", to="28 deg", over="2 s").line())
        move R to 28 deg over 2 s
        """
        return self._put(trees.Move(_some(joints), _parts(to=to, over=over, overlap=overlap), NOWHERE))

    def orient(
        self,
        angle: Value,
        ms: Value | None = None,
        s: Value | None = None,
        time: str | None = None,
        overlap: str | None = None,
    ) -> Self:
        """Turn the object that the joints hold to an angle in deg, and keep it there for a time.

        >>> print(Gait("fingers").orient(-5, s=3).line())
        orient -5 deg for 3 s
        """
        clauses = (_clause("for", phrases.time(ms, s, time)), *_parts(overlap=overlap))
        return self._put(trees.Orient(phrases.value("angle", angle, "deg"), clauses, NOWHERE))

    def press(
        self,
        newton: Value,
        over: str,
        ms: Value | None = None,
        s: Value | None = None,
        time: str | None = None,
        overlap: str | None = None,
    ) -> Self:
        """Bring the force of the press to so many N within a time, and keep it there for a time in all.

        >>> print(Gait("press").press(5, over="1 s", s=20).line())
        press to 5 N over 1 s for 20 s
        """
        to = _clause("to", phrases.value("newton", newton, "N"))
        clauses = (to, *_parts(over=over), _clause("for", phrases.time(ms, s, time)), *_parts(overlap=overlap))
        return self._put(trees.Press(clauses, NOWHERE))

    def wait(self, time: str | None = None, *, ms: Value | None = None, s: Value | None = None) -> Self:
        """Let time pass: wait(ms=500), wait(s=2), wait("$rest")."""
        return self._put(trees.Wait(phrases.time(ms, s, time), NOWHERE))

    def wait_until(self, condition: str, timeout: str, otherwise: str = "abort") -> Self:
        """Wait for a condition, for a bounded time; otherwise: "abort", "continue" or a label further down.

        >>> print(Gait("circular").wait_until("all.temperature < 45 C", timeout="20 s").line())
        wait until all.temperature < 45 C timeout 20 s else abort
        """
        asked = phrases.statement(f"guard {condition}", trees.Guard, "condition").condition
        clauses: tuple[trees.Clause | trees.Otherwise, ...]
        clauses = (*_parts(timeout=timeout), trees.Otherwise(phrases.name(otherwise), NOWHERE))
        return self._put(trees.WaitUntil(asked, clauses, NOWHERE))

    def note(self, text: str) -> Self:
        """Keep a text in the log when the robot comes here; $params are put in."""
        return self._put(trees.Note(phrases.line(text), NOWHERE))

    def label(self, name: str) -> Self:
        """Name this place, so that a wait further up may go on here."""
        return self._put(trees.Label(phrases.name(name), NOWHERE))

    def call(self, name: str, *arguments: Value) -> Self:
        """Run a def with these arguments.

        >>> print(Gait("circular").call("push", "A C", "2 s", 3).line())
        push(A C, 2 s, 3)
        """
        return self._put(trees.Call(phrases.name(name), tuple(map(phrases.argument, arguments)), NOWHERE))

    @contextmanager
    def define(self, name: str, *parameters: str) -> Iterator[tuple[str, ...]]:
        """Open a def; its arguments are given as they are written within: `with gait.define("push", "c") as (c,):`."""
        node = trees.Define(phrases.name(name), tuple(map(phrases.own, parameters)), (), NOWHERE)
        with self._block(lambda body: trees.Define(node.name, node.parameters, body, NOWHERE), head(node)):
            yield tuple(f"${parameter}" for parameter in parameters)

    @contextmanager
    def repeat(self, count: Value) -> Iterator[None]:
        """Open a block that runs a counted number of times."""
        times = phrases.value("count", count)
        with self._block(lambda body: trees.Repeat(times, body, NOWHERE), "repeat"):
            yield

    @contextmanager
    def for_each(self, name: str, *items: str | range) -> Iterator[str]:
        """Open a block that runs for each item; gives the item as it is written within.

        >>> gait = Gait("circular")
        >>> with gait.for_each("c", "A B C") as c, gait.for_each("k", range(1, 4)):
        ...     _ = gait.fire(c, duty="$k * 10 %", ms=500)
        >>> print(gait.text().split("circular")[1], end="")
        <BLANKLINE>
        for c in A B C:
            for k in 1 .. 3:
                fire $c at $k * 10 % for 500 ms
        """
        written = ", ".join(_span(item) if isinstance(item, range) else item for item in items)
        node = phrases.statement(f"for {phrases.own(name).text} in {written}:", trees.ForEach, "items")
        with self._block(lambda body: trees.ForEach(node.name, node.items, body, NOWHERE), "for"):
            yield f"${name}"

    @contextmanager
    def together(self) -> Iterator[None]:
        """Open a block whose statements all start at once."""
        with self._block(lambda body: trees.Together(body, NOWHERE), "together"):
            yield

    @contextmanager
    def sym(self, *turns: str) -> Iterator[None]:
        """Open a block whose coils are turned: sym("z 90 deg", "x 180 deg") on a sphere, sym("45 deg") on a ring."""
        turned = phrases.statement(f"sym {', '.join(turns)}:", trees.Sym, "turns").turns
        with self._block(lambda body: trees.Sym(turned, body, NOWHERE), "sym"):
            yield

    @contextmanager
    def on_fault(self) -> Iterator[None]:
        """Open the block that runs when the program is aborted; it stands last."""
        with self._block(lambda body: trees.OnFault(body, NOWHERE), "on fault"):
            yield

    def tree(self) -> tuple[trees.Statement, ...]:
        """Return the statements, with the places that they have in the text."""
        return self.script().main.statements

    def script(self, path: str | Path = NAME) -> Script:
        """Return the script as if it stood at `path`; what it includes is read from there."""
        text = self.text()
        return loads(text, str(path))

    def compile(self, profile: Profile, params: Sequence[str] = (), path: str | Path = NAME) -> Compiled:
        """Return the program for a robot; ValueError lists what is wrong, by the lines of the text."""
        with plain():
            return compile_script(self.script(path), profile, params)

    def check(self, robot: Profile | str, params: Sequence[str] = (), path: str | Path = NAME) -> Report:
        """Return the worst case on a robot, given by its profile or its address, and each limit that it breaks.

        From then on a notebook shows the script as a picture: what each coil does, and how warm it gets.
        """
        profile = robot if isinstance(robot, Profile) else _profile(robot)
        compiled = self.compile(profile, params, path)
        report = check(compiled)
        address = f"sim:{profile.robot}" if isinstance(robot, Profile) else robot
        self._checked = _Checked(self.sheet(), compiled, address)
        return report

    def save(self, path: str | Path) -> Path:
        """Write the script to a file and return its path."""
        target = Path(path)
        replace_file(target, self.text())
        return target

    def _repr_svg_(self) -> str | None:
        """Return the picture of the script as it was checked last; None when it was not, or has grown since."""
        checked = self._checked
        if checked is None or self.is_open or checked.sheet != self.sheet():
            return None
        return picture(draw(checked.compiled, model_of(checked.address, checked.compiled.profile)))


def _some(coils: tuple[str, ...]) -> tuple[trees.Coil, ...]:
    found = phrases.coils(coils)
    if not found:
        raise ValueError("which coils or joints? name them first")
    return found


def _clause(word: str, value: trees.Expression) -> trees.Clause:
    return trees.Clause(word, value, NOWHERE)


def _parts(**given: str | None) -> tuple[trees.Clause, ...]:
    """Return the clauses of those that are given, each as a text with its unit."""
    example = {"to": "28 deg"}
    return tuple(
        _clause(word, phrases.quantity(word, text, example.get(word, "200 ms")))
        for word, text in given.items()
        if text is not None
    )


def _span(numbers: range) -> str:
    if numbers.step != 1 or not numbers:
        raise ValueError(f"items: {numbers} is no span of whole numbers, one after another")
    return f"{numbers[0]} .. {numbers[-1]}"


def _profile(address: str) -> Profile:
    """Return the profile that the robot at an address has; nothing moves."""
    with Robot(open_link(address)) as robot:
        robot.connect(watch_only=True)
        return robot.profile
