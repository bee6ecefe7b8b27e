"""Writes the pages of docs/ that repeat what stands in a table elsewhere; `--check` only says which are out of date.

python docs/generate.py            # make docs
python docs/generate.py --check    # part of make check
"""

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import click

from docs import faultspage, hardwarepage, meanings, schematic
from host.cli import main as softrig
from host.gait.errors import ROWS
from protocol import causes, frames, link, messages, program

DOCS = Path(__file__).parent
ROBOTS = DOCS.parent / "firmware" / "robots"
MADE = "<!-- Made by docs/generate.py: change the table it comes from and run `make docs`. -->\n\n"
TYPES = {
    "B": ("u8", 1),
    "b": ("i8", 1),
    "H": ("u16", 2),
    "h": ("i16", 2),
    "I": ("u32", 4),
    "i": ("i32", 4),
    "s": ("rest", 0),
}
ARGUMENTS = {
    "fire": "coils u32, duty u16 [permille], time u16 [ms], cut-off u16 [0.1 C; 0: none]",
    "ramp": "coils u32, duty u16 [permille], time u16 [ms], cut-off u16 [0.1 C; 0: none], ramp u16 [ms]",
    "delay": "time u32 [ms]",
    "repeat": "count u16",
    "wait": "condition u64, timeout u32 [ms], otherwise u8 [0: abort, 1: continue]",
    "guard": "condition u64",
    "step": "number u16",
    "off": "coils u32",
    "aim": "place u8, ahead u8, circle of 8 channels u64 [255: none]",
    "aimed": "place u8, duty u16 [permille], time u16 [ms], cut-off u16 [0.1 C; 0: none], ramp u16 [ms]",
}
UNITS = {
    "_uj_per_k": "µJ/K", "_uw_per_k": "µW/K", "_mv": "mV", "_ma": "mA", "_mj": "mJ", "_uj": "µJ", "_mohm": "mΩ",
    "_ms": "ms", "_degc": "°C", "_permille": "‰", "bytes": "bytes",
}  # fmt: skip
WIDTH = 100  # of the help texts


def main(arguments: list[str]) -> int:
    """Write every page, or with `--check` return 1 and name those that are not as they would be written."""
    stale = [name for name, page in pages() if not is_fresh(DOCS / name, page)]
    if "--check" in arguments:
        for name in stale:
            print(f"docs/{name} is out of date: make docs", file=sys.stderr)
        return 1 if stale else 0
    for name, page in pages():
        (DOCS / name).write_text(page, encoding="utf-8")
    return 0


