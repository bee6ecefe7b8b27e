"""The rules of the house, held by reading every file's syntax tree; each rule is also shown a planted breach.

A rule takes a file's path from the root and its tree, and yields (line, what is wrong).
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("firmware", "hil_sim", "host", "protocol")
MAY_IMPORT = {
    "protocol": {"protocol"},
    "firmware": {"protocol", "firmware"},
    "host": {"protocol", "host"},
    "hil_sim": {"hil_sim"},  # it loads protocol and firmware as the image of a board, never as its own modules
}
MAY_KNOW = {  # in host/gait: the rooms, and the modules at the door that they stand on; those not named here know all
    "tree": set(),
    "errors": set(),
    "units": set(),
    "diagnostics": {"errors", "tree"},
    "plan": {"tree"},
    "reading": {"diagnostics", "tree"},
    "script": {"diagnostics", "reading", "tree"},
    "working": {"diagnostics", "plan", "reading", "script", "tree", "units"},
    "trial": {"diagnostics", "plan", "tree", "working"},
    "model": {"plan", "tree", "trial"},
    "forms": {"diagnostics", "reading", "script", "tree"},
    "verdict": {"diagnostics", "working"},
}
ON_A_BOARD = {"array", "binascii", "collections", "gc", "hashlib", "json", "machine", "micropython", "os"}
ON_A_BOARD |= {"struct", "sys", "time"}
RUN_BY_THE_BOARD = ("firmware/boot.py", "firmware/start.py")
IN_A_PROCESS_OF_ITS_OWN = ("hil_sim", "worlds", "shim")  # MicroPython's modules of world T2, which are the machine
KNOW_THE_MACHINE = (*RUN_BY_THE_BOARD, "firmware/main.py")
WALL_CLOCK = {
    "monotonic",
    "monotonic_ns",
    "now",
    "perf_counter",
    "perf_counter_ns",
    "sleep",
    "time",
    "time_ns",
    "today",
    "utcnow",
}
MAY_READ_THE_WALL_CLOCK = ("hil_sim/ports.py", "host/link.py", "host/deploy/console.py")
LINES_MAX = 60

Breach = tuple[int, str]


def only_allowed_layers(path: PurePosixPath, tree: ast.Module) -> Iterator[Breach]:
    for line, name in imports(tree):
        if name.split(".")[0] in {*PACKAGES, "tests"} - MAY_IMPORT[path.parts[0]]:
            yield line, f"{path.parts[0]} imports {name}"


def gait_scripts_pass_from_room_to_room(path: PurePosixPath, tree: ast.Module) -> Iterator[Breach]:
    """Text to tree, tree to plan, plan to worst case: nothing knows what comes after it."""
    room = path.with_suffix("").parts[2:3]
    if path.parts[:2] != ("host", "gait") or not room or room[0] not in MAY_KNOW:
        return
    for line, name in imports(tree, names=True):
        parts = name.split(".")
        if parts[:2] == ["host", "gait"] and parts[2:3] and parts[2] not in {room[0], *MAY_KNOW[room[0]]}:
            yield line, f"{room[0]} imports {name}"


def only_boards_know_the_machine(path: PurePosixPath, tree: ast.Module) -> Iterator[Breach]:
    if str(path) in KNOW_THE_MACHINE or path.parts[:2] == ("firmware", "boards") or is_shim(path):
        return
    for line, name in imports(tree):
        if name.split(".")[0] == "machine":
            yield line, "imports machine"


def only_modules_a_board_has(path: PurePosixPath, tree: ast.Module) -> Iterator[Breach]:
    if path.parts[0] in ("firmware", "protocol"):
        for line, name in imports(tree):
            if name.split(".")[0] not in ON_A_BOARD | {"firmware", "protocol"}:
                yield line, f"{name} is not on a board"


def only_absolute_imports(path: PurePosixPath, tree: ast.Module) -> Iterator[Breach]:
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level:
            yield node.lineno, "relative import"


def nothing_happens_at_import(path: PurePosixPath, tree: ast.Module) -> Iterator[Breach]:
    harmless = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    if str(path) in RUN_BY_THE_BOARD or is_shim(path):
        return
    for node in tree.body:
        if not (isinstance(node, harmless) or is_docstring(node) or is_constant(node) or is_guarded(node)):
            yield node.lineno, f"{type(node).__name__} runs at import"


def no_module_state(path: PurePosixPath, tree: ast.Module) -> Iterator[Breach]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Global):
            yield node.lineno, f"global {', '.join(node.names)}"


def no_wall_clock(path: PurePosixPath, tree: ast.Module) -> Iterator[Breach]:
    if str(path) in MAY_READ_THE_WALL_CLOCK:
        return
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Attribute)
            and node.attr in WALL_CLOCK
            and named(node.value) in ("time", "datetime", "date")
        ):
            yield node.lineno, f"reads the wall clock: {node.attr}"
        if isinstance(node, ast.ImportFrom) and node.module in ("time", "datetime"):
            for name in WALL_CLOCK & {alias.name for alias in node.names}:
                yield node.lineno, f"imports the wall clock: {name}"


def short_functions(path: PurePosixPath, tree: ast.Module) -> Iterator[Breach]:
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            lines = (node.end_lineno or node.lineno) - node.lineno + 1
            if lines >= LINES_MAX:
                yield node.lineno, f"{node.name} has {lines} lines"


def docstrings(path: PurePosixPath, tree: ast.Module) -> Iterator[Breach]:
    if not ast.get_docstring(tree):
        yield 1, "no module docstring"
    for node in public(tree):
        if not ast.get_docstring(node):
            yield node.lineno, f"{node.name} has no docstring"


RULES = (
    only_allowed_layers,
    gait_scripts_pass_from_room_to_room,
    only_boards_know_the_machine,
    only_modules_a_board_has,
    only_absolute_imports,
    nothing_happens_at_import,
    no_module_state,
    no_wall_clock,
    short_functions,
    docstrings,
)

PLANTED = (
    (only_allowed_layers, "host/report.py", "from hil_sim.bench import Bench"),
    (only_allowed_layers, "host/report.py", "import importlib\nimportlib.import_module('hil_sim.bench')"),
    (only_allowed_layers, "hil_sim/bench.py", "def bench():\n    import host.session"),
    (only_allowed_layers, "hil_sim/bench.py", "from protocol import frames"),
    (only_allowed_layers, "hil_sim/bench.py", "from firmware.core import Core"),
    (only_allowed_layers, "firmware/core.py", "import host"),
    (only_allowed_layers, "protocol/link.py", "from firmware import core"),
    (gait_scripts_pass_from_room_to_room, "host/gait/reading/build.py", "from host.gait.working import scope"),
    (gait_scripts_pass_from_room_to_room, "host/gait/working/orders.py", "from host.gait import compiler"),
    (gait_scripts_pass_from_room_to_room, "host/gait/forms/writer.py", "import host.gait.trial.trial"),
    (gait_scripts_pass_from_room_to_room, "host/gait/plan.py", "from host.gait.script import Script"),
    (only_boards_know_the_machine, "firmware/core.py", "from machine import Pin"),
    (only_boards_know_the_machine, "firmware/drivers/pca9685.py", "import machine"),
    (only_modules_a_board_has, "firmware/core.py", "from dataclasses import dataclass"),
    (only_modules_a_board_has, "protocol/link.py", "import typing"),
    (only_absolute_imports, "host/robot.py", "from . import session"),
    (nothing_happens_at_import, "host/robot.py", "print('loaded')"),
    (nothing_happens_at_import, "hil_sim/clock.py", "for i in range(3):\n    pass"),
    (nothing_happens_at_import, "hil_sim/clock.py", "TABLE = open('table.csv').read()"),
    (nothing_happens_at_import, "hil_sim/clock.py", "cache = {}"),
    (no_module_state, "host/robot.py", "def connect():\n    global ROBOT\n    ROBOT = 1"),
    (no_wall_clock, "host/session.py", "import time\nnow_s = time.monotonic"),
    (no_wall_clock, "hil_sim/clock.py", "from time import perf_counter"),
    (no_wall_clock, "host/log.py", "import datetime\nSTAMP = datetime.datetime.now()"),
    (short_functions, "host/robot.py", "def run():\n" + "    pass\n" * 59),
    (docstrings, "host/robot.py", "'''A robot.'''\ndef run():\n    return 1"),
    (docstrings, "host/robot.py", "'''A robot.'''\nclass Robot:\n    '''One.'''\n    def run(self):\n        return 1"),
    (docstrings, "host/robot.py", "X = 1"),
)


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.__name__)
def test_every_file_keeps_the_rule(rule):
    assert breaches(rule, ROOT) == []


@pytest.mark.parametrize(("rule", "name", "source"), PLANTED)
def test_a_planted_breach_is_found(rule, name, source, tmp_path):
    planted = tmp_path / name
    planted.parent.mkdir(parents=True)
    planted.write_text(source)

    found = breaches(rule, tmp_path)

    assert len(found) == 1
    assert found[0].startswith(f"{name}:")


def test_there_are_files_to_look_at():
    assert all(list((ROOT / package).rglob("*.py")) for package in PACKAGES)


def test_every_function_of_tests_and_benchmarks_is_short_too():
    assert breaches(short_functions, ROOT, ("tests", "benchmarks", "docs")) == []


def breaches(rule, root: Path, folders=PACKAGES) -> list[str]:
    found = []
    for folder in folders:
        for file in sorted((root / folder).rglob("*.py")):
            path = PurePosixPath(file.relative_to(root).as_posix())
            found += [
                f"{path}:{line}: {what}" for line, what in rule(path, ast.parse(file.read_text(encoding="utf-8")))
            ]
    return found


def is_shim(path: PurePosixPath) -> bool:
    return path.parts[:3] == IN_A_PROCESS_OF_ITS_OWN


def imports(tree: ast.Module, names: bool = False) -> Iterator[tuple[int, str]]:
    """Yield (line, module) of each import anywhere in the file, also of those by name; or what is taken from it too."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            taken = [f".{alias.name}" for alias in node.names] if names else [""]
            yield from ((node.lineno, f"{node.module or ''}{name}") for name in taken)
        elif isinstance(node, ast.Call) and named(node.func) in ("import_module", "__import__"):
            yield from (
                (node.lineno, str(argument.value)) for argument in node.args if isinstance(argument, ast.Constant)
            )


