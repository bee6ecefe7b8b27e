"""Which numbers a robot file needs follows from its kind of shell and of power; what the user is told otherwise."""

import pytest

from hil_sim.robots.file import FOLDER, RobotFileError, load

FILES = {name: (FOLDER / f"{name}.toml").read_text(encoding="utf-8") for name in ("circular", "sphere-a", "sphere-b")}

# file, text to replace, its replacement, and the words that must be told
MISTAKES = [
    ("circular", "[hub]\nmass_g", "[hub]\nstrip_width_mm = [1, 'assumed']\nmass_g", "unknown key strip_width_mm"),
    ("sphere-b", '"A100", ', '"A1O0", ', "labels: A1O0: not a letter and three of 1, 0, m1, as in A10m1"),
    ("sphere-b", '"A0m1m1",', '"Am1m1m1",', "labels: Am1m1m1: no point of a hoop"),
    ("sphere-b", '"B0m1m1"]', '"B10m1"]', "labels: each coil needs its own"),
    ("sphere-b", '"B0m1m1"]', '"C10m1"]', "jump_labels: coils run from each point to the next"),
    ("sphere-b", '["B10m1", "B01m1", "Bm10m1", "B0m1m1"]', '"B10m1"', 'jump_labels: write them as ["A", "B", ...]'),
    ("circular", "turns_count", 'jump_labels = ["X"]\nturns_count', "jump_labels: only a sphere has coils between"),
    ("sphere-b", "nodes_count = [24,", "nodes_count = [28,", "at least 8 and at most 128 and a multiple of 8"),
    ("circular", "nodes_count = [32,", "nodes_count = [32.5,", "at least 16 and at most 256 and a whole number"),
    ("sphere-b", "edgewise_ratio", "edgwise_ratio", "unknown key edgwise_ratio; did you mean edgewise_ratio?"),
    ("sphere-b", "[core]", "[cor]", "unknown section [cor]; did you mean core?"),
    ("sphere-b", "A100 = [96, 0]", "A100 = [96, 1]", "outputs: Am100 and A100 share [96, 1]"),
    ("sphere-a", "charge_percent = [25.0,", "charge_percent = [101.0,", "battery.charge_percent is 101, it must be at"),
    ("sphere-a", "capacity_mah", "capacity", "capacity has no unit: write capacity_mah"),
    ("sphere-a", "roughness_length_mm = [25.0,", "roughness_length_mm = [0.0,", "roughness_length_mm is 0, it must be"),
]


def mistakes(name, tmp_path, *changes):
    """Return what is told of a robot's file with such changes, without the path before each line."""
    text = FILES[name]
    for right, wrong in changes:
        assert right in text
        text = text.replace(right, wrong, 1)
    file = tmp_path / "mine.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(RobotFileError) as caught:
        load(str(file))
    return [line.removeprefix(f"{file}:") for line in str(caught.value).splitlines()]


@pytest.mark.parametrize(("name", "right", "wrong", "told"), MISTAKES)
def test_a_mistake_is_told_once(name, right, wrong, told, tmp_path):
    found = [line for line in mistakes(name, tmp_path, (right, wrong)) if "outputs: one" not in line]

    assert len(found) == 1
    assert told in found[0]


def test_a_label_that_is_no_direction_is_told_at_the_line_of_the_labels(tmp_path):
    line = FILES["sphere-a"].splitlines().index("labels = [") + 1

    found = mistakes("sphere-a", tmp_path, ('"A011"', '"A012"'), ("A011 = ", "A012 = "))

    assert [told.partition(":")[0] for told in found] == [str(line)]


def test_an_output_is_told_at_the_line_of_the_outputs(tmp_path):
    line = FILES["sphere-a"].splitlines().index("[wiring.outputs]") + 1

    assert mistakes("sphere-a", tmp_path, ("= [97, 1]", "= [97, 16]"))[0].startswith(f"{line}: outputs: A0m1m1")


def test_a_ring_in_a_file_of_a_sphere_is_told_what_a_sphere_needs(tmp_path):
    told = "\n".join(mistakes("circular", tmp_path, ('kind = "ring"', 'kind = "sphere"')))

    assert "unknown section [hub]: it belongs to a robot with a ring" in told
    assert "[shell] lacks strip_width_mm: add strip_width_mm = [value" in told
    assert "labels: A: not a letter and three of 1, 0, m1" in told
    assert "turn_deg: it belongs to a robot with a ring" in told


def test_an_unknown_kind_is_the_only_mistake_of_a_file_that_is_otherwise_a_sphere(tmp_path):
    found = mistakes("sphere-b", tmp_path, ('kind = "sphere"', 'kind = "ball"'))

    assert len(found) == 1
    assert "kind 'ball' is none of ring, sphere" in found[0]


def test_a_file_has_a_bench_supply_or_a_battery_and_not_both(tmp_path):
    both = mistakes("sphere-a", tmp_path, ("source_ohm", 'supply_v = [7.2, "assumed"]\nsource_ohm'))
    none = mistakes("sphere-b", tmp_path, ("\nsupply_v", "\n# supply_v"))

    assert both[0].endswith("unknown key supply_v: it belongs to a robot with a bench supply")
    assert "[wiring] lacks supply_v" in none[0]


@pytest.mark.parametrize(
    ("robot", "key", "told"),
    [
        ("sphere-b", "hub.mass_g", "it belongs to a robot with a ring"),
        ("sphere-a", "wiring.supply_v", "it belongs to a robot with a bench supply"),
        ("circular", "battery.charge_percent", "it belongs to a robot with a battery"),
        ("sphere-b", "core.mas_g", "did you mean core.mass_g?"),
    ],
)
def test_an_address_cannot_set_what_the_robot_has_not(robot, key, told):
    with pytest.raises(RobotFileError, match="no such number") as caught:
        load(robot, {key: "1"})

    assert told in str(caught.value)


def test_all_mistakes_of_a_sphere_are_told_at_once(tmp_path):
    changes = (('"A100", ', '"A900", '), ("nodes_count = [24", "nodes_count = [25"), ("attach_mm", "attatch_mm"))

    assert len(mistakes("sphere-b", tmp_path, *changes)) == 4  # A900 is no direction and has no output
