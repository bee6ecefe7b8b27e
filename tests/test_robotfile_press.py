"""The file of the press, and what the user is told of one that is wrong."""

import re
import tomllib

import pytest

from hil_sim.address import AddressError, parse
from hil_sim.assembly import assemble
from hil_sim.physics.block.law import fastest
from hil_sim.robots.file import FOLDER, PROFILES, RobotFileError, load
from hil_sim.robots.keys import features_of, keys_of
from tests.robot_mistakes import refusal, told_of

TEXT = (FOLDER / "press.toml").read_text(encoding="utf-8")

# text to replace, its replacement, and the line and words that must be told
MISTAKES = [
    ("youngs_modulus_kpa = [60.0,", "youngs_modulus_mpa = [0.06,", "this number is kept as youngs_modulus_kpa"),
    ("width_mm = [80.0,", "width = [80.0,", "width has no unit: write width_mm"),
    (
        "columns_count = [64,",
        "columns_count = [64.5,",
        "block.columns_count is 64.5, it must be at least 2 and at most",
    ),
    ("stall_force_n = [40.0,", "stall_force_n = [-3.0,", "axis.stall_force_n is -3, it must be at least"),
    (
        "poisson_ratio = [0.35,",
        "poisson_ratio = [0.5,",
        "material.poisson_ratio is 0.5, it must be at least -0.9 and at",
    ),
    ('indenter = "cylinder"', 'indenter = "ball"', "indenter 'ball' is none of cylinder, flat, bonded, polygon"),
    ('plane = "strain"', 'plane = "thin"', "plane 'thin' is none of strain, stress"),
    ('kind = "press"', 'kind = "pres"', "kind 'pres' is none of fingers, press"),
    ('labels = ["P"]', 'labels = ["P", "Q"]', 'labels: write them as ["P"]'),
    ('labels = ["P"]', "labels = 1", 'labels: write them as ["P"]'),
    ("corners_mm = [[-15, 10],", "corners_mm = [[-15],", "corners_mm: write them as [[x, y], ...], x from the axis"),
    ("corners_mm = ", "mesh = 3 # ", "mesh: write it as mesh ="),
    (
        "C1 = [50, 75]",
        "C1 = 40",
        "centres_percent: write them as { C1 = [x, y], ... }, of the block's width and height",
    ),
    (" C6 = [75, 37.5] }", f"{','.join(f' D{i} = [9, 9]' for i in range(9))} }}", "14 cells, the converters have 13"),
    (
        "[cells]\n",
        "[cells]\ncentres_mm = {}\n",
        "[cells] needs centres_percent or centres_mm, and has centres_percent an",
    ),
    ("pins = { P = 8 }", "pins = { P = 11 }", "pins: P on pin 11, the board has servos on 8, 9, 10"),
    ("pins = { P = 8 }", "pins = { R = 8 }", "pins: one pin for each of P, as in P = 8"),
    (
        "viscosity_kpa_s = [300.0,",
        "viscosity_kpa_s = [0.0,",
        "material.youngs_modulus_kpa is 60 and material.visc",
    ),
    ("[axis]", "[servos]", "unknown section [servos]: it belongs to a robot with fingers"),
    ("supply_v =", "lead_ohm =", "unknown key lead_ohm: it belongs to a robot with coils"),
]


def robot(**overrides):
    """Return the press with other numbers and choices, a double underscore for the dot."""
    return load("press", {name.replace("__", "."): str(value) for name, value in overrides.items()})


@pytest.mark.parametrize(("right", "wrong", "told"), MISTAKES)
def test_a_mistake_is_told_with_its_line(right, wrong, told, tmp_path):
    assert told in told_of(TEXT, right, wrong, tmp_path).splitlines()[0]


def test_its_sizes_are_in_si_units():
    press = load("press").press

    assert [press.width, press.height, press.thickness, press.R, press.w] == [0.080, 0.040, 0.040, 0.015, 0.020]
    assert [press.columns, press.rows, press.dt, press.side, press.at] == [64, 32, 0.010, 0.005, None]
    assert (press.centres["C5"], press.relative) == ((0.25, 0.375), True)
    assert (press.screw.stall_a, press.screw.idle_a, press.backlash) == (1.5, 0.010, 0.0)


def test_its_material_has_three_elements_of_one_poisson_ratio():
    material = load("press").press.material

    ((E, c, nu, other),) = material.branches
    assert (E, c, nu, other) == (60e3, 300e3, 0.35, None)
    assert (material.E0, material.c0, material.nu0, material.nu_c) == (0.0, 6e3, 0.35, 0.35)
    assert (material.plane, material.dual) == ("strain", False)


def test_one_poisson_ratio_is_that_of_all_parts_that_have_none_of_their_own():
    material = robot(material__poisson_ratio=0.2, material__damping_poisson_ratio=0).press.material

    assert (material.branches[0].nu, material.nu0, material.nu_c) == (0.2, 0.2, 0.0)


def test_an_address_gives_a_second_branch_and_other_viscosities_of_unloading():
    numbers = ("youngs_modulus_2_kpa:20", "viscosity_2_kpa_s:8", "poisson_2_ratio:0.4", "unloading_viscosity_kpa_s:80")
    address = parse("sim:press?plane=stress&" + "&".join(f"set=material.{number}" for number in numbers))

    material = load(address.robot, address.overrides).press.material

    assert material.branches[1] == (20e3, 8e3, 0.4, None)
    assert (material.branches[0].c_unloading, material.c0_unloading, material.plane) == (80e3, None, "stress")


