"""The page of the wire protocol is enough to write a client: stranger.py was, and drives a robot here.

Its clock is the bench's, which goes on only while the stranger waits: a machine that is held up costs neither of them
anything.
"""

import ast
import json
import random
import struct
import sys
from collections import Counter
from contextlib import closing
from pathlib import Path
from zlib import crc32

import pytest

from hil_sim.link import open_link
from hil_sim.ports import Pty, SerialEnd
from protocol import codes, messages
from tests import stranger

ROOT = Path(__file__).parents[1]
FILE = json.loads((ROOT / "docs" / "vectors.json").read_text(encoding="utf-8"))
SMALL = [vector for vector in FILE["frames"] if vector["flags"] <= stranger.RELIABLE]
GREAT = [vector for vector in FILE["frames"] if vector["flags"] > stranger.RELIABLE]
TURN_S = 0.01
EVENTS = {name: number for number, name in enumerate(messages.EVENTS)}
FIRE = {"coils": 0b10, "duty_permille": 300, "hold_ms": 200}  # coil B


class OnBench(stranger.Stranger):
    """The stranger at the terminal of a bench, with a line that loses frames when it is told to."""

    def __init__(self, bench, pty):
        self.bench, self.pty, self.end = bench, pty, SerialEnd(bench, [pty])
        self.losing, self.loss, self.chance = Counter(), 0.0, random.Random(1)
        self.heated_s = Counter()
        super().__init__(pty.path, lambda: bench.clock.now_us / 1e6)

    def turn(self):
        self.end.exchange()
        self.bench.run(TURN_S)
        self.end.exchange()
        self.heated_s.update({coil.label: TURN_S for coil in self.bench.coils if self.bench.coil(coil.label).duty})
        super().turn()

    def write(self, data):
        if not self.is_lost("sent"):
            super().write(data)

    def hear(self, *frame):
        if not self.is_lost("heard"):
            super().hear(*frame)

    def is_lost(self, way):
        self.losing[way] -= 1
        return self.losing[way] >= 0 or self.chance.random() < self.loss

    def arm(self):
        self.order("arm", session=self.session, lease_ms=5000, without=0)
        self.heated_s.clear()

    def pass_s(self, seconds):
        until_s = self.now_s() + seconds
        while self.now_s() < until_s:
            self.turn()


@pytest.fixture
def closed():
    link = open_link("sim:circular?body=still")
    with Pty() as pty, closing(OnBench(link.bench, pty)) as robot:
        yield robot


@pytest.fixture
def robot(closed):
    closed.open()
    return closed


@pytest.fixture
def fingers():
    yield from at_a_bench("sim:fingers")


@pytest.fixture
def press():
    yield from at_a_bench("sim:press")


def at_a_bench(address):
    link = open_link(address)
    with Pty() as pty, closing(OnBench(link.bench, pty)) as robot:
        robot.open()
        yield robot


@pytest.fixture
def frames():
    frames = stranger.Frames()
    frames.learn(FILE["dictionary_crc"], FILE["session"])
    return frames


@pytest.fixture(scope="module")
def words():
    return stranger.Words((ROOT / "protocol" / "dictionary.txt").read_text(encoding="ascii"))


def test_a_stranger_learns_labels_and_limits_from_the_robot(robot):
    assert [channel["label"] for channel in robot.limits["channels"]] == list("ABCDEFGH")
    assert robot.limits["session"]["lease_ms"] == 500
    assert robot.identity["firmware"]


def test_a_session_begins_on_a_line_that_loses_every_fifth_frame(closed):
    closed.loss = 1 / 5
    closed.open()

    assert closed.order("status_request")["state"] == 1


def test_a_viewer_learns_that_it_may_give_no_orders(robot):
    robot.arm()

    with closing(OnBench(robot.bench, robot.pty)) as viewer, pytest.raises(PermissionError):
        viewer.open()


def test_a_coil_is_on_for_as_long_as_the_stranger_ordered(robot):
    robot.arm()
    robot.order("fire", **FIRE)
    robot.pass_s(0.3)

    assert robot.heated_s == {"B": pytest.approx(0.2, abs=2 * TURN_S)}
    assert robot.order("status_request")["state"] == 2