def named(node: ast.expr) -> str:
    """Return the last part of a dotted name, or nothing."""
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def is_docstring(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def is_constant(node: ast.stmt) -> bool:
    """Return whether this assigns constants: names that begin with a capital, and no file is touched."""
    if not isinstance(node, (ast.Assign, ast.AnnAssign)):
        return False
    targets = node.targets if isinstance(node, ast.Assign) else [node.target]
    names = [name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)]
    touches = {"open", "read_text", "read_bytes", "print", "run", "Popen", "entry_points", "import_module"}
    calls = {named(call.func) for call in ast.walk(node) if isinstance(call, ast.Call)}
    return all(re.match(r"_*[A-Z]|__\w+__$", name) for name in names) and not calls & touches


def is_guarded(node: ast.stmt) -> bool:
    """Return whether this is `if __name__ == "__main__":` or `if TYPE_CHECKING:`."""
    return isinstance(node, ast.If) and any(
        isinstance(name, ast.Name) and name.id in ("__name__", "TYPE_CHECKING") for name in ast.walk(node.test)
    )


def public(tree: ast.Module) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef]:
    """Yield the classes, functions and methods that a caller may use."""
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)) and not node.name.startswith("_"):
            yield node
            if isinstance(node, ast.ClassDef):
                yield from (
                    method
                    for method in node.body
                    if isinstance(method, (ast.FunctionDef, ast.AsyncFunctionDef)) and not method.name.startswith("_")
                )
