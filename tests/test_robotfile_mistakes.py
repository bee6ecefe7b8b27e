"""What a robot file, a name or an override may get wrong, and what the user is told."""

from pathlib import Path

import pytest

from hil_sim.address import parse
from hil_sim.assembly import assemble
from hil_sim.robots.file import FOLDER, RobotFileError, load
from tests.robot_mistakes import refusal, told_of

CIRCULAR = (FOLDER / "circular.toml").read_text(encoding="utf-8")

# text to replace, its replacement, and the line and words that must be told
MISTAKES = [
    ("mass_g = [1.6,", "mass = [1.6,", "mass has no unit: write mass_g"),
    ("radius_mm = [20.0,", "radius_cm = [2.0,", "radius_cm: this number is kept as radius_mm"),
    ("friction_ratio =", "frictoin_ratio =", "unknown key frictoin_ratio; did you mean friction_ratio?"),
    ("[ground]", "[grond]", "unknown section [grond]; did you mean ground?"),
    ('"fitted: crawl', '"guess: crawl', "standing 'guess' is none of paper, read, measured, derived, assumed, fitted"),
    ('nodes_count = [32, "assumed: ', 'nodes_count = 32  # "', "nodes_count: write it as nodes_count = [value, "),
    ('"read: standard gravity"', '"read"', "read where?"),
    ('"read: standard gravity"', '"measured: "', "measured on what? Write it as measured: source"),
    ("slope_deg = [0.0,", "slope_deg = [85.0,", "ground.slope_deg is 85, it must be at least -60 and at most 60"),
    ("wire_diameter_mm = [0.10,", "wire_diameter_mm = [nan,", "wire_diameter_mm is nan, it must be at least 0.001 and"),
    ("martensite_finish_degc = [42.0,", "martensite_finish_degc = [55.0,", "the temperatures must rise"),
    ('kind = "ring"', 'kind = "wheel"', "kind 'wheel' is none of ring"),
    ('"G", "H"]', '"G", "G"]', "labels: each coil needs its own"),
    ("H = [96, 7]", "H = [96, 6]", "outputs: H and G share [96, 6]"),
    ("H = [96, 7]", "H = [96, 16]", "outputs: H on output 16, a chip has 0 to 15"),
    ("H = [96, 7]", "H = [64, 7]", "outputs: H on chip 64, the board has 96 and 97"),
    ("mass_g = [1.6,", f"mass_g = [{'9' * 400},", "mass_g: write it as mass_g = [value, "),
    ('["A", "B", "C", "D", "E", "F", "G", "H"]', "[]", "labels: a robot has at least one coil"),
    (", H = [96, 7]", "", "outputs: one [chip, output] for each of A, B, C, D, E, F, G, H"),
]


@pytest.mark.parametrize(("right", "wrong", "told"), MISTAKES)
def test_a_mistake_is_told_with_its_line(right, wrong, told, tmp_path):
    message = told_of(CIRCULAR, right, wrong, tmp_path)

    assert told in message
    assert len(message.splitlines()) == 1


def test_a_missing_number_is_told_at_its_section(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text("\n".join(line for line in CIRCULAR.splitlines() if not line.startswith("stretch_stiff")))
    line = CIRCULAR.splitlines().index("[shell]") + 1

    assert refusal(str(file)).startswith(f"{file}:{line}: [shell] lacks stretch_stiffness_n: add stretch_")


def test_all_mistakes_are_told_at_once(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(CIRCULAR.replace("mass_g = [1.6", "mass = [1.6").replace("[0.6, ", "[-0.6, "), encoding="utf-8")

    assert len(refusal(str(file)).splitlines()) == 2


def test_a_file_that_is_no_toml_is_told_with_its_line(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text("about = unquoted\n", encoding="utf-8")

    assert "line 1" in refusal(str(file))


@pytest.mark.parametrize(("data", "told"), [(b"\xff\xfe\x00", "not UTF-8"), (b"a = " + b"[" * 100_000, "too deeply")])
def test_a_file_that_is_no_text_or_without_end_is_told_so(data, told, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_bytes(data)

    assert told in refusal(str(file))


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        ('"label": "H"', '"label": "Z"', "differ in labels, outputs or inputs: H Z"),
        ("{", "{,", "no profile of a robot"),
    ],
)
def test_a_profile_that_does_not_fit_its_body_is_refused(right, wrong, told, tmp_path):
    (tmp_path / "mine.toml").write_text(CIRCULAR.replace('profile = "circular"', 'profile = "mine.json"'))
    (tmp_path / "mine.json").write_text(load("circular").profile.read_text().replace(right, wrong, 1))

    with pytest.raises(RobotFileError, match=told):
        assemble(parse(str(tmp_path / "mine.toml")))


def test_a_profile_that_is_not_there_is_told_with_those_that_are(tmp_path):
    (tmp_path / "mine.toml").write_text(CIRCULAR.replace('profile = "circular"', 'profile = "mine"'))

    with pytest.raises(RobotFileError, match=r"profile: .*mine.json: No such file .*; known are circular, fingers, "):
        assemble(parse(str(tmp_path / "mine.toml")))


def test_an_empty_file_is_refused_and_does_not_crash(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text("", encoding="utf-8")

    assert "the file lacks profile" in refusal(str(file))


def test_an_unknown_robot_is_told_the_known_ones():
    assert refusal("circulr").startswith("no robot 'circulr'; did you mean circular?; known are circular")
    assert refusal("./nowhere.toml") == "./nowhere.toml: no such robot file"


def test_a_lab_names_its_own_file_and_its_profile_lies_beside_it(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(CIRCULAR.replace('profile = "circular"', 'profile = "mine.json"'), encoding="utf-8")

    robot = load(str(file))

    assert robot.name == "mine"
    assert robot.profile == Path(tmp_path / "mine.json")


def test_an_override_is_in_the_unit_of_its_key():
    robot = load("circular", {"shell.mass_g": "6", "ground.slope_deg": "10", "shell.nodes_count": "64"})

    assert robot.ring.m == pytest.approx(0.006)
    assert robot.ground.slope == pytest.approx(0.174533)
    assert robot.ring.nodes == 64
    assert {entry.source for entry in robot.entries if entry.name == "shell.mass_g"} == {"set by the robot's address"}


def test_an_override_that_cannot_be_used_is_refused():
    assert refusal("circular", {"shell.mas_g": "6"}) == "set=shell.mas_g: no such number; did you mean shell.mass_g?"
    assert refusal("circular", {"shell.mass_g": "6g"}) == "set=shell.mass_g:6g: '6g' is not a number"
    assert refusal("circular", {"shell.mass_g": "-6"}).endswith("is -6, it must be at least 0.001 and at most 100000")


def test_every_number_keeps_its_source():
    entry = next(entry for entry in load("circular").entries if entry.name == "coils.density_kg_per_m3")

    assert (entry.value, entry.standing, entry.source) == (6450.0, "read", "Flexinol, TCF1140")
