"""The head of a script and what its files declare: robot, params with their overrides, circles, defs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeVar

from host.gait import tree, units
from host.gait.diagnostics import Diagnostic, GaitError, Problems, did_you_mean
from host.gait.reading.parser import parse_value
from host.gait.script import Script
from host.gait.tree import Expression, File, Place
from host.gait.units import Quantity
from host.gait.working.aims import declare_circle
from host.gait.working.scope import Scope, Value
from host.profile import Profile

T = TypeVar("T", bound=tree.Statement)
VERSION = 1
DECLARATIONS = (tree.Gait, tree.Robot, tree.Param, tree.Include, tree.Circle, tree.Define, tree.Broken)


def check_head(script: Script, profile: Profile, problems: Problems) -> None:
    """Report a missing or wrong `gait 1` and `robot`, and what an included file may not hold."""
    unread = script.unread_words()
    for file in script.files:
        _check_version(file, unread, problems)
        _check_robot(file, profile, problems)
        for item in file.statements if file is not script.main else ():
            if not isinstance(item, DECLARATIONS):
                help = "only params, circles and defs can be included: put it into a def"
                problems.add(item.place, "E112", "an included file does nothing by itself", help)
    if script.robot is None and "robot" not in unread:
        problems.add(Place(script.main.name, 1, 1, 2), "E110", "the script names no robot", "add `robot NAME`")


def declare_params(script: Script, scope: Scope, overrides: Sequence[str]) -> None:
    """Work out every `param` in the order of the text, with the overrides `name=value` in their places."""
    given = dict(_split(override, scope.problems) for override in overrides)
    for node in _all(script, tree.Param):
        default = _default(node, scope)
        scope.declare(node.name, default)
        low, high = _limits(node, default, scope)
        if node.name.text in given:
            text = given.pop(node.name.text)
            scope.params[node.name.text] = _override(node.name.text, text, default, (low, high), scope)
    for name in given:
        if name and name not in scope.unread:
            place = Place(f"-p {name}", 1, 1, 2)
            help = did_you_mean(name, scope.params) or f"params are: {' '.join(scope.params) or 'none'}"
            scope.problems.add(place, "E181", f"the script has no param `{name}`", help)


def declare_circles(script: Script, scope: Scope) -> None:
    """Add every `circle` of the text."""
    for node in _all(script, tree.Circle):
        declare_circle(node, scope)


def declare_defs(script: Script, scope: Scope) -> dict[str, tree.Define]:
    """Return the defs of all files by name."""
    defs: dict[str, tree.Define] = {}
    for node in _all(script, tree.Define):
        if node.name.text in defs:
            scope.problems.add(node.name.place, "E161", f"`{node.name.text}` is defined twice")
        names: set[str] = set()
        for parameter in node.parameters:
            if parameter.text in names:
                scope.problems.add(parameter.place, "E161", f"`{parameter.text}` is declared twice")
            names.add(parameter.text)
        defs[node.name.text] = node
    return defs


def _all(script: Script, kind: type[T]) -> Iterator[T]:
    return (item for file in script.files for item in file.statements if isinstance(item, kind))


def _check_version(file: File, unread: set[str], problems: Problems) -> None:
    versions = [item for item in file.statements if isinstance(item, tree.Gait)]
    if not file.statements or not isinstance(file.statements[0], tree.Gait):
        if "gait" not in unread:
            place = file.statements[0].place if file.statements else Place(file.name, 1, 1, 2)
            problems.add(place, "E102", "the first statement is not `gait 1`", "begin the file with `gait 1`")
    elif versions[0].version != VERSION:
        wanted = f"this softrig reads gait {VERSION}"
        problems.add(versions[0].place, "E103", f"gait {units.decimal(versions[0].version)} is unknown: {wanted}")
    for item in versions[1:]:
        problems.add(item.place, "E111", "`gait` is given twice")


def _check_robot(file: File, profile: Profile, problems: Problems) -> None:
    robots = [item for item in file.statements if isinstance(item, tree.Robot)]
    for item in robots[1:]:
        problems.add(item.place, "E111", "`robot` is given twice")
    if robots and robots[0].name != profile.robot:
        message = f"this is for robot `{robots[0].name}`, the robot at hand is `{profile.robot}`"
        problems.add(robots[0].place, "E300", message)


def _default(node: tree.Param, scope: Scope) -> Quantity | None:
    """Return the value of a param; a bare number beside a range with units is reported."""
    low = scope.value(node.low) if node.low is not None else None
    if low is None or low.kind == units.NUMBER:
        return scope.value(node.value)
    return scope.of_kind(node.value, low.kind)


def _limits(node: tree.Param, default: Value, scope: Scope) -> tuple[Quantity | None, Quantity | None]:
    """Return the range of a param, checked against its value."""
    if not isinstance(default, Quantity) or node.low is None or node.high is None:
        return None, None
    low, high = scope.of_kind(node.low, default.kind), scope.of_kind(node.high, default.kind)
    if low and high and not low.value <= default.value <= high.value:
        scope.problems.add(node.place, "E180", f"{default} is outside its own range {low} .. {high}")
        return None, None
    return low, high


def _split(override: str, problems: Problems) -> tuple[str, str]:
    name, equals, value = override.partition("=")
    if not equals or not name.strip().isidentifier() or not value.strip():
        place = Place("-p", 1, 1, 2)
        problems.found.append(Diagnostic(place, "E183", f"`{override}` is not name=value", "", override))
        return "", ""
    return name.strip(), value.strip()


def _override(
    name: str, text: str, default: Value, limits: tuple[Quantity | None, Quantity | None], scope: Scope
) -> Value:
    file = f"-p {name}"
    try:
        node: Expression = parse_value(text, file)
    except GaitError as error:
        scope.problems.found += error.diagnostics
        return None
    problems = Problems([File(file, (), (), (text,))])
    local = Scope(problems, scope.profile, scope.params)
    value = local.of_kind(node, default.kind) if isinstance(default, Quantity) else local.value(node)
    low, high = limits
    if value and low and high and not low.value <= value.value <= high.value:
        problems.add(node.place, "E182", f"{value} is outside {low} .. {high}")
    scope.problems.found += problems.found
    return value
