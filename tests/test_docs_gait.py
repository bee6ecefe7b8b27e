"""docs/gait.md teaches what is so: its scripts are sound, those that it runs end well, its commands are there."""

import re
import shlex
from contextlib import chdir

import click
import pytest

from host.cli import main as softrig
from host.gait.checker import check
from host.gait.compiler import compile_script
from host.gait.diagnostics import GaitError
from host.gait.script import loads
from protocol.program import disassemble
from tests.gait_scripts import ROOT, profile_of

PAGE = (ROOT / "docs" / "gait.md").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")
FENCED = re.findall(r"^```([\w -]*)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
SCRIPTS = [(kind.split()[1:], text) for kind, text in FENCED if kind.startswith("gait") and kind != "gait wrong"]
RUN = [text for words, text in SCRIPTS if "run" in words]
COMMANDS = [line for kind, text in FENCED if not kind for line in text.splitlines()]


def whole(words: list[str], text: str) -> str:
    """Return an example as a script: one without a head is for the circular robot, or the one that it names."""
    if text.startswith("gait 1"):
        return text
    return f"gait 1\nrobot {words[0] if words else 'circular'}\n{text}"


def compiled(text: str):
    script = loads(text, str(ROOT / "gaits" / "example.gait"))
    return compile_script(script, profile_of(script.robot_name()))


@pytest.mark.parametrize(("words", "text"), SCRIPTS, ids=[text.split("\n")[0] for _, text in SCRIPTS])
def test_every_script_of_the_page_is_sound(words, text):
    assert check(compiled(whole(words, text))).diagnostics == ()


@pytest.mark.parametrize("text", [text for text in RUN[1:] if "sym" not in text])
def test_a_script_that_the_page_runs_ends_well(text, tmp_path):
    (tmp_path / "lib").symlink_to(ROOT / "gaits" / "lib")
    path = tmp_path / "example.gait"
    path.write_text(text)

    softrig(["run", str(path), "--robot", "sim:circular"], standalone_mode=False)


def test_the_script_of_the_readme_is_sound():
    (text,) = re.findall(r"^```\n(gait 1\n.*?)^```$", README, re.MULTILINE | re.DOTALL)

    assert check(compiled(text)).diagnostics == ()


def test_the_mistakes_that_the_page_shows_are_told_so():
    ((_, text),) = [row for row in FENCED if row[0] == "gait wrong"]
    ((_, told),) = [row for row in FENCED if row[0] == "message"]

    with pytest.raises(GaitError) as caught:
        compile_script(loads(text, "second.gait"), profile_of("circular"))

    assert "\n".join(str(each) for each in caught.value.diagnostics) + "\n" == told


def test_the_commands_of_the_page_run_one_after_another(tmp_path):
    (tmp_path / "first.gait").write_text(RUN[0])

    with chdir(tmp_path):
        for line in COMMANDS:
            softrig(shlex.split(line)[1:], standalone_mode=False)

    assert (tmp_path / "first.svg").stat().st_size


def test_the_page_names_commands_that_exist():
    named = set(re.findall(r"`softrig ([a-z]+)", PAGE)) | {line.split()[1] for line in COMMANDS}

    assert named <= set(softrig.list_commands(click.Context(softrig)))


def test_the_page_names_every_script_that_comes_with_it():
    named = re.findall(r"`((?:circular|sphere|fingers|press)-[\w-]+)`", PAGE)

    assert set(named) - {"sphere-a", "sphere-b"} == {path.stem for path in (ROOT / "gaits").glob("*.gait")}


def test_the_crawl_of_the_page_goes_as_far_as_it_says(tmp_path, capsys):
    text = next(text for text in RUN if "sym" in text)
    (tmp_path / "lib").symlink_to(ROOT / "gaits" / "lib")
    (tmp_path / "crawl.gait").write_text(text)

    softrig(["run", str(tmp_path / "crawl.gait"), "--robot", "sim:circular"], standalone_mode=False)

    told = float(re.search(r"travel +([\d.]+) mm", capsys.readouterr().out)[1])
    assert told == pytest.approx(float(re.search(r"it comes (\d+) mm far", PAGE)[1]), abs=2)


def test_the_coils_that_a_turn_means_are_those_that_the_page_names():
    (text,) = [text for words, text in SCRIPTS if "sphere-b" in words]
    named = re.search(r"so this is (\w+),", text)[1]
    profile = profile_of("sphere-b")

    fired = [row[2] for row in disassemble(compiled(whole(["sphere-b"], text)).code) if row[1] == "fire"]

    assert profile.named(fired[0]) == (named,)
