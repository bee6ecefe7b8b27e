"""Robot files with one mistake each, and what is told of it."""

from pathlib import Path

import pytest

from hil_sim.robots.file import RobotFileError, load


def refusal(*arguments) -> str:
    """Return what is told of a robot that cannot be loaded."""
    with pytest.raises(RobotFileError) as caught:
        load(*arguments)
    return str(caught.value)


def told_of(text: str, right: str, wrong: str, folder: Path) -> str:
    """Return what is told of a file in which one piece of text is another, after the place of that piece."""
    assert text.count(right) == 1
    file = folder / "mine.toml"
    file.write_text(text.replace(right, wrong), encoding="utf-8")
    line = text[: text.index(right)].count("\n") + 1

    message = refusal(str(file))

    assert message.startswith(f"{file}:{line}: ")
    return message