def test_its_derived_section_follows_from_its_numbers():
    material = load("press").press.material
    branch = material.branches[0]

    told = tomllib.loads(TEXT)["derived"]

    follows = {"relaxation_s": branch.c / branch.E, "recovery_s": 1 / fastest(material)}
    assert follows == pytest.approx({key: value for key, (value, _) in told.items()}, rel=2e-3)


@pytest.mark.parametrize(
    ("name", "options", "told"),
    [
        ("press", "slope=10", "set=ground.slope_deg: no such number: it belongs to a robot with a shell"),
        ("fingers", "indenter=flat", "indenter=flat: no such choice: it belongs to a robot with a press"),
        ("press", "set=block.with_mm:9", "did you mean block.width_mm?"),
        ("press", "set=material.viscosity_2_kpa_s:9", "youngs_modulus_2_kpa 0: a branch has both, or neither"),
        ("press", "set=axis.backlash_mm:-1", "axis.backlash_mm is -1, it must be at least 0"),
    ],
)
def test_an_address_cannot_choose_what_the_robot_has_not(name, options, told):
    assert told in refusal(name, parse(f"sim:{name}?{options}").overrides)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ("open=P", "open=P: press has no coils"),
        ("body=still", "body=still: press has no coils to heat while it does not move"),
        ("set=indenter.at_mm:200", "from these numbers: no surface node lies below the indenter"),
        ("set=cells.side_mm:25", "from these numbers: force cell C1: the cell of 0.025 m at"),
        ("set=material.youngs_modulus_kpa:0&set=material.viscosity_kpa_s:0&set=material.damping_kpa_s:0",
         "no Maxwell branch: the material resists nothing"),
    ],
)  # fmt: skip
def test_a_bench_that_cannot_be_is_refused_by_what_is_wrong(options, told):
    with pytest.raises(RobotFileError, match=re.escape(told)):
        assemble(parse(f"sim:press?{options}"))


def mine(folder, *replacements):
    """Return the path of a robot file that differs from the press in some pieces of text."""
    text = TEXT
    for right, wrong in replacements:
        assert text.count(right) == 1
        text = text.replace(right, wrong)
    (folder / "mine.toml").write_text(text, encoding="utf-8")
    return folder / "mine.toml"


def test_a_polygon_without_corners_is_told_also_from_an_address(tmp_path):
    path = mine(tmp_path, ("corners_mm = [[", "# [["))

    assert "indenter polygon needs corners_mm" in refusal(str(path), {"press.indenter": "polygon"})


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [("pins = { P = 8 }", "pins = { P = 9 }", "P"), ("C6 = [75, 37.5]", "D6 = [75, 37.5]", "D6 C6"),
     (", C6 = [75, 37.5]", "", "load C6")],
)  # fmt: skip
def test_what_is_wired_otherwise_than_the_profile_says_is_told(right, wrong, told, tmp_path):
    with pytest.raises(RobotFileError, match=rf"mine and its profile .*press.json differ in labels, .*: {told}$"):
        assemble(parse(f"sim:{mine(tmp_path, (right, wrong))}"))


def test_a_load_cell_that_is_read_at_another_input_is_told(tmp_path):
    profile = (PROFILES / "press.json").read_text(encoding="utf-8")
    (tmp_path / "mine.json").write_text(profile.replace('"load": {"input": 8', '"load": {"input": 9'), encoding="utf-8")
    path = mine(tmp_path, ('profile = "press"', 'profile = "mine.json"'))

    with pytest.raises(RobotFileError, match=r"differ in labels, outputs or inputs: load$"):
        assemble(parse(f"sim:{path}"))


def test_an_unknown_choice_is_told_the_known_ones():
    with pytest.raises(
        AddressError, match="no indenter 'flt': known are cylinder, flat, bonded, polygon; did you mean f"
    ):
        parse("sim:press?indenter=flt")


CELLS = ("width_mm = [80.0", "height_mm = [40.0", "columns_count =", "rows_count =")


def test_a_block_of_its_own_mesh_has_no_cells_to_be_cut_into(tmp_path):
    path = mine(tmp_path, ('plane = "strain"', 'plane = "strain"\nmesh = "block.msh"'))

    lines = refusal(str(path)).splitlines()

    assert len(lines) == 4
    assert all("it belongs to a robot with a block without a mesh" in line for line in lines)


def test_a_mesh_that_cannot_be_read_is_told_by_its_path(tmp_path):
    gone = [(f"\n{key}", f"\n# {key}") for key in CELLS]
    path = mine(tmp_path, ('plane = "strain"', 'plane = "strain"\nmesh = "block.msh"'), *gone)

    with pytest.raises(RobotFileError, match=r"the mesh of mine, .*block.msh: there is no such file"):
        assemble(parse(f"sim:{path}"))


@pytest.mark.parametrize("key", keys_of(features_of("press")), ids=lambda key: key.name)
def test_every_number_can_be_set_from_an_address(key):
    least, most = max(key.least, -1e3), min(key.most, 1e3)
    value = float(round(least + (most - least) / 3)) if key.multiple else least + (most - least) / 3
    pair = {"material.youngs_modulus_2_kpa": "1", "material.viscosity_2_kpa_s": "1"} if "_2_" in key.name else {}

    robot = load("press", {**pair, **parse(f"sim:press?set={key.name}:{value}").overrides})

    assert [entry.value for entry in robot.entries if entry.name == key.name] == [value]
