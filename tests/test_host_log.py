"""Logs: what is written is read back, also when the writer was killed or the file was cut off."""

import csv
import io
import json
import os
import signal
import subprocess
import sys

import pytest
from mcap.reader import make_reader

from host.errors import BadRequest
from host.log import LogWriter
from host.logbook import read_log
from host.profile import Parts
from host.records import Event, Stopped, Telemetry
from host.topics import TOPICS

LABELS = ("A", "B")
PARTS = Parts(LABELS, LABELS)
OF_OTHERS = {
    "joint_deg", "joint_mm", "commanded_deg", "commanded_mm", "joint_ma", "object_deg", "load_n", "cell_kpa",
}  # fmt: skip


def telemetry(now_ms: int) -> Telemetry:
    return Telemetry(now_ms + 7, now_ms, "running", 2, 1980, 120, 25.1, (600, 0), (61.5, 25.0))


def event(name: str, code: int = 0) -> Event:
    return Event(900, 893, name, code, 2, "A", 5)


def write(path, rows: int = 200):
    with LogWriter(path) as log:
        log.parts = PARTS
        log.attach("versions.json", json.dumps({"script": "a.gait", "address": "sim:circular"}).encode())
        log.line("out", b"\x01\x00", 5, None)
        for i in range(rows):
            log.record(telemetry(50 * i))
        log.record(event("started"))
        log.scene({"host_ms": 950, "t_s": 0.95, "nodes": [[0.0, 1.0]], "coils": {}, "observed": {"travel_mm": 1.5}})


@pytest.fixture
def path(tmp_path):
    write(tmp_path / "run.mcap")
    return tmp_path / "run.mcap"


def test_a_log_gives_back_what_was_written(path):
    log = read_log(path)
    recording = log.recording()

    assert log.complete
    assert recording.labels == LABELS
    assert recording.telemetry == [telemetry(50 * i) for i in range(200)]
    assert recording.events == [event("started")]
    assert recording.scenes[0]["observed"] == {"travel_mm": 1.5}
    assert recording.title == "a.gait on sim:circular"
    assert log.rows["bytes"][0] == {"host_ms": 5, "now_ms": None, "direction": "out", "data": "AQA="}


def test_other_programs_can_read_it_with_names_and_schemas(path):
    with path.open("rb") as file:
        schema, channel, message = next(iter(make_reader(file).iter_messages(topics=["telemetry"])))

    assert schema.encoding == "jsonschema"
    assert set(json.loads(schema.data)["properties"]) == set(TOPICS["telemetry"])
    assert set(json.loads(message.data)) == set(TOPICS["telemetry"]) - OF_OTHERS
    assert channel.message_encoding == "json"
    assert message.log_time == 7_000_000


@pytest.mark.parametrize("share", [0.05, 0.3, 0.5, 0.9, 0.999])
def test_a_log_that_was_cut_off_is_read_as_far_as_it_goes(path, share):
    whole = path.read_bytes()
    path.write_bytes(whole[: int(len(whole) * share)])

    log = read_log(path)

    assert not log.complete
    assert len(log.rows.get("telemetry", ())) <= 200


def test_a_log_without_its_end_has_lost_no_row_of_a_closed_chunk(tmp_path):
    log = LogWriter(tmp_path / "open.mcap")
    log.parts = PARTS
    for i in range(200):
        log.record(telemetry(50 * i))

    rows = read_log(tmp_path / "open.mcap").rows["telemetry"]

    assert len(rows) >= 180  # a chunk is closed once a second, here every 20 rows
    log.close()


@pytest.mark.parametrize("last", [event("tripped", 105), Stopped(900, 893, "tripped", 101, ("A",))])
def test_a_fault_is_on_the_disk_at_once(tmp_path, last):
    log = LogWriter(tmp_path / "open.mcap")
    log.parts = PARTS
    log.record(telemetry(0))
    log.record(last)

    rows = read_log(tmp_path / "open.mcap").rows

    assert len(rows["telemetry"]) == 1
    assert rows["events" if isinstance(last, Event) else "stops"][0]["code"] == last.code
    log.close()


def test_a_writer_that_is_killed_leaves_a_readable_log(tmp_path):
    script = (
        "import os, signal, sys\n"
        "from tests.test_host_log import PARTS, LogWriter, telemetry\n"
        "log = LogWriter(sys.argv[1]); log.parts = PARTS\n"
        "for i in range(2000): log.record(telemetry(50 * i))\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    done = subprocess.run([sys.executable, "-c", script, str(tmp_path / "killed.mcap")], cwd=os.getcwd(), check=False)

    rows = read_log(tmp_path / "killed.mcap").rows["telemetry"]

    assert done.returncode == -signal.SIGKILL
    assert len(rows) >= 1980


def test_flipped_bytes_end_the_reading_and_raise_nothing(path):
    whole = bytearray(path.read_bytes())
    for at in range(200, len(whole), 97):
        whole[at] ^= 0x55
    path.write_bytes(whole)

    assert not read_log(path).complete


def test_something_else_is_no_log(tmp_path):
    (tmp_path / "notes.txt").write_text("nothing of the kind")

    with pytest.raises(BadRequest, match="no log of softrig"):
        read_log(tmp_path / "notes.txt")
    with pytest.raises(BadRequest, match="cannot read"):
        read_log(tmp_path / "absent.mcap")


def test_a_log_that_cannot_be_written_is_refused(tmp_path):
    with pytest.raises(BadRequest, match="cannot write the log"):
        LogWriter(tmp_path / "no-folder" / "run.mcap")


def test_csv_has_a_column_for_each_coil(path):
    table = io.StringIO()

    count = read_log(path).write_csv(table, "telemetry")

    rows = list(csv.DictReader(table.getvalue().splitlines()))
    assert count == len(rows) == 200
    assert rows[3]["duty_permille.A"] == "600"
    assert rows[3]["temperature_degc.B"] == "25.0"


def test_csv_of_a_topic_that_is_not_there_names_those_that_are(path):
    with pytest.raises(BadRequest, match="has no stops: it holds bytes, events, scenes, telemetry"):
        read_log(path).write_csv(io.StringIO(), "stops")


def test_info_counts_rows_events_and_attachments(path):
    info = read_log(path).info()

    assert info["rows"] == {"bytes": 1, "events": 1, "scenes": 1, "telemetry": 200}
    assert info["events"] == {"started": 1}
    assert list(info["attachments"]) == ["versions.json"]
    assert info["duration_s"] == pytest.approx(9.952)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a full disk")
def test_a_full_disk_is_told_once_and_the_rest_goes_on_without_a_log():
    log = LogWriter("/dev/full")
    with pytest.raises(BadRequest, match="cannot write the log /dev/full: No space left on device"):
        log.attach("a", b"b")

    log.record(telemetry(0))
    log.line("out", b"\x01", 0, None)
    log.attach("a", b"b")
    log.close()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a full disk")
def test_a_full_disk_does_not_hide_what_ended_the_run():
    log = LogWriter("/dev/full")
    log.line("out", b"\x01", 0, None)

    log.__exit__(KeyError, KeyError("first"), None)  # the writing of the end fails and is not raised
