"""A robot on a CAN bus: the whole firmware, its controller, the wire, and the host's own line at the other end."""

import json

import can
import pytest

from hil_sim.devices.canframe import Frame
from hil_sim.devices.canstation import CanStation
from hil_sim.link import open_link as open_serial
from host.canaddress import parse
from host.canbus import CanBus
from host.canlink import CanLink
from host.errors import LinkLost, Silent
from host.records import Sample, Telemetry
from host.robot import Robot
from protocol import frames, messages, program
from protocol.canbus import ALL, GAP_MS, HOST, WAKE_MS, Assembler, Segmenter, identifier
from protocol.link import Link
from tests.can_robots import opened

STILL = "can:softrig:circular?body=still"
STEP_US = 5_000
PWM_US = 700  # until the chip follows


@pytest.fixture
def bus():
    """A bus with one robot, number 1."""
    with opened(f"{STILL}@1") as bus:
        yield bus


@pytest.fixture
def robot(bus):
    """That robot, connected."""
    robot = Robot(CanLink(bus, 1))
    robot.connect()
    return robot


@pytest.fixture
def bench(bus):
    """That robot as the bench has it."""
    return bus.observers[1]


def beside(bench) -> CanStation:
    """Return a stranger on the robot's bus."""
    return CanStation(bench.board.can_wire, 500_000)


def test_a_robot_is_armed_and_fired_and_tells_its_telemetry_over_can(robot, bench):
    robot.arm()
    robot.fire(["A"], 500, 300)
    list(robot.listen(500))

    on = [duty for _, duty in bench.coil("A").history if duty]
    assert on[-1] == 0.5
    assert bench.coil_gate("A") == 0.0
    assert robot.statistics()["frames_resent"] == 0
    assert bench.crashes == []


def test_an_order_is_answered_within_two_control_steps(robot):
    times = []
    for _ in range(20):
        began_s = robot.link.now_s()
        robot.status()
        times.append(robot.link.now_s() - began_s)

    assert max(times) < 0.0125


