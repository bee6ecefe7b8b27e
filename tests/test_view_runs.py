"""Pictures of runs on the bench itself: what they choose to show of a crawl and of the poses."""

from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from host.cli import main as softrig
from host.gait.compiler import compile_script
from host.gait.script import load
from host.keeper import Keeper
from host.link import open_link
from host.recording import Recording
from host.robot import Robot
from host.run import run
from host.view import draw_run
from host.view.body import on_paper, spring
from host.view.instants import NEAR, apart, fastest, nearby, path_mm, resting
from host.view.poses import coil_length_mm, shortest

GAITS = Path(__file__).parents[1] / "gaits"


@cache
def recorded(gait: str, address: str = "sim:circular") -> Recording:
    """Return the recording of a gait on the bench."""
    link = open_link(address)
    keeper = Keeper(observer=link.observer)
    with Robot(link, keeper) as robot:
        robot.connect()
        keeper.know(robot.profile.parts)
        run(robot, compile_script(load(str(GAITS / gait)), robot.profile, ()).program, lambda stage, done: None)
    return keeper.recording


@pytest.fixture
def crawl():
    return recorded("circular-crawl.gait")


def test_the_strip_begins_at_the_start_ends_at_the_end_and_shows_every_rest(crawl):
    chosen = resting(crawl)

    assert chosen[0] == 0
    assert chosen[-1] == len(crawl.scenes) - 1
    assert len(chosen) >= 10  # the start, nine pushes, the end; two of them may fall together


def test_bodies_that_are_drawn_whole_do_not_overlap(crawl):
    whole = apart(crawl, resting(crawl), 40.0)

    hubs = [crawl.scenes[i]["hub"][0] for i in whole]
    assert len(whole) >= 3
    assert min(np.diff(hubs)) >= 40.0


def test_the_frames_show_one_roll_from_begin_to_end(crawl):
    frames = fastest(crawl, 5)
    path = path_mm(crawl.scenes)

    assert frames == sorted(set(frames))
    assert path[frames[-1]] - path[frames[0]] > 10


@pytest.mark.parametrize("label", "ACEG")
def test_a_pose_shows_its_coil_at_its_shortest_and_hot(label):
    scene = shortest(recorded("circular-poses.gait"), label)

    lengths = {other: coil_length_mm(scene, other) for other in scene["coils"]}
    assert min(lengths, key=lengths.get) == label
    assert lengths[label] < 0.75 * 20
    assert scene["coils"][label]["degc"] > 70


def test_a_slope_stands_upright_on_paper():
    uphill = on_paper([[10.0, 0.0]], 30.0)

    assert uphill[0] == pytest.approx([8.660, 5.0], abs=1e-3)


def test_a_drawn_coil_begins_and_ends_where_the_coil_does():
    start, end = np.array([0.0, 0.0]), np.array([3.0, 4.0])

    zigzag = spring(start, end)

    assert zigzag[0] == pytest.approx(start)
    assert zigzag[-1] == pytest.approx(end)


def test_a_crawl_is_drawn_from_its_scenes_and_is_the_same_file_each_time(crawl, tmp_path):
    draw_run(crawl, tmp_path / "a.svg")
    draw_run(crawl, tmp_path / "b.svg")

    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    assert ElementTree.parse(tmp_path / "a.svg").getroot().tag.endswith("svg")


@pytest.mark.parametrize("gait", ["circular-poses.gait", "fingers-figure13.gait"])
def test_a_log_gives_the_picture_of_its_run(gait, tmp_path):
    script, log, live, later = (
        str(GAITS / gait),
        *(str(tmp_path / name) for name in ("a.mcap", "a.svg", "b.svg")),
    )
    softrig(["run", script, "--log", log, "--plot", live], standalone_mode=False)

    softrig(["log", "plot", log, "-o", later], standalone_mode=False)

    assert Path(later).read_bytes() == Path(live).read_bytes()


def test_a_ring_that_rolls_off_is_drawn_while_it_is_near(tmp_path):
    downhill = recorded("circular-crawl.gait", "sim:circular?slope=25")

    near = nearby(downhill)

    assert downhill.scenes[-1]["hub"][0] < -1000
    assert near.scenes[0] is downhill.scenes[0]
    assert near.scenes[-1]["hub"][0] > -NEAR * 41
    assert len(near.telemetry) == len(downhill.telemetry)