def pages() -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each page."""
    yield "protocol.md", MADE + protocol_page()
    yield "codes.md", MADE + codes_page()
    yield "faults.md", MADE + faults_page()
    yield "limits.md", MADE + limits_page()
    yield "commands.md", MADE + commands_page()
    yield "hardware.md", MADE + hardware_page()
    yield "schematic.svg", schematic.svg()


def is_fresh(path: Path, page: str) -> bool:
    """Return whether the file holds just this text."""
    return path.exists() and path.read_text(encoding="utf-8") == page


def protocol_page() -> str:
    """Return the wire protocol: the prose of the template, the tables from the code."""
    hello = messages.HELLO.pack(version=frames.VERSION, session=0x12345678)
    return (
        (DOCS / "templates" / "protocol.md")
        .read_text(encoding="utf-8")
        .format(
            version=frames.VERSION,
            body_max=frames.BODY_MAX,
            payload_max=frames.PAYLOAD_MAX,
            reliable=frames.RELIABLE,
            unseeded=frames.UNSEEDED_BELOW,
            hello_payload=hello.hex(" "),
            hello=frames.encode(frames.seal(messages.HELLO.number, 0, 0, hello, 0, 0)).hex(" "),
            stop=frames.STOP.hex(" "),
            window=link.WINDOW,
            rto_first=link.RTO_FIRST_MS,
            rto_max=link.RTO_MAX_MS,
            tries=link.TRIES_MAX,
            messages="\n".join(message_section(message) for message in messages.MESSAGES),
            states=", ".join(f"{number} {name}" for number, name in enumerate(messages.STATES)),
            events=", ".join(f"{number} {name}" for number, name in enumerate(messages.EVENTS) if name),
            header_bytes=program.HEADER_BYTES,
            format=program.FORMAT,
            outlives=program.OUTLIVES_HOST,
            ops=op_table(),
            sources="1 coil temperature, 2 supply current, 3 supply voltage, 4 board temperature, 5 coil heat, "
            "6 roll, 7 pitch, 8 coil nearest to down",
            aims_max=program.AIMS_MAX,
            depth_max=program.DEPTH_MAX,
            guards_max=program.GUARDS_MAX,
        )
    )


def message_section(message: messages.Message) -> str:
    """Return one message with its fields."""
    words = meanings.read()
    head = f"### 0x{message.number:02X} {message.name}\n{words[message.name]}\n"
    if not message.fields:
        return head + "No payload.\n"
    rows, offset = [], 0
    for field in message.fields:
        kind, size = TYPES[field.letter]
        rows.append((str(offset), kind, f"`{field.name}`", words[f"{message.name}.{field.name}"]))
        offset += size
    return head + "\n" + table(("offset", "type", "field", ""), rows)


def op_table() -> str:
    """Return the op-codes with their bytes; ValueError when a size here is not the size in the code."""
    rows = []
    for number, name in enumerate(program.NAMES):
        arguments = ARGUMENTS.get(name, "")
        size = 1 + sum(int(bits) // 8 for bits in re.findall(r" u(\d+)", arguments))
        if size != program.SIZES[number]:
            raise ValueError(f"{name}: {size} bytes described, {program.SIZES[number]} in protocol/program.py")
        function = getattr(program, "next_" if name == "next" else name)
        rows.append((f"0x{number:02X}", str(size), name, arguments, first_sentence(function.__doc__)))
    return table(("op", "bytes", "name", "arguments", ""), rows)


def codes_page() -> str:
    """Return every refusal, fault and script error; `softrig explain CODE` prints one of them."""
    robot = [(row.name, str(row.number), row.unit, row.cause, row.did, row.todo) for row in causes.CODES]
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
    template = (DOCS / "templates" / "hardware.md").read_text(encoding="utf-8")
    return template.format(**hardwarepage.fields(ROBOTS, table))


def faults_page() -> str:
    """Return what can go wrong on the bench and what is promised then."""
    return (DOCS / "templates" / "faults.md").read_text(encoding="utf-8").format(**faultspage.fields(table))


def limits_page() -> str:
    """Return labels and limits of each robot's profile."""
    parts = [
        "# Limits\n",
        "What each robot's firmware allows. The profile in the robot is the authority: `softrig info` reads it.\n",
    ]
    for file in sorted(ROBOTS.glob("*.json")):
        profile = json.loads(file.read_text(encoding="utf-8"))
        channels = [
            (str(i), c["label"], c["kind"], f"0x{c['chip']:02X}", str(c["output"]))
            for i, c in enumerate(profile["channels"])
        ]
        groups = [(name, labels) for name, labels in profile["groups"]]
        sensor = f" Attitude sensor at 0x{profile['imu']['address']:02X}." if "imu" in profile else ""
        parts += [f"## {profile['robot']}\nSupply {profile['supply_mv']} mV.{sensor}\n"]
        parts += [table(("bit", "label", "kind", "chip", "output"), channels), table(("group", "labels"), groups)]
        sections = ("coil", "supply", "session", "program")
        limits = [
            (f"{part}.{key}", str(value), unit_of(key)) for part in sections for key, value in profile[part].items()
        ]
        parts.append(table(("limit", "value", "unit"), limits))
    return "\n".join(parts)


def unit_of(key: str) -> str:
    """Return the unit that ends a profile's key, whether or not `_max` follows it."""
    return next((unit for end, unit in UNITS.items() if key.removesuffix("_max").endswith(end)), "")


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


def first_sentence(docstring: str | None) -> str:
    """Return the first line of a docstring."""
    return (docstring or "").strip().splitlines()[0]


def table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """Return a Markdown table."""
    lines = [heads, tuple("---" for _ in heads), *rows]
    return "".join("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |\n" for row in lines)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
