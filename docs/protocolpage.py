"""The figures, tables and examples of the page of the wire protocol; its prose is templates/protocol.md."""

import re
from binascii import crc32
from collections.abc import Callable

from docs import board, dbc, exchange, vectors
from docs.definitions import Place, Row, enums, rows, variables
from firmware import greetings, player, selftest, subscriptions
from firmware.rates import RATES
from firmware.subscriptions import STEP_MS
from host import handshake, session, silence, stopping
from host.cli.explain import JOINTS
from host.errors import unit_of
from protocol import canbus, causes, codes, flight, frames, link, messages, program, secret
from protocol.variables import USUAL, VARIABLES, veiled

Table = Callable[[tuple[str, ...], list[tuple[str, ...]]], str]
BAUD = board.constants()["BAUD"]
ARGUMENTS = {
    "fire": "coils u32, duty u16 [permille], time u16 [ms], cut-off u16 [0.1 C; 0: none; 0x8000 added: kept near]",
    "ramp": "coils u32, duty u16 [permille], time u16 [ms], cut-off u16 [0.1 C; 0: none], ramp u16 [ms]",
    "delay": "time u32 [ms]",
    "repeat": "count u16",
    "wait": "condition u64, timeout u32 [ms], otherwise u8 [0: abort, 1: continue, 2 + n: go on at label n]",
    "guard": "condition u64",
    "step": "number u16",
    "off": "coils u32",
    "aim": "place u8, ahead u8, circle of 8 channels u64 [255: none]",
    "aimed": "place u8, duty u16 [permille], time u16 [ms], cut-off u16 [0.1 C; 0: none], ramp u16 [ms]",
    "move": "joints u32, target i16 [0.01 of the joint's unit], time u16 [ms]",
    "orient": "target i16 [0.01 deg], time u16 [ms]",
    "press": "target u16 [mN], over u16 [ms], time u32 [ms]",
    "label": "number u8 [255: after an abort]",
    "note": "step u16",
}
SOURCES = (
    "1 coil temperature, 2 supply current, 3 supply voltage, 4 board temperature, 5 coil heat, 6 roll, 7 pitch, "
    "8 coil nearest to down, 9 position of the joint [0.01 of its unit], 10 joint current [mA], 11 angle of the "
    "gripped object [0.01 deg], 12 force on the load cell [mN], 13 pressure on the force cell [Pa], "
    "14 resistance of the coil [0.01 ohm; not measured: does not hold], 15 share of martensite by it [permille], "
    "16 time since the program began [ms, in the place of the mask]"
)
STATES = {
    "boot": "for less than a control step after its start",
    "idle": "supply of coils and joints open, no lease",
    "armed": "a session holds the lease and may give orders",
    "running": "a program runs",
    "tripped": "latched after a stop or fault: all coils off and joints limp until `clear`",
}


def fields(table: Table) -> dict[str, object]:
    """Return what the template leaves open."""
    return {
        **_frames(table),
        **_link(),
        **_session(table),
        **_programs(table),
        **_telemetry(table),
        **_can(),
        **_tables(table),
        "vectors": table(("", "holds"), _parts_of_the_vectors()),
    }


def _frames(table: Table) -> dict[str, object]:
    names = ("RELIABLE", "NODE", "SEALED", "BODY_MIN", "BODY_MAX", "PAYLOAD_MAX", "FRAME_MAX", "TAG_BYTES", "CRC_BYTES")
    return {
        **{name.lower(): getattr(frames, name) for name in names},
        "version": frames.VERSION,
        "reserved": frames.RESERVED.bit_length() - 1,
        "frame_min": frames.BODY_MIN + frames.STUFFING,
        "held_max": frames.BODY_MAX + 1,
        "between_zeros": frames.BODY_MIN + 1,
        "greetings_below": frames.GREETINGS_BELOW,
        "open_from": frames.OPEN_FROM,
        "open_last": frames.OPEN_BELOW - 1,
        "stop": frames.STOP.hex(" "),
        "crc_check": crc32(b"123456789"),
        "crc_check_seeded": crc32(b"123456789", 0x12345678),
        "worked": worked(table),
        "baud": BAUD,
        "rates": ", ".join(map(str, sorted(RATES))),
        "step_ms": STEP_MS,
    }


