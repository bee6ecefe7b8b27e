"""Options that many commands share, and quantities as an operator writes them."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import click

from host.errors import BadRequest
from host.keys import read

F = TypeVar("F", bound=Callable[..., Any])
KEY = "softrig.key"
ROBOT_HELP = "sim:NAME, the path of a port, socket://HOST:PORT, or can:INTERFACE:CHANNEL[@NODE]."


def robot_option(required: bool = True, ordered: bool = True) -> Callable[[F], F]:
    """Add --robot, which SOFTRIG_ROBOT can give too; and --key, if the robot is given orders."""
    help_text = ROBOT_HELP if required else f"{ROBOT_HELP} Without it: a bench with the script's robot."
    robot = click.option(
        "--robot", metavar="ADDRESS", envvar="SOFTRIG_ROBOT", show_envvar=True, required=required, help=help_text
    )
    return (lambda command: robot(key_option(command))) if ordered else robot


def key_option(command: F) -> F:
    """Add --key, which SOFTRIG_KEY can give too; `given_key` reads it once the robot is to be greeted."""
    return click.option(
        "--key", metavar="FILE", envvar="SOFTRIG_KEY", show_envvar=True, expose_value=False, callback=_remember_key,
        help="The robot's pairing key, if it has one.",
    )(command)  # fmt: skip


def given_key() -> bytes:
    """Return the pairing key that the running command was given, b"": none; BadRequest when it cannot be read."""
    path = click.get_current_context().meta.get(KEY)
    return read(path) if path else b""


def without_option(command: F) -> F:
    """Add --without: labels or groups, with commas between them, or given more than once."""
    return click.option(
        "--without", multiple=True, callback=_split, metavar="COIL,...", help="Broken: not tested, never driven."
    )(command)


def if_lost_options(command: F) -> F:
    """Add --if-lost and --patience: what a run does when its line breaks."""
    patience = click.option(
        "--patience", default="10s", show_default=True, callback=_milliseconds, metavar="TIME", help="With a lost line."
    )
    choice = click.Choice(["reattach", "stop"])
    what = "When the line breaks and comes back: go on in the same session, or stop the robot."
    return click.option("--if-lost", type=choice, default="reattach", show_default=True, help=what)(patience(command))


def json_option(command: F) -> F:
    """Add --json; errors are then told on stdout as well."""
    return click.option(
        "--json", "as_json", is_flag=True, callback=_remember, is_eager=True, help="One JSON object per line on stdout."
    )(command)


def time_ms(text: str) -> int:
    """Return the milliseconds that `500ms`, `0.5 s` or `0.5` stand for."""
    return _measured(text, {"s": 1000, "ms": 1})


def angle_centideg(text: str) -> int:
    """Return the hundredths of a degree that `8deg`, `-8 deg` or `8` stand for."""
    return _signed(text, {"deg": 100})


class Position(NamedTuple):
    """Where a joint is to go, in hundredths of its unit, and the unit that was written, "": none."""

    centi: int
    unit: str

    def of(self, unit: str) -> int:
        """Return the hundredths for a robot whose joints count in that unit; BadRequest when another was written."""
        if self.unit not in ("", unit):
            raise BadRequest(f"{self.centi / 100:g}{self.unit}: the joints of this robot count in {unit}")
        return self.centi


def position(text: str) -> Position:
    """Return what `8deg`, `-4 mm` or `8`, in whichever unit the joints have, stand for."""
    found = re.search(r"[a-z%]*$", str(text).strip(), re.ASCII)
    return Position(_signed(text, {"mm": 100, "deg": 100}), found[0] if found else "")


def force_mn(text: str) -> int:
    """Return the thousandths of a newton that `5N`, `500 mN` or `5` stand for."""
    return _measured(text, {"N": 1000, "mN": 1})


def length_m(text: str) -> float:
    """Return the metres that `45.9mm`, `0.0459 m` or `45.9` (mm) stand for; 0 is none."""
    length_nm = _measured(text, {"mm": 1_000_000, "m": 1_000_000_000})
    if not length_nm:
        raise click.BadParameter(f"{text!r}: must be above 0 mm")
    return length_nm / 1e9


def duty_permille(text: str) -> int:
    """Return the permille that `60%` or `60` stand for."""
    return _measured(text, {"%": 10})


def _measured(text: str, factors: dict[str, int]) -> int:
    """Return a number in the smallest unit; without a unit it is in the first one."""
    match = re.fullmatch(r"\s*(\d{1,12}(?:\.\d*)?|\.\d+)\s*([a-zN%]*)\s*", str(text), re.ASCII)
    if match is None or match[2] not in ("", *factors):
        raise click.BadParameter(f"{text!r}: write a number and {' or '.join(factors)}")
    return round(float(match[1]) * (factors[match[2]] if match[2] else next(iter(factors.values()))))


def _signed(text: str, factors: dict[str, int]) -> int:
    """Return a number that may begin with a sign, as above."""
    bare = str(text).strip()
    sign = -1 if bare.startswith("-") else 1
    return sign * _measured(bare[1:] if bare[:1] in ("-", "+") else bare, factors)


def _milliseconds(ctx: click.Context, param: click.Parameter, value: str) -> int:
    """Return the time in milliseconds."""
    return time_ms(value)


def _split(ctx: click.Context, param: click.Parameter, values: tuple[str, ...]) -> tuple[str, ...]:
    """Return what stands between the commas."""
    return tuple(name.strip() for value in values for name in value.split(",") if name.strip())


def _remember_key(ctx: click.Context, param: click.Parameter, value: str | None) -> None:
    ctx.meta[KEY] = value


def _remember(ctx: click.Context, param: click.Parameter, value: bool) -> bool:
    """Tell the group's error line that --json was given."""
    state = ctx.find_root().obj
    if value and isinstance(state, dict):
        state["json"] = True
    return value