@pytest.mark.parametrize("at_us", range(0, STEP_US, 700))
def test_a_stop_from_anybody_acts_within_one_control_step(robot, bench, at_us):
    """Wherever the robot is in its step."""
    stranger = beside(bench)
    robot.arm()
    robot.fire(["A"], 500, 2000)
    bench.clock.run_until(bench.clock.now_us // STEP_US * STEP_US + 20 * STEP_US + at_us)
    assert bench.coil_gate("A") > 0

    stranger.send(Frame(0, b"STOP"))
    bench.clock.run_until(bench.clock.now_us + STEP_US + 1_500)

    assert bench.coil_gate("A") == 0.0
    assert not bench.board.powered


def test_a_stop_finds_room_while_others_flood_the_robot(robot, bench):
    """Its receive buffer is its own: segments as quick as the wire carries them cannot take its place."""
    stranger = beside(bench)
    robot.arm()
    robot.fire(["A"], 500, 2000)
    for _ in range(400):
        stranger.send(Frame(identifier(0x20, 1, 9, False), bytes(8), extended=True))
    bench.clock.run_until(bench.clock.now_us + 40_000)
    assert bench.coil_gate("A") > 0

    stranger.waiting.insert(1, Frame(0, b"STOP"))
    bench.clock.run_until(bench.clock.now_us + STEP_US + 1_500)

    assert bench.coil_gate("A") == 0.0


def test_a_stop_by_can_ends_what_the_serial_line_has_ordered():
    link = open_serial("sim:circular?body=still&node=1")
    robot = Robot(link)
    robot.connect()
    robot.arm()
    robot.fire(["A"], 500, 2000)
    stranger = beside(link.bench)

    stranger.send(Frame(0, b"STOP"))
    list(robot.listen(50))

    assert link.bench.coil_gate("A") == 0.0
    assert robot.status().state == "tripped"
    answer = Assembler(True)
    bodies = [answer.feed(frame.id, frame.extended, frame.data, 0) for frame in stranger.received]
    assert [(body.robot, body.host) for body in bodies if body and body.kind == messages.STOPPED.number] == [(1, ALL)]
    robot.link.close()


def test_a_stop_by_the_serial_line_ends_what_can_has_ordered(robot, bench):
    robot.arm()
    robot.fire(["A"], 500, 2000)

    bench.board.host_write(frames.STOP)
    list(robot.listen(30))

    assert bench.coil_gate("A") == 0.0
    assert bench.board.uart.host_read(bench.clock.now_us)


def test_noise_on_the_serial_line_costs_can_nothing(robot, bench):
    """Nothing of it ends in a zero, so what comes by CAN would be taken for the rest of a frame."""
    robot.arm()
    robot.fire(["A"], 500, 2000)

    for _ in range(20):
        bench.board.host_write(b"\xa5" * 8)
        list(robot.listen(20))
        robot.status()

    assert bench.coil_gate("A") > 0
    assert robot.statistics()["frames_resent"] == 0


def test_another_host_on_the_serial_line_is_answered_and_may_only_watch(robot, bench):
    robot.arm()
    other = Link()
    hello = messages.HELLO.pack(version=frames.VERSION, session=4242, attach=0, nonce_a=1, nonce_b=2)
    other.post(messages.HELLO.number, hello)

    bench.board.host_write(other.poll(0))
    list(robot.listen(50))
    received = other.receive(bench.board.uart.host_read(bench.clock.now_us), 0)

    identity = messages.IDENTITY.unpack(received[-1].payload)
    assert identity.role == messages.VIEWER
    assert robot.status().state == "armed"


def test_a_stranger_hears_beacons_of_state_and_coils(robot, bench):
    stranger = beside(bench)
    robot.arm()
    robot.fire(["A", "D"], 300, 2000)
    list(robot.listen(300))

    told = [(frame.id >> 18 & 255, frame.data) for frame in stranger.received if frame.extended]
    state = messages.BEACON.unpack([data for kind, data in told if kind == messages.BEACON.number][-1])
    coils = [messages.BEACON_COILS.unpack(data) for kind, data in told if kind == messages.BEACON_COILS.number]
    assert (state.state, state.code) == (messages.ARMED, 0)
    assert 1980 <= state.supply_mv <= 2000
    assert state.current_ma > 50
    assert [each.group for each in coils[-4:]].count(1) == 1
    assert {(each.group, each.duty_a_percent, each.duty_b_percent) for each in coils[-4:]} == {
        (0, 30, 0), (1, 0, 30), (2, 0, 0), (3, 0, 0),
    }  # fmt: skip
    assert coils[-4:][0].temperature_a_decidegc > 200


def test_a_robot_that_nobody_hears_tries_one_frame_a_second(bench):
    link = open_serial("sim:circular?body=still&node=1")
    began = []
    chip = link.bench.board.can.can
    chip.began, real = lambda: (began.append(link.bench.clock.now_us), real())[1], chip.began

    link.bench.run(5)
    link.close()

    assert 4 <= len(began) <= 6
    assert chip.errors.transmit < 60


def test_a_robot_that_slept_hears_the_first_greeting(bench, bus):
    bench.run(5)
    link = CanLink(bus, 1)
    began_s = link.now_s()

    Robot(link).connect()

    assert link.now_s() - began_s < 0.9
    assert bus._lanes.lane(1)._gap_s == GAP_MS / 1000


def test_segments_that_come_too_close_are_sent_again_and_kept_apart(robot, bus, monkeypatch):
    """A host that does not keep its distance loses frames, and its session repairs that."""
    monkeypatch.setattr("host.canlane.GAP_S", 0.0)
    monkeypatch.setattr("host.canlane.SPARE", 0)
    lane = bus._lanes.lane(1)
    lane._gap_s = 0.0002

    code = bytes(600)
    robot.upload(program.header(code, robot.profile.crc), code)

    assert robot.statistics()["frames_resent"] > 0
    assert lane._gap_s > 0.0002


def test_no_segment_is_lost_to_a_control_step_that_measures_coils(robot):
    """A slot of the patrol makes a step three milliseconds long, and a segment comes every millisecond."""
    robot.arm()
    robot.fire(["A", "C"], 500, 2000)
    code = bytes(4000)

    robot.upload(program.header(code, robot.profile.crc), code)

    assert robot.statistics()["frames_resent"] == 0


def test_a_robot_survives_its_controller(robot, bench):
    bench.board.can.alive = False
    with pytest.raises(LinkLost):
        robot.status()
    assert bench.world.resets == 0

    bench.board.can.alive = True
    bench.run(3)
    again = Robot(CanLink(robot.link.bus, 1))
    again.connect()

    assert again.status().state == "idle"


def test_a_robot_comes_back_from_bus_off(robot, bench):
    bench.board.can_wire.spoil(40)
    list(robot.listen(500))

    assert robot.status().state == "idle"
    assert bench.world.resets == 0


def test_two_hosts_at_one_robot_get_their_own_answers(robot, bench):
    stranger, segmenter, assembler = beside(bench), Segmenter(1, 7, False), Assembler(True)
    other = Link()
    hello = messages.HELLO.pack(version=frames.VERSION, session=4242, attach=0, nonce_a=1, nonce_b=2)
    other.post(messages.HELLO.number, hello)
    robot.arm()

    for number, frame in enumerate(segmenter.feed(other.poll(0))):
        later_us = bench.clock.now_us + 1000 * (WAKE_MS + 2 * number)
        bench.clock.at(later_us, lambda frame=frame: stranger.send(Frame(frame.identifier, frame.data, True)))
    list(robot.listen(100))
    bodies = [assembler.feed(frame.id, frame.extended, frame.data, 0) for frame in stranger.received]

    to_us = [body.kind for body in bodies if body and body.host == 7]
    assert to_us == [messages.IDENTITY.number]
    assert HOST in {body.host for body in bodies if body}
    assert robot.status().state == "armed"


def test_another_host_on_the_bus_may_not_order_and_sees_the_telemetry_of_the_first(robot, bus):
    robot.arm(lease_ms=5000)
    robot.subscribe(20)
    theirs = CanBus(can.Bus(interface="softrig", desk=bus._bus.desk), parse("can:softrig:circular@1?host=2"))
    other = Robot(CanLink(theirs, 1))
    other.connect(watch_only=True)

    told = [record for record in other.listen(500) if isinstance(record, Telemetry)]
    other.link.close()

    assert other.talk.session.viewer
    assert len(told) in range(23, 28)
    assert robot.status().state == "armed"


def test_nobody_at_that_number_is_told_with_those_who_are_there(bus):
    with pytest.raises(Silent, match="robot 9 does not answer; on this bus: 1"):
        Robot(CanLink(bus, 9)).connect()


def test_both_worlds_do_the_same_on_can():
    """The same accesses to the controller at the same times, in CPython and in real MicroPython."""
    traces = []
    for world in ("cpython", "micropython"):
        bus = CanBus.open(f"can:softrig:circular?body=still&world={world}")
        robot = Robot(CanLink(bus, 1))
        robot.connect()
        robot.arm()
        robot.fire(["A"], 300, 100)
        list(robot.listen(200))
        bench = bus.observers[1]
        assert bench.crashes == []
        traces.append((bench.clock.now_us, bench.trace_sha256()))
        robot.link.close()

    assert traces[0] == traces[1]


def test_a_script_runs_over_can_as_it_does_over_the_serial_line(softrig, tmp_path):
    script = tmp_path / "two.gait"
    script.write_text("gait 1\nrobot circular\nfire A at 40 % for 300 ms\nfire C at 30 % for 200 ms\n")

    done = softrig("run", str(script), "--robot", f"{STILL}@1", "--json")
    serial = softrig("run", str(script), "--robot", "sim:circular?body=still", "--json")

    reports = [json.loads(each.out.splitlines()[-1]) for each in (done, serial)]
    assert [each.status for each in (done, serial)] == [0, 0]
    by_can, by_serial = (report["observed"]["coil_on_s"] for report in reports)
    assert by_can == pytest.approx(by_serial, abs=0.01)
    assert reports[0]["link"]["frames_resent"] == 0


def test_robots_that_wait_for_one_word_start_within_one_control_step():
    bus = CanBus.open("can:softrig:circular,circular?body=still")
    robots = [Robot(CanLink(bus, node)) for node in (1, 2)]
    code = program.fire(1, 400, 300) + program.delay(300) + program.halt()
    for robot in robots:
        robot.connect()
        robot.upload(program.header(code, robot.profile.crc), code)
        robot.arm(lease_ms=2000)
        robot.ready()

    word = frames.encode(frames.seal(messages.SYNC.number, 0, 0, b"", 0, 0))
    asked_us = round(bus.now_s() * 1e6)
    CanLink(bus, ALL).write(word)
    list(robots[0].listen(100))

    began_us = [
        next(us for us, duty in bus.observers[node].coil("A").history if us > asked_us and duty) for node in (1, 2)
    ]
    assert abs(began_us[0] - began_us[1]) <= STEP_US + PWM_US
    for line in list(bus._lines):
        line.close()


def test_what_the_bus_cost_is_among_the_variables(robot, bus, bench):
    names = ["can_state", "can_overflows", "can_refused", "can_bus_offs"]
    robot.subscribe(50, names)
    before = [each.values for each in robot.listen(500) if isinstance(each, Sample)]
    bus._bus.desk.wire.spoil(3000, bench.board.can.can)  # again and again, for some tenths of a second
    after = [each.values for each in robot.listen(2500) if isinstance(each, Sample)]

    assert before[-1] == {"can_state": 1, "can_overflows": 0, "can_refused": 0, "can_bus_offs": 0}
    assert after[-1]["can_bus_offs"] > 0
    assert after[-1]["can_state"] == 1


def test_beacons_keep_their_period_beside_telemetry(robot, bench):
    robot.subscribe(50)
    stranger = beside(bench)
    records = [each for each in robot.listen(2000) if isinstance(each, Telemetry)]
    kinds = [frame.id >> 18 & 255 for frame in stranger.received if frame.extended]

    assert 39 <= len(records) <= 41
    assert 19 <= kinds.count(messages.BEACON.number) <= 21
    assert kinds.count(messages.BEACON_COILS.number) >= 75  # every 20 ms, but for those that a beacon puts off
    assert robot.statistics()["telemetry_missed"] <= 1
