"""The files of the two robots with fingers, and what the user is told of one that is wrong."""

import re
import tomllib
from math import cos, pi, radians, sin

import pytest

from hil_sim.address import AddressError, parse
from hil_sim.assembly import assemble
from hil_sim.physics.hand.numbers import CONTACTS, MOTIONS, TIPS
from hil_sim.robots.file import FOLDER, PROFILES, RobotFileError, load
from hil_sim.robots.texts import CHOICES
from tests.robot_mistakes import refusal, told_of

ROBOTS = ("fingers", "fingers-experiment")
TEXT = (FOLDER / "fingers.toml").read_text(encoding="utf-8")
INWARD_DEG = {"fingers": 8.0, "fingers-experiment": 2.5}

# text to replace, its replacement, and the line and words that must be told
MISTAKES = [
    ("youngs_modulus_mpa = [0.30,", "youngs_modulus_kpa = [300,", "this number is kept as youngs_modulus_mpa"),
    ("length_mm = [51.0,", "length = [51.0,", "length has no unit: write length_mm"),
    ("stall_torque_n_m = [3.0,", "stall_torque_n_m = [-3.0,", "servos.stall_torque_n_m is -3, it must be at least"),
    ('tip = "nail"', 'tip = "nale"', "tip 'nale' is none of nail, radial"),
    ('tip = "nail"', "tip = 1", "tip 1 is none of nail, radial"),
    ('kind = "fingers"', 'kind = "hand"', "kind 'hand' is none of fingers"),
    ('contact = "frictionless"', 'contact = "stick"', "contact stick needs object.width_mm above 0: two tips on one"),
    ('motion = "quasi-static"', 'motion = "dynamic"', "motion dynamic needs object.mass_g above 0"),
    ('labels = ["R", "L"]', 'labels = ["R"]', 'labels: write them as ["R", "L"], the right finger first'),
    ('labels = ["R", "L"]', 'labels = ["R", "R"]', "labels: each joint needs its own"),
    ("L = 9 }", "L = 8 }", "pins: R and L share 8"),
    ("L = 9 }", "L = 11 }", "pins: L on pin 11, the board has servos on 8, 9, 10"),
    ("L = 9 }", "M = 9 }", "pins: one pin for each of R, L, as in R = 8"),
    ("[camera]", "[coils]", "unknown section [coils]: it belongs to a robot with coils"),
    ("supply_v =", "lead_ohm =", "unknown key lead_ohm: it belongs to a robot with coils"),
]


@pytest.mark.parametrize(("right", "wrong", "told"), MISTAKES)
def test_a_mistake_is_told_with_its_line(right, wrong, told, tmp_path):
    assert told in told_of(TEXT, right, wrong, tmp_path).splitlines()[0]


def test_its_sizes_are_in_si_units_and_its_joints_where_the_tips_touch():
    hand, robot = load("fingers-experiment").fingers, load("fingers")

    assert [hand.a, hand.E, hand.L, hand.m, hand.I_stall] == pytest.approx([0.013, 0.30e6, 0.105, 0.030, 2.5])
    assert [hand.w, hand.B] == pytest.approx([0.037, 0.013 + 0.037 / 2])
    assert (robot.joints, robot.labels, robot.wiring.pins) == (("R", "L"), (), {"R": 8, "L": 9})
    assert (robot.coil, robot.ring, robot.sphere, robot.ground) == (None, None, None, None)


@pytest.mark.parametrize("name", ROBOTS)
def test_its_derived_section_follows_from_its_numbers(name):
    hand, inward = load(name).fingers, radians(INWARD_DEG[name])
    s, c, depth = sin(inward), cos(inward), hand.L * sin(inward)
    torque = pi * hand.E * hand.L**3 / 3 * (3 * s**2 / c + 2 * s**4 / c**3)

    follows = {
        "spacing_mm": 2e3 * hand.B,
        "grip_depth_mm": 1e3 * depth,
        "grip_force_n": pi * hand.E * depth**2 / c**2,
        "grip_torque_n_m": torque,
        "grip_current_ma": 1e3 * (hand.I_idle + (hand.I_stall - hand.I_idle) * torque / hand.stall),
        "turn_ratio": -(depth + 3 * hand.e) / (3 * hand.a + 1.5 * hand.w - depth),
    }

    data = tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
    assert follows == pytest.approx({key: value for key, (value, _) in data["derived"].items()}, rel=1e-4)


