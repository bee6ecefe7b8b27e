"""The DBC: cantools loads it with every check on, and reads from it what our own codec wrote."""

import io
import subprocess
import sys
from pathlib import Path

import cantools
import pytest

from docs import dbc, definitions, vectors
from protocol import canbus, frames, messages
from protocol.frames import RELIABLE

FILE = Path(__file__).parents[1] / "docs" / "softrig.dbc"


@pytest.fixture(scope="module")
def bus():
    """The database with every check on, for the frames of any robot and any host."""
    return cantools.database.load_file(str(FILE), strict=True, frame_id_mask=dbc.MASK)


def segments(message, payload, robot=5, host=7, from_robot=True):
    """Return the CAN frames of a reliable frame."""
    line = frames.encode(frames.seal(message.number, 3, 9, payload, 0x1234, RELIABLE))
    return canbus.Segmenter(robot, host, from_robot).feed(line)


def read(bus, frame, **options):
    """Return the name of a CAN frame and what it says."""
    found = bus.get_message_by_frame_id(frame.identifier, force_extended_id=frame.extended)
    return found.name, found.decode(frame.data, **options)


def test_every_message_is_there_and_no_two_have_an_identifier(bus):
    names = {row.name for row in definitions.rows()} - {"alive"} | {"alive_to_robot", "alive_from_robot", "stop"}

    assert {message.name for message in bus.messages} == names
    assert len({(message.frame_id, message.is_extended_frame) for message in bus.messages}) == len(names)


def test_the_stop_is_read_as_a_stop(bus):
    (frame,) = canbus.Segmenter(5, 1, False).feed(frames.STOP)

    assert read(bus, frame) == ("stop", {"word": "STOP"})


def test_the_word_to_start_together_is_read_whole(bus):
    (frame,) = segments(messages.SYNC, b"", canbus.ALL, 7, False)

    assert read(bus, frame) == ("sync", {"word": "SYNC"})


def test_the_first_segment_shows_head_and_first_fields(bus):
    payload = messages.EVENT.pack(event=messages.TRIP, code=105, step=4, channel=2, value=7, now_ms=99)

    name, told = read(bus, segments(messages.EVENT, payload)[0])

    assert name == "event"
    assert (told["version"], told["flag_reliable"], told["flag_sealed"]) == (frames.VERSION, 1, 0)
    assert (told["kind"], told["seq"], told["ack"]) == ("event", 3, 9)
    assert (told["first"], told["last"], told["event"]) == (1, 0, "tripped")


def test_the_other_segments_show_their_bytes(bus):
    payload = messages.FIRE.pack(coils=1, duty_permille=600, hold_ms=500)

    name, told = read(bus, segments(messages.FIRE, payload, from_robot=False)[1])

    assert name == "fire"
    assert [told[f"byte{at}"] for at in range(1, 8)] == list((payload + b"\0\0")[3:8]) + told_crc(payload)


def told_crc(payload):
    """Return the first bytes of the check of that order."""
    body = frames.seal(messages.FIRE.number, 3, 9, payload, 0x1234, RELIABLE)
    return list(body[-4:])[:2]


def test_a_last_segment_may_be_short(bus):
    last = segments(messages.OK, messages.OK.pack(request=3))[-1]

    name, told = read(bus, last, allow_truncated=True)

    assert len(last.data) < 8
    assert (name, told["last"]) == ("ok", 1)


@pytest.mark.parametrize("message", [messages.BEACON, messages.BEACON_COILS], ids=lambda message: message.name)
def test_a_beacon_is_read_whole(bus, message):
    values = {"state": 2, "code": 105, "step": 4, "supply_mv": 2000, "current_ma": 1100, "group": 3}
    values |= {"duty_a_percent": 60, "duty_b_percent": 0, "temperature_a_decidegc": -12, "temperature_b_decidegc": 1200}
    mine = {field.name: values[field.name] for field in message.fields}
    frame = canbus.CanFrame(canbus.identifier(message.number, 5, canbus.ALL, True), True, message.pack(**mine))

    name, told = read(bus, frame, decode_choices=False)
    written = bus.get_message_by_name(name).encode(told)

    assert name == message.name
    assert told == pytest.approx(
        {each: value / 10 if each.endswith("decidegc") else value for each, value in mine.items()}
    )
    assert written == frame.data


@pytest.mark.parametrize(
    "row", [row for row in definitions.rows() if row.number not in canbus.BEACONS], ids=lambda row: row.name
)
def test_every_frame_of_every_message_is_read(bus, row):
    message = vectors.message(row)
    payload = vectors.usual(row.name)

    for from_robot in {"to": [False], "from": [True], "both": [False, True]}[row.ways]:
        for frame in segments(message, payload, from_robot=from_robot):
            name, _ = read(bus, frame, allow_truncated=True)
            assert name.startswith(row.name)


def test_cantools_on_the_command_line_reads_what_candump_prints():
    payload = messages.EVENT.pack(event=messages.FINISHED, code=0, step=4, channel=255, value=0, now_ms=99)
    found = segments(messages.EVENT, payload) + canbus.Segmenter(5, 1, False).feed(frames.STOP)
    lines = [candump(frame) for frame in found]

    command = [
        sys.executable,
        "-m",
        "cantools",
        "decode",
        "--single-line",
        "--no-strict",
        "--frame-id-mask",
        hex(dbc.MASK),
    ]
    done = subprocess.run([*command, str(FILE)], input="\n".join(lines), capture_output=True, text=True, check=True)

    told = done.stdout.splitlines()
    assert len(told) == len(lines)
    assert "event(counter: 0, last: 0, first: 1," in told[0]
    assert "event: finished" in told[0]
    assert told[-1].endswith("stop(word: STOP)")


def candump(frame):
    """Return a frame as `candump` prints it."""
    digits = f"{frame.identifier:08X}" if frame.extended else f"{frame.identifier:03X}"
    return f"  can0  {digits}   [{len(frame.data)}]  {frame.data.hex(' ').upper()}"


def test_the_names_in_the_file_are_short_enough_for_every_tool(bus):
    names = [name for message in bus.messages for name in [message.name, *(s.name for s in message.signals)]]

    assert max(map(len, names)) <= 32


def test_the_database_can_be_written_again(bus):
    again = cantools.database.load(io.StringIO(bus.as_dbc_string()), strict=True)

    assert {message.name for message in again.messages} == {message.name for message in bus.messages}


def test_a_force_is_told_in_its_unit(bus):
    payload = messages.PRESS.pack(target_mn=5000, over_ms=1000, time_ms=5000, hold_ms=1000)

    name, told = read(bus, segments(messages.PRESS, payload, from_robot=False)[0])

    assert (name, told["target_mn"]) == ("press", 5000)
    assert bus.get_message_by_name("press").get_signal_by_name("target_mn").unit == "mN"
