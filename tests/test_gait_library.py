"""The gaits that come with softrig: each is sound for its robot and does what its header says."""

import pytest
from click.testing import CliRunner

from host.cli import main as softrig
from host.gait.checker import check
from host.gait.compiler import compile_script
from host.gait.script import load
from protocol.program import disassemble
from protocol.verify import check_code
from tests.gait_scripts import ROOT, circular, profile_of

GAITS = sorted((ROOT / "gaits").glob("*.gait"))
BEGINNINGS = {
    "circular": "# The circular robot ", "sphere": "# The spherical robot ", "fingers": "# The soft fingers ",
    "press": "# The press ",
}  # fmt: skip


def made(name, *overrides):
    return compile_script(load(ROOT / "gaits" / f"{name}.gait"), circular(), overrides)


def fires(name, *overrides):
    """Return (time, coil, duty in permille) of each order of a gait, waits taken at no time."""
    at_ms, found = 0, []
    for _, op, *arguments in disassemble(made(name, *overrides).code):
        if op == "fire":
            found.append((at_ms, "ABCDEFGH"[arguments[0].bit_length() - 1], arguments[1]))
        at_ms += arguments[0] if op == "delay" else 0
    return found


@pytest.mark.parametrize("path", GAITS, ids=lambda path: path.stem)
def test_every_gait_is_sound_for_the_robot_it_names(path):
    script = load(path)
    profile = profile_of(script.robot_name())
    compiled = compile_script(script, profile)

    assert check(compiled).diagnostics == ()
    counts = len(profile.coil_labels), profile.program.bytes_max, len(profile.joint_labels), len(profile.cells)
    check_code(compiled.code, *counts)


@pytest.mark.parametrize("path", GAITS, ids=lambda path: path.stem)
def test_every_gait_says_what_it_does_below_its_first_line(path):
    lines = path.read_text(encoding="utf-8").splitlines()

    assert lines[0] == "gait 1"
    assert lines[1].startswith(BEGINNINGS[path.stem.split("-")[0]])


def test_the_crawl_holds_a_then_walks_once_around_the_ring():
    orders = fires("circular-crawl")

    assert [coil for _, coil, duty in orders if duty == 1000] == list("ABCDEFGHA")
    assert [at_ms for at_ms, _, duty in orders if duty == 1000] == [2000 * step for step in range(9)]
    assert [(at_ms % 2000, duty) for at_ms, _, duty in orders] == [(0, 1000), (700, 320)] * 9


def test_the_crawl_back_is_the_crawl_in_the_mirror():
    mirror = dict(zip("ABCDEFGH", "AHGFEDCB", strict=True))

    assert fires("circular-crawl-back") == [(at, mirror[coil], duty) for at, coil, duty in fires("circular-crawl")]


def test_the_crawl_takes_its_duty_hold_and_step_from_the_command_line():
    orders = fires("circular-crawl", "duty=90%", "hold=30%", "step=3s")

    assert [duty for *_, duty in orders] == [900, 300] * 9
    assert orders[-2][0] == 2000 + 7 * 3000


@pytest.mark.parametrize("override", ["duty=49%", "hold=46%", "step=1s", "boost=2s"])
def test_the_crawl_refuses_what_is_outside_its_ranges(override):
    with pytest.raises(Exception, match="E182"):
        made("circular-crawl", override)


@pytest.mark.parametrize(
    "overrides",
    [
        ["step=1.3s"],
        ["step=6s"],
        ["duty=100%", "boost=1s", "hold=45%", "step=1.3s"],
        ["hold=45%", "step=6s", "boost=1s"],
    ],
)
def test_the_crawl_is_sound_all_over_its_ranges(overrides):
    assert check(made("circular-crawl", *overrides)).sound


def test_the_poses_are_a_c_e_g_each_cooled_before_the_next():
    assert [coil for _, coil, duty in fires("circular-poses") if duty == 1000] == list("ACEG")

    code = disassemble(made("circular-poses").code)
    assert [row[2].mask for row in code if row[1] == "wait"] == [0b1, 0b100, 0b10000, 0b1000000]


def test_the_cool_down_fires_nothing_and_is_bounded():
    assert fires("circular-cooldown") == []
    assert check(made("circular-cooldown")).longest_ms == 60_010


@pytest.mark.parametrize("ball", ["a", "b"])
def test_the_crawl_of_a_sphere_turned_half_round_is_the_crawl_back(ball):
    profile = profile_of(f"sphere-{ball}")
    scripts = [load(ROOT / "gaits" / f"sphere-{ball}-{gait}.gait") for gait in ("crawl", "crawl-back")]

    turned = compile_script(scripts[0], profile, ["turned=180deg"])

    assert turned.code == compile_script(scripts[1], profile).code


@pytest.mark.parametrize("path", [path for path in GAITS if "-sweep" in path.stem], ids=lambda path: path.stem)
def test_a_sweep_is_sound_with_as_many_steps_as_fit_into_the_robot(path):
    script = load(path)

    assert check(compile_script(script, profile_of(script.robot_name()), ["steps=7"])).sound


def test_every_gait_is_written_in_the_one_form():
    files = [str(path) for path in sorted((ROOT / "gaits").rglob("*.gait"))]

    assert CliRunner().invoke(softrig, ["fmt", "--check", *files]).exit_code == 0