def test_the_joints_move_apart_for_larger_tips_a_wider_object_and_an_offset():
    sizes = {"tips.radius_mm": "15", "object.width_mm": "10", "tips.offset_mm": "2", "links.gap_mm": "-1"}
    hand = load("fingers", sizes).fingers

    assert [hand.a, hand.B] == pytest.approx([0.015, 0.015 + 0.005 + 0.002 - 0.001])


def test_an_address_chooses_the_models_of_the_physics():
    address = parse("sim:fingers-experiment?tip=radial&contact=stick&motion=quasi-static&mu=0.2&gravity=0")

    hand = load(address.robot, address.overrides).fingers

    assert (hand.tip, hand.contact, hand.motion, hand.mu, hand.g) == ("radial", "stick", "quasi-static", 0.2, 0.0)
    ours = [words for name, words in CHOICES.items() if name.startswith("fingers.")]
    assert ours == [TIPS, CONTACTS, MOTIONS]


@pytest.mark.parametrize(
    ("robot", "overrides", "told"),
    [
        ("fingers", "contact=coulomb", "contact=coulomb needs object.width_mm above 0"),
        ("fingers", "motion=dynamic", "motion=dynamic needs object.width_mm or object.height_mm above 0"),
        ("fingers", "slope=10", "set=ground.slope_deg: no such number: it belongs to a robot with a shell"),
        ("circular", "tip=radial", "tip=radial: no such choice: it belongs to a robot with fingers"),
        ("sphere-a", "set=links.length_mm:9", "links.length_mm: no such number: it belongs to a robot with fingers"),
        ("fingers", "mu=-1", "object.friction_ratio is -1, it must be at least 0"),
        ("fingers", "set=links.lenth_mm:9", "did you mean links.length_mm?"),
    ],
)
def test_an_address_cannot_choose_what_the_robot_has_not(robot, overrides, told):
    assert told in refusal(robot, parse(f"sim:{robot}?{overrides}").overrides)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ("open=R", "open=R: fingers has no coils"),
        ("body=still", "body=still: fingers has no coils to heat while it does not move"),
        ("set=links.gap_mm:-20.5&set=object.width_mm:5", "built from these numbers: finger R: d = 20.5000 mm"),
    ],
)
def test_a_bench_that_cannot_be_is_refused_by_what_is_wrong(options, told):
    with pytest.raises(RobotFileError, match=re.escape(told)):
        assemble(parse(f"sim:fingers?{options}"))


def test_a_servo_on_another_pin_than_the_profile_says_is_told(tmp_path):
    (tmp_path / "mine.toml").write_text(TEXT.replace("R = 8, L = 9", "R = 8, L = 10"), encoding="utf-8")

    with pytest.raises(RobotFileError, match=r"mine and its profile .*fingers.json differ in labels, .*: L"):
        assemble(parse(f"sim:{tmp_path / 'mine.toml'}"))


def test_a_joint_that_is_read_at_another_input_than_it_is_wired_to_is_told(tmp_path):
    profile = (PROFILES / "fingers.json").read_text(encoding="utf-8")
    crossed = profile.replace('"current": 0, "position": 2', '"current": 2, "position": 0')
    (tmp_path / "mine.json").write_text(crossed, encoding="utf-8")
    text = TEXT.replace('profile = "fingers"', 'profile = "mine.json"')
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")

    with pytest.raises(RobotFileError, match=r"differ in labels, outputs or inputs: R$"):
        assemble(parse(f"sim:{tmp_path / 'mine.toml'}"))


def test_an_unknown_choice_is_told_the_known_ones():
    with pytest.raises(AddressError, match="no tip 'nale': known are nail, radial; did you mean nail"):
        parse("sim:fingers?tip=nale")
