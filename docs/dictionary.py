"""The dictionary that every robot carries beside its firmware: definitions and help texts, made for people and hosts.

`protocol/dictionary.txt` has a line for each message, enum and variable and ends in a blank line; with the robot's
profile behind it, it is the dictionary, whose CRC-32 is the seed of the frames. `protocol/help.txt` has a line of words
for each name in it and each code.

    20 fire coils:I duty_permille:H[0..1000] hold_ms:H
    STATES boot idle armed running tripped
    var 7 current_ma:H
    var 26 joint_centi:h+
    CODES =1 R01 R02 ... =101 F01
"""

from collections.abc import Iterator

from docs import definitions
from protocol import causes


def definition_text() -> str:
    """Return the definitions: messages in the order of their numbers, then enums, then variables."""
    lines = [row.definition for row in sorted(definitions.rows(), key=lambda row: row.number)]
    lines += [enum_line(name, names) for name, names in definitions.enums().items()]
    lines += [f"var {number} {place.definition}" for number, place in enumerate(definitions.variables())]
    return _text(lines) + "\n"


def help_text() -> str:
    """Return the words: what each name of the definitions means, and what to do about each code."""
    variables = [f"var.{place.name} {place.words}" for place in definitions.variables()]
    return _text([*_messages(), *variables, *_codes()])


def enum_line(name: str, names: dict[int, str]) -> str:
    """Return an enum as the dictionary prints it: names count from 0, `=7` says that the next one has the value 7."""
    words, due = [name], 0
    for number in sorted(names):
        words += [names[number]] if number == due else [f"={number}", names[number]]
        due = number + 1
    return " ".join(words)


def _messages() -> Iterator[str]:
    for row in sorted(definitions.rows(), key=lambda row: row.number):
        yield f"{row.name} {row.words}"
        yield from (f"{row.name}.{place.name} {place.words}" for place in row.fields)


def _codes() -> Iterator[str]:
    for code in causes.CODES:
        unit = f" [{code.unit}]" if code.unit else ""
        yield f"{code.name}{unit} {code.cause} {code.did} {code.todo}"


def _text(lines: list[str]) -> str:
    text = "".join(line + "\n" for line in lines)
    if "\n\n" in text or not text.isascii():
        raise ValueError("a dictionary is ASCII, and a blank line ends its definitions")
    return text
