"""The pages say what is so: generated ones are fresh, commands and files that the README names exist."""

import importlib.util
import re
from pathlib import Path

import click
import pytest

from host.cli import main as softrig
from protocol.frames import RELIABLE, Decoder, StopFinder
from protocol.messages import FIRE

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.fixture
def generate():
    """Return docs/generate.py as a module."""
    spec = importlib.util.spec_from_file_location("generate", ROOT / "docs" / "generate.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_generated_pages_are_fresh(generate):
    assert generate.main(["--check"]) == 0


def test_a_page_that_is_not_as_its_table_is_named(generate, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(generate, "ROOT", tmp_path)
    generate.main([])
    (tmp_path / "docs" / "codes.md").write_text("R04 is out of fashion\n")

    status = generate.main(["--check"])

    assert status == 1
    assert capsys.readouterr().err == "docs/codes.md is out of date: make docs\n"


def test_the_page_of_limits_counts_joints_in_their_own_unit_and_names_force_cells(generate):
    page = generate.limits_page()
    fingers, press = (page[page.index(f"## {name}\n") :].split("\n## ")[0] for name in ("fingers", "press"))

    assert "| servo.most_centi | 3000 | 0.01 deg |" in fingers
    assert "force cell" not in fingers
    assert "| servo.slew_centi_per_s | 1000 | 0.01 mm/s |" in press
    assert "| load.trip_mn | 20000 | mN |" in press
    assert "| 5 | C6 | AIN7 |" in press


def test_the_worked_example_on_the_protocol_page_is_the_order_that_it_says(generate):
    page = generate.protocol_page()
    wire = re.search(r"^\| on the wire \| `([0-9a-f ]+)` \|$", page, re.MULTILINE)[1]
    crc, session = re.search(r"crc32\(78 56 34 12, 0x(\w+)\)", page)[1], 0x12345678

    (frame,) = Decoder(int(crc, 16), session).feed(bytes.fromhex(wire))

    assert FIRE.unpack(frame.payload) == (1, 600, 500)
    assert (frame.seq, frame.ack, frame.flags) == (1, 3, RELIABLE)


def test_every_frame_of_the_conversation_on_the_protocol_page_is_whole(generate):
    page = generate.protocol_page()
    talk = page[page.index("## A conversation") : page.index("## Messages")]
    lines = re.findall(r"^(?:host |robot)  ((?:[0-9a-f]{2}\s+)+)", talk, re.MULTILINE)
    session = int(re.search(r"Session 0x(\w+)", talk)[1], 16)
    crc = int(re.search(r"its CRC-32 is 0x(\w+)", talk)[1], 16)
    decoder, finder = Decoder(crc, session), StopFinder()

    wire = [bytes.fromhex(line) for line in lines]
    found = [frame for line in wire for frame in decoder.feed(line)]

    assert (len(wire) - len(found), decoder.dropped) == (1, 0)
    assert [finder.feed(line) for line in wire].count(True) == 1


def test_every_command_the_readme_names_exists():
    context = click.Context(softrig)

    named = set(re.findall(r"(?:^|`)softrig ([a-z]+)", README, re.MULTILINE))

    assert len(named) > 8
    assert named <= set(softrig.list_commands(context))


def test_every_target_the_readme_names_exists():
    targets = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))

    named = set(re.findall(r"(?:^|`)make ([a-z]+)", README, re.MULTILINE))

    assert {"demo", "test"} <= named <= targets


@pytest.mark.parametrize(
    "page", ["README.md", "docs/design.md", "docs/fingers.md", "docs/gait.md", "docs/gait-reference.md"]
)
def test_every_file_a_page_links_to_exists(page):
    text = (ROOT / page).read_text(encoding="utf-8")

    linked = [(ROOT / page).parent / path for path in re.findall(r"\]\(([^)#:]+)\)", text)]
    named = [
        ROOT / path for path in re.findall(r"`((?:gaits|hil_sim|host|firmware|protocol|docs|tests)/[\w/.-]+)`", text)
    ]

    assert linked
    assert [str(path) for path in linked + named if not path.exists()] == []


def test_every_make_target_is_listed_by_bare_make():
    text = (ROOT / "Makefile").read_text(encoding="utf-8")

    phony = re.search(r"^\.PHONY: (.*)$", text, re.MULTILINE)[1].split()

    assert all(f'@echo "make {target} ' in text for target in phony if target != "help")


def test_the_program_in_the_readme_runs(capsys):
    (program,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)

    exec(program, {})

    assert "state='armed'" in capsys.readouterr().out
