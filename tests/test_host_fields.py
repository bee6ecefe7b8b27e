"""What an observer sees inside a body: taken at even times, kept in the recording and the log, and given back."""

import json
from math import inf

import numpy as np
import pytest
from mcap.reader import make_reader

from host.fields import Mesh, mesh_from, mesh_of, mesh_row, slice_from, slice_of, slice_row, strain, von_mises
from host.keeper import Keeper
from host.log import LogWriter
from host.logbook import read_log
from host.records import Event
from host.slicing import EVERY_MS, MOST, Rhythm, Slicing
from host.topics import TOPICS
from tests.pressed_block import PressedBlock, recorded_press
from tests.test_host_log import telemetry

SQUARE = Mesh(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]]), np.array([[0, 1, 2], [0, 2, 3]], np.int32))


def fields(shift_mm=0.25):
    """Return the fields of a square that is drawn out along x."""
    moved = SQUARE.points_mm * [shift_mm, 0.0]
    stress = np.array([[1.0, -2.0, 0.5, 0.25], [3.0, 4.0, 0.0, -1.0]])
    return {
        "points_mm": SQUARE.points_mm, "triangles": SQUARE.triangles, "displacement_mm": moved, "stress_kpa": stress,
        "von_mises_kpa": von_mises(stress), "strain": strain(SQUARE, moved),
    }  # fmt: skip


class Watcher:
    """An observer whose time goes on when it is told so, and that sees inside the body or not."""

    def __init__(self, sees=True, moves_s=inf, again_s=inf):
        self.t_s, self.sees, self.moves_s, self.again_s, self.asked = 0.0, sees, moves_s, again_s, 0

    def snapshot(self):
        return {"t_s": self.t_s, "coils": {}}

    def observe(self):
        return {"kind": "press"}

    def fields(self):
        self.asked += 1
        rests = self.moves_s < self.t_s < self.again_s
        return fields(self.moves_s if rests else self.t_s) if self.sees else None


def event(name, host_ms):
    return Event(host_ms, host_ms, name, 0, 0, None, 0)


def kept(watcher, log=None, until_ms=1000, begins_ms=120, drawn=True):
    """Return the recording of a program that began at `begins_ms`, with telemetry each 50 ms and a look each 5 ms."""
    keeper = Keeper(log, watcher, drawn=drawn)
    for host_ms in range(0, until_ms + 1, 5):
        watcher.t_s = host_ms / 1000
        if host_ms == begins_ms:
            keeper.record(event("started", host_ms))
        if host_ms % 50 == 0:
            keeper.record(telemetry(host_ms - 7))
        keeper.glance(host_ms)
    keeper.record(event("finished", until_ms + 3))
    watcher.t_s += 0.1
    keeper.record(event("disarmed", until_ms + 103))
    return keeper.recording


def test_slices_lie_at_even_times_from_the_start_of_the_program_and_at_its_end_and_that_of_the_run():
    recording = kept(Watcher())

    assert [taken.host_ms for taken in recording.slices] == [0, 120, 320, 520, 720, 920, 1003, 1103]
    assert recording.slices[2].t_s == 0.32
    assert recording.slices[2].displacement_mm.dtype == np.float32


def test_an_observer_that_sees_nothing_inside_is_asked_once():
    watcher = Watcher(sees=False)

    recording = kept(watcher)

    assert watcher.asked == 1
    assert (recording.mesh, recording.slices) == (None, [])


def test_a_body_that_keeps_its_shape_is_kept_at_the_ends_only():
    recording = kept(Watcher(moves_s=0.4))

    assert [taken.host_ms for taken in recording.slices] == [0, 120, 320, 520, 1003, 1103]


def test_the_end_of_a_rest_is_kept_so_that_the_nearest_slice_is_never_one_after_it():
    recording = kept(Watcher(moves_s=0.4, again_s=1.1), until_ms=1300)

    assert [taken.host_ms for taken in recording.slices] == [0, 120, 320, 520, 920, 1120, 1303, 1403]


def test_who_keeps_no_scenes_keeps_no_slices():
    watcher = Watcher()
    keeper = Keeper(None, watcher, scenes=False)

    keeper.record(event("started", 100))
    keeper.record(event("finished", 900))

    assert watcher.asked == 0