@pytest.mark.parametrize(("way", "count"), [("sent", 1), ("sent", 2), ("heard", 1), ("heard", 2)])
def test_an_order_is_carried_out_once_when_it_or_its_answer_is_lost(robot, way, count):
    robot.arm()
    robot.losing[way] = count
    robot.order("fire", **FIRE)
    robot.pass_s(0.6)

    assert robot.losing[way] < 0
    assert robot.heated_s["B"] == pytest.approx(0.2, abs=2 * TURN_S)


def test_a_stranger_that_falls_silent_is_disarmed(robot):
    robot.order("arm", session=robot.session, lease_ms=500, without=0)
    robot.bench.run(0.6)

    assert robot.wait("event", event=EVENTS["disarmed"])["code"] == codes.LEASE_EXPIRED


def test_a_refusal_has_a_code_and_the_limit(robot):
    robot.arm()
    with pytest.raises(stranger.Refused) as refusal:
        robot.order("fire", **{**FIRE, "hold_ms": 60_000})

    (answer,) = refusal.value.args
    assert (answer["code"], answer["value"], answer["limit"]) == (codes.HOLD_LIMIT, 60_000, 10_000)


def test_records_of_telemetry_come_at_their_period(robot):
    names = ["state", "supply_mv", "coil_decidegc"]
    robot.subscribe(0, 50, names)
    first, second = robot.wait("telemetry", slot=0), robot.wait("telemetry", slot=0)
    record = robot.words.unpack_record(second["values"], names, robot.limits)

    assert (second["count"], second["now_ms"] - first["now_ms"]) == (first["count"] + 1, 50)
    assert record["state"] == 1
    assert record["supply_mv"] == pytest.approx(2000, abs=20)
    assert record["coil_decidegc"] == pytest.approx([250] * 8, abs=20)


def test_joints_move_hold_and_tell_of_themselves_and_of_the_object(fingers):
    names = ["joint_centi", "commanded_centi", "coil_decidegc", "object_centideg", "state"]
    fingers.subscribe(0, 50, names)
    fingers.arm()
    fingers.order("move", joints=0b01, target_centi=300, over_ms=200, hold_ms=1000)
    fingers.order("move", joints=0b10, target_centi=-300, over_ms=200, hold_ms=1000)
    fingers.pass_s(0.6)

    values = [values for name, values in fingers.heard if name == "telemetry"][-1]["values"]
    record = fingers.words.unpack_record(values, names, fingers.limits)

    assert record["joint_centi"] == pytest.approx([300, -300], abs=40)
    assert record["commanded_centi"] == [300, -300]
    assert (record["coil_decidegc"], record["state"]) == ([], 2)
    assert record["object_centideg"] == pytest.approx([0], abs=20)


def test_a_press_presses_and_tells_what_it_and_the_block_feel(press):
    names = ["load_mn", "cell_pa", "joint_centi", "coil_decidegc", "object_centideg"]
    press.subscribe(0, 50, names)
    press.arm()
    press.order("press", target_mn=2000, over_ms=1000, time_ms=4000, hold_ms=1000)
    press.pass_s(3.5)

    values = [values for name, values in press.heard if name == "telemetry"][-1]["values"]
    record = press.words.unpack_record(values, names, press.limits)

    assert record["load_mn"] == pytest.approx([2000], abs=100)
    assert len(record["cell_pa"]) == 6
    assert max(record["cell_pa"]) > 500  # 2 N on a strip 40 mm thick and some 20 mm wide
    assert record["joint_centi"][0] > 20
    assert (record["coil_decidegc"], record["object_centideg"]) == ([], [])


def test_a_program_runs_to_its_end(robot):
    robot.arm()
    robot.upload(stranger.fire(1, 300, 200) + stranger.delay(300) + stranger.fire(2, 300, 100) + stranger.HALT)
    robot.order("start", at_ms=0, paused=0)
    events = [robot.wait("event") for _ in range(3)]

    assert [event["event"] for event in events] == [EVENTS[name] for name in ("accepted", "started", "finished")]
    assert events[2]["now_ms"] - events[1]["now_ms"] == pytest.approx(400, abs=5)  # a control step
    assert robot.heated_s == {
        label: pytest.approx(seconds, abs=2 * TURN_S) for label, seconds in (("A", 0.2), ("B", 0.1))
    }