def worked(table: Table) -> str:
    """Return how one frame is made, byte by byte."""
    payload = messages.FIRE.pack(coils=1, duty_permille=600, hold_ms=500)
    seed = frames.session_seed(vectors.DICTIONARY_CRC, vectors.SESSION)
    body = frames.seal(messages.FIRE.number, 1, 3, payload, seed, frames.RELIABLE)
    parts = (
        ("version 2, flag reliable", body[:1]),
        ("kind fire", body[1:2]),
        ("seq 1", body[2:3]),
        ("ack 3", body[3:4]),
        ("coils 1", payload[:4]),
        ("duty_permille 600", payload[4:6]),
        ("hold_ms 500", payload[6:]),
        (f"CRC-32 0x{int.from_bytes(body[-4:], 'little'):08X} of the bytes above, from the seed", body[-4:]),
        ("on the wire", frames.encode(body)),
    )
    intro = (
        f"`fire` as frame 1 of session 0x{vectors.SESSION:08X} with a robot whose `dictionary_crc` is "
        f"0x{vectors.DICTIONARY_CRC:08X}: the seed is `crc32({vectors.SESSION.to_bytes(4, 'little').hex(' ')}, "
        f"0x{vectors.DICTIONARY_CRC:08X})` = 0x{seed:08X}.\n\n"
    )
    return intro + table(("", "bytes"), [(what, f"`{part.hex(' ')}`") for what, part in parts])


def _link() -> dict[str, object]:
    return {
        "window": flight.WINDOW,
        "queue_max": link.QUEUE_MAX,
        "probe_ms": flight.PROBE_MS,
        "rto_first_ms": flight.RTO_FIRST_MS,
        "rto_max_ms": flight.RTO_MAX_MS,
        "tick_ms": flight.TICK_MS,
        "tries_max": flight.TRIES_MAX,
        "laps": link.LAPS,
        "late": link.LATE,
        "past_max": link.PAST_MAX,
    }


def _session(table: Table) -> dict[str, object]:
    if set(STATES) != set(messages.STATES):
        raise ValueError("the page does not say what each state is")
    states = [(str(number), name, STATES[name]) for number, name in enumerate(messages.STATES)]
    places = [*(place for row in rows() for place in row.fields), *variables()]
    units = {place.name.rpartition("_")[2]: place for place in places if place.unit}
    return {
        "states": table(("", "state", ""), states),
        "tripped": f"{messages.TRIPPED} (tripped)",
        "holder": messages.HOLDER,
        "viewer": messages.VIEWER,
        "other_version": codes.OTHER_VERSION,
        "lease_expired": codes.LEASE_EXPIRED,
        "busy": f"R15, {codes.BUSY}",
        "range_limit": codes.RANGE_LIMIT,
        "slew_limit": codes.SLEW_LIMIT,
        "no_camera": codes.NO_CAMERA,
        "not_held": codes.NOT_HELD,
        "camera": codes.CAMERA,
        "no_load_cell": codes.NO_LOAD_CELL,
        "force_limit": codes.FORCE_LIMIT,
        "overload": codes.OVERLOAD,
        "load_cell": codes.LOAD_CELL,
        "keepalive_ms": session.KEEPALIVE_US // 1000,
        "ask_ms": handshake.ASK_MS,
        "stop_again_ms": stopping.AGAIN_US // 1000,
        "give_up_ms": handshake.GIVE_UP_MS,
        "bad_payload": codes.BAD_PAYLOAD,
        "test_turns": selftest.STRAY_AT + 1,
        "open_start": f"R{codes.OPEN_START}",
        "probe_host_ms": silence.PROBE_MS,
        "silent_ms": silence.SILENT_MS,
        "page": greetings.PAGE,
        "part_definitions": messages.DEFINITIONS,
        "part_help": messages.HELP,
        "units": ", ".join(f"`_{end}` {_unit(units[end])}" for end in sorted(units)),
        "key_bytes": secret.KEY_BYTES,
        "key_damaged": messages.KEY_DAMAGED,
        "code_key": f"F24, {codes.KEY}",
        "code_open_start": f"R30, {codes.OPEN_START}",
        "vector_key": "A worked key, proof and tag stand in `keys` of vectors.json.",
        "session": exchange.SESSION,
        "conversation": exchange.text(),
    }


