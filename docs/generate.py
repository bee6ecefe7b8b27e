"""Writes the files that repeat what stands in a table elsewhere; `--check` only says which are out of date.

python docs/generate.py            # make docs
python docs/generate.py --check    # part of make check
"""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click

from docs import (
    cheader,
    cvectors,
    dbc,
    dictionary,
    faultspage,
    gaitpage,
    hardwarepage,
    protocolpage,
    schematic,
    vectors,
)
from host import errors
from host.cli import main as softrig
from host.cli.explain import JOINTS
from host.gait.errors import ROWS
from host.gait.forms import treejson
from protocol import causes

ROOT = Path(__file__).parents[1]
TEMPLATES = ROOT / "docs" / "templates"
ROBOTS = ROOT / "firmware" / "robots"
MADE = "<!-- Made by docs/generate.py: change the table it comes from and run `make docs`. -->\n\n"
UNITS = {
    "_uj_per_k": "µJ/K", "_uw_per_k": "µW/K", "_mv": "mV", "_ma": "mA", "_mj": "mJ", "_uj": "µJ", "_mohm": "mΩ",
    "_ms": "ms", "_degc": "°C", "_permille": "‰", "bytes": "bytes", "_centideg": "0.01°", "_hz": "Hz", "_us": "µs",
    "_centi": "0.01 {joint}", "_centi_per_s": "0.01 {joint}/s", "_mn": "mN", "_pa": "Pa",
    "_um_per_s_per_n": "µm/s per N", "_um_per_s": "µm/s", "_permille_per_s": "‰/s", "_counts": "counts",
    "ua_per_count": "µA",
}  # fmt: skip
# Of a profile.
SECTIONS = ("coil", "servo", "camera", "orient", "load", "press", "cell", "supply", "session", "program")
SENSORS = {"Attitude sensor": "imu", "Camera": "camera"}
WIDTH = 100  # of the help texts


def main(arguments: list[str]) -> int:
    """Write every file, or with `--check` return 1 and name those that are not as they would be written."""
    stale = {ROOT / name: page for name, page in pages() if not is_fresh(ROOT / name, page)}
    if "--check" in arguments:
        for path in stale:
            print(f"{path.relative_to(ROOT)} is out of date: make docs", file=sys.stderr)
        return 1 if stale else 0
    for path, page in stale.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(page, encoding="utf-8")
    return 0


def pages() -> Iterator[tuple[str, str]]:
    """Yield the path and the text of each file."""
    yield "protocol/dictionary.txt", dictionary.definition_text()
    yield "protocol/help.txt", dictionary.help_text()
    yield "docs/c/softrig.h", cheader.text()
    yield "docs/c/vectors.c", cvectors.text()
    yield "docs/vectors.json", vectors.text()
    yield "docs/softrig.dbc", dbc.text()
    yield "docs/protocol.md", MADE + protocol_page()
    yield "docs/codes.md", MADE + codes_page()
    yield "docs/faults.md", MADE + faults_page()
    yield "docs/gait-reference.md", MADE + gait_page()
    yield "docs/limits.md", MADE + limits_page()
    yield "docs/commands.md", MADE + commands_page()
    yield "docs/hardware.md", MADE + hardware_page()
    yield "docs/gait.schema.json", json.dumps(treejson.schema(), indent=2) + "\n"
    yield "docs/schematic.svg", schematic.svg()


def is_fresh(path: Path, page: str) -> bool:
    """Return whether the file holds just this text."""
    return path.exists() and path.read_text(encoding="utf-8") == page


def protocol_page() -> str:
    """Return the wire protocol: the prose of the template, the tables from the code."""
    return (TEMPLATES / "protocol.md").read_text(encoding="utf-8").format(**protocolpage.fields(table))


def codes_page() -> str:
    """Return every refusal, fault and script error; `softrig explain CODE` prints one of them."""
    units = [errors.unit_of(row, JOINTS) for row in causes.CODES]
    robot = [
        (row.name, str(row.number), unit, row.cause, row.did, row.todo)
        for row, unit in zip(causes.CODES, units, strict=True)
    ]
    script = [(row.code, str(row.exit_code), row.cause, row.todo) for row in ROWS]
    return "\n".join(
        (
            "# Codes\n",
            "R: the robot refused an order, nothing changed. F: a fault, the robot acted. E: a script is not sent.\n",
            "## Robot\nThe number stands on the wire; the unit is that of the value and limit beside it.\n",
            table(("code", "number", "unit", "cause", "what the robot did", "what to do"), robot),
            "## Gait scripts\n",
            table(("code", "exit", "cause", "what to do"), script),
        )
    )