def test_a_program_is_streamed_as_its_page_says(robot):
    turn, sent = stranger.fire(1, 300, 100) + stranger.delay(200), 0
    robot.arm()
    robot.order("program", header=struct.pack("<2sBBIII", b"SG", 2, 2, crc32(robot.profile), 0, 0))
    for piece in (2 * turn, 2 * turn, turn + stranger.HALT):
        robot.order("code", offset=sent, code=piece)
        if not sent:
            robot.order("start", at_ms=0, paused=0)
        sent += len(piece)
    events = [robot.wait("event") for _ in range(3)]

    assert [event["event"] for event in events] == [EVENTS[name] for name in ("accepted", "started", "finished")]
    assert events[2]["now_ms"] - events[1]["now_ms"] == pytest.approx(1000, abs=5)  # a control step


def test_events_that_the_robot_tells_again_are_heard_once(robot):
    robot.arm()
    robot.upload(stranger.fire(1, 300, 100) + stranger.HALT)
    robot.order("start", at_ms=0, paused=0)
    robot.losing["sent"] = 10  # all that would acknowledge them
    robot.pass_s(1.5)

    events = [values["event"] for name, values in robot.heard if name == "event"]
    assert robot.losing["sent"] < 0
    assert events == [EVENTS[name] for name in ("accepted", "started", "finished")]


def test_a_stop_switches_off_and_clear_leads_back(robot):
    robot.arm()
    robot.order("fire", **{**FIRE, "hold_ms": 5000})
    stopped = robot.stop()
    with pytest.raises(stranger.Refused):
        robot.order("fire", **FIRE)
    robot.order("clear")

    assert (stopped["state"], stopped["code"], stopped["coils"]) == (4, codes.STOP, 0b10)
    assert robot.wait("event", event=EVENTS["tripped"])["code"] == codes.STOP
    assert robot.order("status_request")["state"] == 1


@pytest.mark.parametrize("vector", FILE["messages"], ids=lambda vector: vector["message"])
def test_a_stranger_packs_and_unpacks_every_payload(words, vector):
    name, payload = vector["message"], bytes.fromhex(vector["payload"])
    values = {key: bytes.fromhex(value) if isinstance(value, str) else value for key, value in vector["values"].items()}

    assert words.kinds[name] == vector["kind"]
    assert words.pack(name, values) == payload
    assert words.unpack(name, payload) == values


@pytest.mark.parametrize("vector", SMALL, ids=lambda vector: vector["message"])
def test_a_stranger_makes_and_reads_frames_byte_for_byte(frames, vector):
    head = [vector[name] for name in ("flags", "kind", "seq", "ack")]
    flags, kind, seq, ack = head
    payload, wire = bytes.fromhex(vector["payload"]), bytes.fromhex(vector["wire"])

    assert frames.make(kind, payload, flags, seq, ack) == wire
    assert frames.feed(wire) == [(*head, payload)]


@pytest.mark.parametrize("vector", GREAT, ids=lambda vector: vector["message"])
def test_frames_with_a_node_or_a_tag_are_not_for_a_small_client(frames, vector):
    assert frames.feed(bytes.fromhex(vector["wire"])) == []


@pytest.mark.parametrize("vector", FILE["refused"], ids=lambda vector: vector["why"])
def test_a_stranger_drops_what_must_be_refused(frames, vector):
    assert frames.feed(bytes.fromhex(vector["wire"])) == []


@pytest.mark.parametrize("vector", FILE["streams"], ids=lambda vector: vector["why"])
@pytest.mark.parametrize("piece", [1, 7, 10_000])
def test_a_stranger_finds_the_frames_of_a_stream(frames, words, vector, piece):
    wire, found = bytes.fromhex(vector["wire"]), []
    for at in range(0, len(wire), piece):
        found += frames.feed(wire[at : at + piece])

    assert [words.names[kind] for _, kind, *_ in found] == vector["kinds"]


def test_a_stranger_imports_nothing_of_the_project():
    tree = ast.parse(Path(stranger.__file__).read_text(encoding="utf-8"))
    imported = [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
    imported += [node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]

    assert {name.partition(".")[0] for name in imported} <= sys.stdlib_module_names
