"""Bodies at the edge of what a robot file may say: what they report is right, or the file is refused."""

import json
import signal

import pytest

from hil_sim import assembly
from hil_sim.bodies.sphere import SpherePlant
from hil_sim.robots.file import RobotFileError, load
from host.link import open_link


def test_hoops_too_coarse_to_have_strangers_have_no_gap():
    seen = SpherePlant(load("sphere-b", {"shell.nodes_count": "8"})).observe()

    assert seen["strip_gap_mm"] is None
    assert json.dumps(seen, allow_nan=False)


def test_a_body_that_comes_to_rest_below_the_plane_has_not_risen():
    seen = SpherePlant(load("sphere-b", {"ground.step_mm": "-1000", "ground.step_at_mm": "-1"})).observe()

    assert seen["apex_mm"] == 0.0


@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("circular", "hub.attach_mm"),
        ("circular", "hub.radius_mm"),
        ("sphere-a", "core.attach_mm"),
        ("sphere-b", "core.radius_mm"),
    ],
)
def test_what_is_inside_the_shell_is_smaller_than_the_shell(name, key):
    radius_mm = {"circular": 20, "sphere-a": 100, "sphere-b": 45}[name]

    with pytest.raises(RobotFileError, match=f"set={key}: {key} is {radius_mm}, it must be below shell.radius_mm"):
        load(name, {key: str(radius_mm)})


def test_an_interrupt_is_not_lost_when_the_bench_then_cannot_be_built(monkeypatch):
    def never_built(address):
        signal.raise_signal(signal.SIGINT)
        raise RobotFileError("numbers beyond the solver")

    monkeypatch.setattr(assembly, "assemble", never_built)

    with pytest.raises(KeyboardInterrupt):
        open_link("sim:circular")
