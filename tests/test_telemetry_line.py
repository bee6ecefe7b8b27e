"""Telemetry on the bench's line: as many records as its rate carries, none missed below that, each counted above."""

import pytest

from host.records import Sample, Telemetry
from protocol import messages, variables
from tests.hil_rig import HilRig


def records(rig, seconds, kind=Telemetry):
    return [record for record in rig.run(seconds) if isinstance(record, kind)]


def frames_sent(rig):
    """Return a list that grows by each frame of telemetry that the robot writes."""
    uart, sent = rig.bench.board.uart, []
    write = uart.write

    def writes(data, now_us):
        for stuffed in bytes(data).split(b"\x00"):
            if len(stuffed) > 2 and stuffed[0] > 2 and stuffed[2] == messages.TELEMETRY.number:
                sent.append(now_us)
        return write(data, now_us)

    uart.write = writes
    return sent


def quiet(rig):
    """End every noise on the line."""
    uart = rig.bench.board.uart
    uart.settle(rig.bench.clock.now_us)
    for wire in (uart.inward, uart.outward):
        wire.noises.clear()


@pytest.mark.parametrize(
    ("address", "coils", "period_ms"),
    [("sim:sphere-a?body=still", 18, 10), ("sim:sphere-b?body=still&baud=921600", 22, 5)],
)
def test_every_coil_is_told_at_the_full_rate_while_the_robot_works_and_answers(address, coils, period_ms):
    rig = HilRig(address)
    rig.robot.arm()
    rig.robot.subscribe(period_ms)

    told = records(rig, 0.1)
    rig.robot.fire([rig.robot.profile.labels[0]], 300, 1000)
    statuses = []
    for _ in range(30):
        told += records(rig, 0.1)
        statuses.append(rig.robot.status())
    told += records(rig, 0.1)

    times_ms = [record.now_ms for record in told]
    grid_ms = range(times_ms[0], times_ms[0] + len(times_ms) * period_ms, period_ms)
    assert len(times_ms) > 3000 / period_ms
    assert all(0 <= late - due <= 5 for late, due in zip(times_ms, grid_ms, strict=True))
    assert {len(record.duty_permille) for record in told} == {coils}
    assert rig.robot.statistics()["telemetry_missed"] == 0
    assert {(status.state, status.overruns, status.dropped) for status in statuses} == {
        ("armed", 0, statuses[0].dropped)
    }


def test_a_line_that_is_too_slow_carries_what_it_can_and_the_rest_is_counted():
    rig = HilRig("sim:sphere-b?body=still")
    sent = frames_sent(rig)
    rig.run(0.2)  # the dictionary has left the line, so that the first record finds room
    rig.robot.subscribe(5)

    told = records(rig, 3.0)
    rig.robot.subscribe(0)
    told += records(rig, 0.5)

    due = (told[-1].now_ms - told[0].now_ms) // 5 + 1
    assert len(told) == len(sent) > 0.85 * 3.0 * 11_520 / 119
    assert rig.robot.statistics()["telemetry_missed"] == due - len(told) > 200


def test_a_full_line_holds_up_no_answer_and_no_event():
    rig = HilRig("sim:sphere-b?body=still")
    for slot in range(4):
        rig.robot.subscribe(5, [variable.name for variable in variables.VARIABLES[:17]], slot=slot)
    records(rig, 0.5, Sample)

    took_s = []
    for _ in range(20):
        begin_s = rig.now_s
        rig.robot.status()
        took_s.append(rig.now_s - begin_s)
    begin_s = rig.now_s
    rig.robot.stop()

    assert max(took_s) < 0.060  # two frames of telemetry were before it, 15 ms each
    assert rig.now_s - begin_s < 0.060
    assert len({record.slot for record in records(rig, 0.5, Sample)}) == 4


@pytest.mark.parametrize("fault", ["line-flip:2", "line-lose:2", "line-double:2"])
def test_a_bad_line_loses_records_and_each_is_counted(fault):
    rig = HilRig("sim:circular?body=still")
    sent = frames_sent(rig)
    rig.robot.subscribe(10)

    rig.happens(fault)
    told = records(rig, 5.0)
    quiet(rig)
    told += records(rig, 0.2)
    rig.robot.subscribe(0)
    told += records(rig, 0.2)

    assert len(told) < 0.95 * len(sent)
    assert rig.robot.statistics()["telemetry_missed"] == len(sent) - len(told)


def test_a_change_is_told_within_the_step_and_nothing_else_is_sent():
    rig = HilRig("sim:circular?body=still")
    rig.robot.arm()
    rig.robot.subscribe(5, ["duty_permille", "coils_on"], on_change=True)
    first = records(rig, 0.5, Sample)

    rig.robot.fire(["A"], 250, 100)
    told = records(rig, 0.5, Sample)

    assert [sample.values["coils_on"] for sample in first + told] == [0, 1, 0]
    assert told[0].values["duty_permille"]["A"] == 250
    assert told[1].now_ms - told[0].now_ms == pytest.approx(100, abs=5)


def test_one_small_variable_costs_few_bytes():
    rig = HilRig("sim:circular?body=still")
    rig.robot.subscribe(10, ["supply_mv"])
    before = rig.robot.statistics()["bytes_received"]

    told = records(rig, 1.0, Sample)

    assert len(told) in (100, 101)
    spent = rig.robot.statistics()["bytes_received"] - before
    assert (
        spent <= len(told) * (2 + 7 + 8 + 2) + 200
    )  # values, head of the record, of the frame, stuffing; clock answers
