"""What a beginner writes is met with what to write instead."""

import pytest

from host.gait.checker import check
from tests.gait_scripts import compiled, diagnostics

FIRE = "fire A at 60 % for 600 ms"
HINTS = (
    ("fire A at 60 % for 0,6 s", "write decimals with a point: 0.6"),
    ("wait 12,5 s", "write decimals with a point: 12.5"),
    ("duty = 60 %", "name a value with `param duty = ...`"),
    ("if A.temperature < 40 C:\n    " + FIRE, "a robot chooses by `wait until ... timeout ... else LABEL`"),
    ("while A.temperature < 40 C:\n    " + FIRE, "use `repeat 3:`, or `wait until ... timeout ... else continue`"),
    ("def push():\n    " + FIRE + "\npush", "to call a def, write `push()`"),
    ("param duty = 60 %\nfire A at duty for 600 ms", "write `$duty` for the value of a name"),
    ("for c in A B:\n    fire c at 60 % for 600 ms", "write `$c` for what the name stands for"),
    ("fire A, B at 60 % for 600 ms", "name them one after another, without commas: `A B`"),
    (FIRE + ";", "one statement a line, and nothing at its end"),
    ("fire A at 60 % for 600 ms until 95 °C", "write `95 C`"),
    ("wait until A.resistance > 4.2 Ω timeout 1 s else abort", "write `ohm`"),
    ("wait \N{MINUS SIGN}5 s", "write `-`"),
    ("note 'hello'", 'write `"`'),
    ("fire A\N{NO-BREAK SPACE}at 60 % for 600 ms", "write an ordinary blank"),
    ("// push", "a comment begins with `#`"),
)


@pytest.mark.parametrize(("body", "hint"), HINTS, ids=[body.split("\n")[-1] for body, _ in HINTS])
def test_the_first_mistake_of_a_beginner_comes_with_what_to_write(body: str, hint: str) -> None:
    assert hint in diagnostics(body)[0].help


def test_one_step_is_not_said_to_be_several():
    lines = list(check(compiled(FIRE)).lines())

    assert [line.split(", ")[1] for line in lines if line.startswith("  program")] == ["1 step"]