def hardware_page() -> str:
    """Return the page of the board: the prose of the template, the tables from the board's file and the profiles."""
    template = (TEMPLATES / "hardware.md").read_text(encoding="utf-8")
    return template.format(**hardwarepage.fields(ROBOTS, table))


def faults_page() -> str:
    """Return what can go wrong on the bench and what is promised then."""
    return (TEMPLATES / "faults.md").read_text(encoding="utf-8").format(**faultspage.fields(table))


def gait_page() -> str:
    """Return the reference of the gait language."""
    return (TEMPLATES / "gait-reference.md").read_text(encoding="utf-8").format(**gaitpage.fields(table))


def limits_page() -> str:
    """Return labels and limits of each robot's profile."""
    parts = [
        "# Limits\n",
        "What each robot's firmware allows. The profile in the robot is the authority: `softrig info` reads it.\n",
    ]
    for file in sorted(ROBOTS.glob("*.json")):
        profile = json.loads(file.read_text(encoding="utf-8"))
        channels = [(str(i), row["label"], row["kind"], wired(row)) for i, row in enumerate(profile["channels"])]
        groups = [(name, labels) for name, labels in profile["groups"]]
        sensors = [(name, profile[key]["address"]) for name, key in SENSORS.items() if key in profile]
        sensor = "".join(f" {name} at 0x{address:02X}." for name, address in sensors)
        parts += [f"## {profile['robot']}\nSupply {profile['supply_mv']} mV.{sensor}\n"]
        parts.append(table(("bit", "label", "kind", "driven by"), channels))
        parts += [table(("group", "labels"), groups)] if groups else []
        cells = [(str(i), row["label"], f"AIN{row['input']}") for i, row in enumerate(profile.get("cells", ()))]
        parts += [table(("bit", "force cell", "read on"), cells)] if cells else []
        sections = [part for part in SECTIONS if part in profile]
        joint = profile.get("servo", {}).get("unit", "")
        limits = [
            (f"{part}.{key}", str(value), unit_of(key, joint))
            for part in sections
            for key, value in profile[part].items()
        ]
        parts.append(table(("limit", "value", "unit"), limits))
    return "\n".join(parts)


def wired(row: dict[str, Any]) -> str:
    """Return what drives a channel of a profile."""
    if row["kind"] == "servo":
        return f"GP{row['pin']}; current on AIN{row['current']}, position on AIN{row['position']}"
    return f"0x{row['chip']:02X}, output {row['output']}"


def unit_of(key: str, joint: str) -> str:
    """Return the unit that ends a profile's key, whether or not `_max` follows it; `joint` is that of the joints."""
    found = next((unit for end, unit in UNITS.items() if key.removesuffix("_max").endswith(end)), "")
    return found.format(joint=joint)


def commands_page() -> str:
    """Return the help of every command."""
    top = click.Context(softrig, info_name="softrig", terminal_width=WIDTH, **softrig.context_settings)
    parts = ["# Commands\n", help_of(top)]
    for context in contexts(softrig, top):
        parts += [f"## {context.command_path}\n", help_of(context)]
    return "\n".join(parts)


def contexts(group: click.Group, above: click.Context) -> Iterator[click.Context]:
    """Yield the context of everything below a group that has no commands of its own."""
    for name in group.list_commands(above):
        command = group.get_command(above, name)
        if command is not None:
            context = click.Context(command, info_name=name, parent=above)
            yield from contexts(command, context) if isinstance(command, click.Group) else [context]


def help_of(context: click.Context) -> str:
    """Return what `--help` prints, as a block."""
    return f"```\n{context.get_help()}\n```\n"


def table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """Return a Markdown table."""
    lines = [heads, tuple("---" for _ in heads), *rows]
    return "".join("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |\n" for row in lines)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