def test_what_no_picture_needs_is_in_the_log_and_not_in_memory(tmp_path):
    with LogWriter(tmp_path / "whole.mcap") as log:
        whole = kept(Watcher(), log)
    with LogWriter(tmp_path / "lean.mcap") as log:
        lean = kept(Watcher(), log, drawn=False)

    assert (lean.scenes, lean.slices) == ([], [])
    assert lean.telemetry == whole.telemetry
    assert read_log(tmp_path / "lean.mcap").rows == read_log(tmp_path / "whole.mcap").rows


def test_time_that_does_not_pass_for_the_body_gives_one_slice():
    watcher, taken = Watcher(), []
    slicing = Slicing(watcher, lambda mesh, each: taken.append(each))

    for host_ms in (0, 500, 900):
        slicing.take(host_ms)

    assert len(taken) == 1


def test_hours_give_few_slices():
    rhythm = Rhythm()

    due = [ms for ms in range(0, 3_600_000, 50) if rhythm.due(ms)]

    assert due[:MOST] == list(range(0, MOST * EVERY_MS, EVERY_MS))
    assert len(due) < 7 * MOST
    assert due[MOST + 1] - due[MOST] == 2 * EVERY_MS


def test_a_log_gives_back_the_mesh_and_every_slice(tmp_path):
    with LogWriter(tmp_path / "press.mcap") as log:
        written = kept(Watcher(), log)

    read = read_log(tmp_path / "press.mcap").recording()

    assert np.array_equal(read.mesh.points_mm, SQUARE.points_mm)
    assert np.array_equal(read.mesh.triangles, SQUARE.triangles)
    assert [each.t_s for each in read.slices] == [each.t_s for each in written.slices]
    for name in ("displacement_mm", "stress_kpa", "von_mises_kpa", "strain"):
        got, put = getattr(read.slices[3], name), getattr(written.slices[3], name)
        assert got.dtype == np.float32
        assert np.allclose(got, put, rtol=1e-6, atol=0.0), name


def test_other_programs_find_named_arrays_under_a_schema(tmp_path):
    with LogWriter(tmp_path / "press.mcap") as log:
        kept(Watcher(), log)

    with (tmp_path / "press.mcap").open("rb") as file:
        found = {channel.topic: (schema, message) for schema, channel, message in make_reader(file).iter_messages()}

    for topic in ("mesh", "fields"):
        schema, message = found[topic]
        assert set(json.loads(message.data)) == set(json.loads(schema.data)["properties"]) == set(TOPICS[topic])


def test_strain_and_von_mises_are_those_of_the_bench():
    block = PressedBlock()
    for _ in range(4):
        block.push(0.4)
    mesh, taken = mesh_of(block.fields()), slice_of(block.fields(), 0.2, 200)

    read = slice_from(slice_row(taken), mesh_from(mesh_row(mesh, 0)))

    assert np.abs(taken.strain).max() > 0.01
    assert np.abs(read.strain - taken.strain).max() < 1e-6  # single precision of 0.4 mm over cells of 5 mm
    assert np.abs(read.von_mises_kpa - taken.von_mises_kpa).max() < 1e-5 * taken.von_mises_kpa.max()


@pytest.mark.parametrize("broken", [{"stress_kpa": "AAAA"}, {"displacement_mm": "!"}, {"stress_kpa": ""}])
def test_a_damaged_row_ends_the_slices_and_hides_nothing_else(tmp_path, broken):
    taken = slice_of(fields(), 0.5, 500)
    with LogWriter(tmp_path / "press.mcap") as log:
        log.mesh(SQUARE, 0)
        log.slice(taken)
        log._add("fields", 700, {**slice_row(taken), **broken})

    recording = read_log(tmp_path / "press.mcap").recording()

    assert len(recording.slices) == 1


def test_a_log_of_a_press_of_ten_seconds_is_small(tmp_path):
    recording = recorded_press(columns=64, moves=((2.0, 4.0),))
    with LogWriter(tmp_path / "press.mcap") as log:
        log.mesh(recording.mesh, 0)
        for taken in recording.slices:
            log.slice(taken)

    bytes_each = (tmp_path / "press.mcap").stat().st_size / len(recording.slices)

    assert len(recording.mesh.triangles) == 4096
    assert bytes_each < 100_000  # so that ten seconds, 50 slices, take less than 5 MB