def _programs(table: Table) -> dict[str, object]:
    return {
        "header_bytes": program.HEADER_BYTES,
        "format": program.FORMAT,
        "outlives": program.OUTLIVES_HOST,
        "streamed": program.STREAMED,
        "catches": program.CATCHES,
        "labels_max": program.LABELS_MAX,
        "at_sync": messages.AT_SYNC,
        "ops": op_table(table),
        "sources": SOURCES,
        "aims_max": program.AIMS_MAX,
        "depth_max": program.DEPTH_MAX,
        "guards_max": program.GUARDS_MAX,
        "bad_code": codes.BAD_CODE,
        "too_large": codes.TOO_LARGE,
        "starved": codes.STARVED,
        "ops_per_step": player.OPS_PER_STEP,
    }


def op_table(table: Table) -> str:
    """Return the op-codes with their bytes; ValueError when a size here is not the size in the code."""
    found = []
    for number, name in enumerate(program.NAMES):
        arguments = ARGUMENTS.get(name, "")
        size = 1 + sum(int(bits) // 8 for bits in re.findall(r" [ui](\d+)", arguments))
        if size != program.SIZES[number]:
            raise ValueError(f"{name}: {size} bytes described, {program.SIZES[number]} in protocol/program.py")
        words = getattr(program, "next_" if name == "next" else name).__doc__ or ""
        found.append((f"0x{number:02X}", str(size), name, arguments, words.strip().splitlines()[0]))
    return table(("op", "bytes", "name", "arguments", ""), found)


def _telemetry(table: Table) -> dict[str, object]:
    found = [
        (str(number), f"`{place.name}`", place.type + place.letter[1:], words_of(place))
        for number, place in enumerate(variables())
    ]
    return {
        "slots": subscriptions.SLOTS,
        "values_max": subscriptions.VALUES_MAX,
        "still_ms": subscriptions.STILL_MS,
        "veil": veiled(b"\0")[0],
        "usual_form": subscriptions.USUAL_FORM,
        "usual": ", ".join(f"`{VARIABLES[number].name}`" for number in USUAL),
        "variables": table(("number", "variable", "type", ""), found),
    }


def _can() -> dict[str, object]:
    names = {
        0: "the stop only", canbus.SYNCHRONISE: "`sync`", canbus.ORDERS: "orders and `alive` to a robot",
        canbus.ANSWERS: "`stopped`, answers, events and `alive` from a robot",
        canbus.GREETINGS: "greetings but `stopped`",
        canbus.TELEMETRY: "open frames",
    }  # fmt: skip
    return {
        "priorities": ", ".join(f"{number} {names[number]}" for number in sorted(names)) + "; 0 is the highest",
        "node_max": canbus.NODE_MAX,
        "node_all": canbus.ALL,
        "host_node": canbus.HOST,
        "stop_identifier": canbus.STOP_IDENTIFIER,
        "stop_data": f"`{canbus.STOP_DATA.hex(' ')}`",
        "classic_piece": canbus.CLASSIC - 1,
        "fd_piece": canbus.FD - 1,
        "fd_lengths": "12, 16, 20, 24, 32, 48 or 64",
        "under_way": canbus.UNDER_WAY_MAX,
        "late_ms": canbus.LATE_MS,
        "gap_ms": canbus.GAP_MS,
        "wake_ms": canbus.WAKE_MS,
        "sleep_ms": canbus.SLEEP_MS,
        "byte_ns": canbus.BYTE_NS,
        "can_worked": _segments(),
        "beacons": _beacons(),
        "dbc_robot": dbc.ROBOT,
        "dbc_host": dbc.HOST,
        "dbc_mask": dbc.MASK,
    }


def _segments() -> str:
    """Return the CAN frames of the order that the worked example has made."""
    payload = messages.FIRE.pack(coils=1, duty_permille=600, hold_ms=500)
    seed = frames.session_seed(vectors.DICTIONARY_CRC, vectors.SESSION)
    wire = frames.encode(frames.seal(messages.FIRE.number, 1, 3, payload, seed, frames.RELIABLE))
    sent = canbus.Segmenter(3, canbus.HOST, False).feed(wire)
    told = "\n".join(f"    0x{frame.identifier:08X}   {frame.data.hex(' ')}" for frame in sent)
    return f"\nThe order of the worked example, to robot 3 on classic CAN:\n\n{told}"


def _beacons() -> str:
    found = [row for row in rows() if row.number in canbus.BEACONS]
    if not found:
        return ""
    names = " and ".join(f"`{row.name}`" for row in found)
    return (
        f"\n**Beacons**: {names} are single frames without segment byte, head and CRC: the payload is the data "
        "of the CAN frame. A robot on CAN sends them unasked, to all hosts."
    )


def _tables(table: Table) -> dict[str, object]:
    lists = [(name, ", ".join(f"{number} {word}" for number, word in names.items())) for name, names in enums().items()]
    told = [(row.name, str(row.number), unit_of(row, JOINTS), row.cause) for row in causes.CODES]
    return {
        "messages": "\n".join(message_section(row, table) for row in rows()),
        "enums": table(("enum", "numbers and names"), [row for row in lists if row[0] != "CODES"]),
        "codes": table(("code", "number", "unit", ""), told),
        "bounds": bounds(table),
    }


def _parts_of_the_vectors() -> list[tuple[str, ...]]:
    lines = (line.split(maxsplit=1) for line in (vectors.__doc__ or "").splitlines() if line.startswith("    "))
    return [(f"`{name}`", words) for name, words in lines]


def bounds(table: Table) -> str:
    """Return the table of what can never be more."""
    found = [
        ("body, frame", f"{frames.BODY_MAX}, {frames.FRAME_MAX} bytes"),
        ("payload", f"{frames.PAYLOAD_MAX} bytes"),
        ("memory of a decoder", f"{frames.BODY_MAX + 1} bytes"),
        ("frames on the way, each direction", f"{flight.WINDOW}"),
        ("frames that wait to be sent, each direction", f"{link.QUEUE_MAX} reliable, {link.POSTS_MAX} posted"),
        ("credit of a robot on a serial line", f"{exchange.CREDIT_BYTES} bytes"),
        ("dictionary", "65535 bytes, read in pages"),
        ("subscriptions", f"{subscriptions.SLOTS}, each at most {subscriptions.VALUES_MAX} bytes a record"),
        ("program", "as the profile says (program.bytes_max)"),
        ("lease", "as the profile says (session.lease_max_ms)"),
        ("CAN bodies under way in a receiver", f"{canbus.UNDER_WAY_MAX}"),
        ("time from the stop's last byte to coils off, joints limp", f"one control step, {STEP_MS} ms"),
        ("frames lost to a burst of damage", "those that it hit, and at most the one after"),
    ]
    return table(("", "at most"), found)


def message_section(row: Row, table: Table) -> str:
    """Return one message with its fields."""
    head = f"### 0x{row.number:02X} {row.name}\n{row.words}\n"
    if not row.fields:
        return head + "No payload.\n"
    told = [(str(place.offset), place.type, f"`{place.name}`", words_of(place)) for place in row.fields]
    text = head + "\n" + table(("offset", "type", "field", ""), told)
    for place in row.fields:
        if place.parts:
            parts = [(str(part.offset), part.type, f"`{part.name}`") for part in place.parts]
            size = place.parts[-1].offset + place.parts[-1].size
            text += f"\nEach record of `{place.name}`, {size} bytes:\n\n" + table(("offset", "type", "field"), parts)
    return text


def words_of(place: Place) -> str:
    """Return what a field means, with its range or enum."""
    if place.limit:
        return f"{place.words} {place.low} to {place.high}."
    return f"{place.words} See {place.enum}." if place.enum else place.words


def _unit(place: Place) -> str:
    return f"{place.scale:g} {place.unit}" if place.scale != 1 else place.unit
