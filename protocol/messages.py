"""The table of messages: the one place from which codec, reference page and dictionary are made.

A message is a number, a name and its fields in wire order (little endian, no padding). A field's unit is the end of
its name; its format is a struct letter, or `s` for the rest of the payload; what it means is the comment beside it,
which the reference page prints and a board need not hold. The test vectors in `tests/` freeze the bytes.

    payload = FIRE.pack(coils=1, duty_permille=600, hold_ms=500)
    order = FIRE.unpack(payload)
"""

import struct
from collections import namedtuple

_RANGES = {
    "B": (0, 0xFF),
    "b": (-0x80, 0x7F),
    "H": (0, 0xFFFF),
    "h": (-0x8000, 0x7FFF),
    "I": (0, 0xFFFFFFFF),
    "i": (-0x80000000, 0x7FFFFFFF),
}

_OutOfRange = getattr(struct, "error", ValueError)  # MicroPython has no struct.error


def _wraps() -> bool:
    """Return whether struct packs a number that is too large for its field without a word, as MicroPython does."""
    try:
        return struct.pack("<B", 256) is not None
    except (_OutOfRange, OverflowError):
        return False


_WRAPS = _wraps()

STATES = ("boot", "idle", "armed", "running", "tripped")
BOOT, IDLE, ARMED, RUNNING, TRIPPED = 0, 1, 2, 3, 4

EVENTS = (
    "", "started", "step", "finished", "aborted", "tripped", "disarmed", "cleared", "cut-off", "lost", "defaults",
    "accepted", "step-done", "paused", "resumed", "noted", "caught",
)  # fmt: skip
STARTED, STEP, FINISHED, ABORTED, TRIP, DISARMED, CLEARED, CUT_OFF, LOST, DEFAULTED = 1, 2, 3, 4, 5, 6, 7, 8, 9, 10
ACCEPTED, STEP_DONE, PAUSED, RESUMED, NOTED, CAUGHT = 11, 12, 13, 14, 15, 16

ROLES = ("viewer", "holder")
VIEWER, HOLDER = 0, 1

SECURED = ("no", "paired", "damaged")  # the pairing key of a robot
UNPAIRED, PAIRED, KEY_DAMAGED = 0, 1, 2

PARTS = ("definitions", "help")  # of the dictionary
DEFINITIONS, HELP = 0, 1

AT_ONCE, AT_SYNC = 0, 0xFFFFFFFF  # when a program starts, beside a time

PAUSES = ("pause", "resume", "step")
PAUSE_NOW, RESUME, ONE_STEP = 0, 1, 2

CAUSES = ("", "power-on", "", "reset")  # of a start of the firmware
POWER_ON, RESET = 1, 3

FAULT = "<IIHBiBB"  # start, now_ms, code, channel, value, state, cause of the start
FAULT_BYTES = struct.calcsize(FAULT)

SETTING_NAMES = ("node", "board_offset_decidegc", "resistance_mohm")
NODE, BOARD_OFFSET, RESISTANCE = 0, 1, 2
SETTING_SOURCES = ("defaults", "stored", "damaged")
DEFAULTS, STORED, DAMAGED = 0, 1, 2


Field = namedtuple("Field", ("name", "letter"))  # one value of a message: its name, whose end is the unit; its type


class Message:
    """One row of the table; packs and unpacks its payload, and refuses values that its fields cannot hold.

    A row that is never used takes little memory: a board has all of them and needs half.
    """

    _tuple = None  # made with the rest of what packing needs when that is first needed

    def __init__(self, number: int, name: str, *fields) -> None:
        self.number = number
        self.name = name
        self._names = " ".join([field.name for field in fields])
        self._letters = "".join([field.letter for field in fields])

    @property
    def fields(self) -> tuple:
        """Return the fields in their order."""
        names = self._names.split(" ")
        return tuple([Field(names[i], self._letters[i]) for i in range(len(self._letters))])

    def pack(self, **values) -> bytes:
        """Return the payload; ValueError names a field that is missing, unknown or outside its range."""
        if self._tuple is None:
            self._learn()
        if len(values) != len(self._fields):
            raise ValueError(f"{self.name} takes {self._names}")
        try:
            return self.packed(*[values[name] for name in self._fields])
        except KeyError as missing:
            raise ValueError(f"{self.name} needs {missing.args[0]}") from None

    def packed(self, *values) -> bytes:
        """Return the payload of all fields in their order; ValueError as from `pack`."""
        if self._tuple is None:
            self._learn()
        if len(values) != len(self._fields):
            raise ValueError(f"{self.name} takes {self._names}")
        numbers = values[:-1] if self._open else values
        try:
            payload = struct.pack(self._format, *numbers)
        except _OutOfRange:
            raise ValueError(self._complaint(values)) from None
        if _WRAPS and struct.unpack(self._format, payload) != numbers:
            raise ValueError(self._complaint(values))
        return payload + bytes(values[-1]) if self._open else payload

    def unpack(self, payload: bytes):
        """Return the fields as a named tuple; ValueError when the length is not this message's."""
        if self._tuple is None:
            self._learn()
        size = self._size
        if len(payload) == size and not self._open:
            return self._tuple(*struct.unpack(self._format, payload))
        if len(payload) < size or not self._open:
            raise ValueError(f"{self.name}: {len(payload)} bytes, expected {size}")
        return self._tuple(*struct.unpack(self._format, payload[:size]), payload[size:])

    def _learn(self) -> None:
        self._fields = tuple(self._names.split(" ")) if self._names else ()
        self._open = self._letters.endswith("s")
        self._format = "<" + (self._letters[:-1] if self._open else self._letters)
        self._size = struct.calcsize(self._format)
        self._tuple = namedtuple(self.name, self._fields)

    def _complaint(self, values: tuple) -> str:
        for i, letter in enumerate(self._letters):
            low, high = _RANGES.get(letter, (0, 0))
            if letter != "s" and not low <= values[i] <= high:
                return f"{self.name}: {self._fields[i]} {values[i]}, must be {low} to {high}"
        return f"{self.name}: a field is not a whole number"


HELLO = Message(
    0x01, "hello",  # Opens a session; the answer is `identity`. Never disturbs a program that is running.
    Field("version", "B"),  # Protocol version of the host.
    Field("session", "I"),  # Number the host chose for this session.
    Field("attach", "I"),  # The session whose lease and program are to be taken over, 0: none.
    Field("nonce_a", "I"),  # The host's part of the session key, and
    Field("nonce_b", "I"),  # its other half.
)  # fmt: skip
IDENTITY = Message(
    0x02, "identity",  # Who the robot is; answers `hello`.
    Field("session", "I"),  # The session that said hello.
    Field("boot", "I"),  # Number of this start of the firmware; a reset may draw the same again, see uptime_ms.
    Field("uptime_ms", "I"),  # Time since this start: less than the host expects after a reset.
    Field("dictionary_crc", "I"),  # CRC-32 of the dictionary text: the seed of open frames.
    Field("dictionary_bytes", "H"),  # Length of the dictionary text.
    Field("version", "B"),  # Protocol version of the robot.
    Field("state", "B"),  # State of the robot. [STATES]
    Field("role", "B"),  # What this session may do: only the holder may give orders. [ROLES]
    Field("node", "B"),  # The robot's number on a shared line, 0: none.
    Field("secured", "B"),  # Whether orders must carry tags; with a damaged key there are none. [SECURED]
    Field("slots", "B"),  # Credit to begin with: frames that may wait for their acknowledgement. [0..32]
    Field("bytes", "H"),  # Credit to begin with: bytes of them on the line.
    Field("byte_ns", "I"),  # Time of a byte on the line, 0: not known.
    Field("holder", "I"),  # The session that holds the lease, or whose program runs, 0: none.
    Field("step", "H"),  # Step of the program, 0: none.
    Field("nonce_a", "I"),  # The robot's part of the session key, and
    Field("nonce_b", "I"),  # its other half.
    Field("proof_a", "I"),  # Shows a host that has the pairing key that the robot has it too, 0: not secured, and
    Field("proof_b", "I"),  # its other half.
    Field("firmware", "s"),  # Version of the firmware, text.
)  # fmt: skip
DICTIONARY = Message(
    0x03, "dictionary",  # Asks for a page of the dictionary text.
    Field("part", "B"),  # Which text. [PARTS]
    Field("offset", "H"),  # First byte wanted.
    Field("count", "B"),  # How many bytes at most.
)  # fmt: skip
DICTIONARY_PAGE = Message(
    0x04, "dictionary_page",  # A page of the dictionary text.
    Field("part", "B"),  # Which text. [PARTS]
    Field("offset", "H"),  # First byte of this page.
    Field("text", "s"),  # The page; empty beyond the end.
)  # fmt: skip
STOPPED = Message(
    0x05, "stopped",  # Answers the stop pattern once everything is off.
    Field("state", "B"),  # State of the robot. [STATES]
    Field("code", "H"),  # Why it is stopped. [CODES]
    Field("coils", "I"),  # Bit mask of the channels that were driven when the stop arrived.
    Field("now_ms", "I"),  # The robot's clock.
)  # fmt: skip
NAK = Message(
    0x06, "nak",  # A greeting could not be served.
    Field("kind", "B"),  # Kind of the frame.
    Field("code", "H"),  # Why. [CODES]
    Field("version", "B"),  # Protocol version of the robot.
)  # fmt: skip
SYNC = Message(0x07, "sync")  # To all robots that wait for it: start your program now. Never answered.
WATCH = Message(
    0x08, "watch",  # Asks, from no session, for the usual variables as slot 4 for the next two seconds.
    Field("period_ms", "H"),  # Between two records; the robot takes 50 ms where less is asked.
)  # fmt: skip

ALIVE = Message(
    0x10, "alive",  # Acknowledges in full, gives credit, and renews the lease like any frame of the session.
    Field("have", "I"),  # Bit i: the frame i + 1 after the next expected one has arrived.
    Field("slots", "B"),  # How many frames, from the next expected one on, may be on the way. [0..32]
    Field("bytes", "H"),  # How many bytes of them.
)  # fmt: skip
ARM = Message(
    0x11, "arm",  # Takes the lease and allows orders until it runs out, once coils and joints have passed a self-test.
    Field("session", "I"),  # The session that asks, as in its `hello`.
    Field("lease_ms", "H"),  # Everything off when nothing arrives for this long; 0 takes the robot's own.
    Field("without", "I"),  # Bit mask of coils known to be broken: not tested, and never driven.
)  # fmt: skip
DISARM = Message(0x12, "disarm")  # Everything off, lease returned.
CLEAR = Message(0x13, "clear")  # Leaves the tripped state once its cause is gone.
FIRE = Message(
    0x14, "fire",  # Heat coils for a limited time; the order carries its own end.
    Field("coils", "I"),  # Bit mask of channels in the order of the profile.
    Field("duty_permille", "H"),  # Share of the PWM period that they are on; 0: off. [0..1000]
    Field("hold_ms", "H"),  # Off again after this long unless driven anew.
)  # fmt: skip
STATUS_REQUEST = Message(0x15, "status_request")  # Asks for `status`.
SUBSCRIBE = Message(
    0x16, "subscribe",  # Has the robot send some of its variables as `telemetry`.
    Field("slot", "B"),  # Which of the subscriptions. [0..3]
    Field("period_ms", "H"),  # Between two records, at the least; 0 ends it.
    Field("on_change", "B"),  # 1: only when a value has changed. [0..1]
    Field("variables", "s"),  # Numbers of the variables, u8 each, in the order of the record; none: the usual ones.
)  # fmt: skip
FAULTS_REQUEST = Message(
    0x17, "faults_request",  # Asks for `faults`.
    Field("skip", "B"),  # How many of the newest are not wanted.
)  # fmt: skip
CLEAR_FAULTS = Message(0x1B, "clear_faults")  # Forgets the faults that were kept; refused while the robot is armed.
SETTINGS_REQUEST = Message(0x19, "settings_request")  # Asks for `settings`.
SET = Message(
    0x1A, "set",  # Changes a setting and keeps it; refused while the robot is armed.
    Field("setting", "B"),  # Which. [SETTING_NAMES]
    Field("channel", "B"),  # The channel that it belongs to; 255: none.
    Field("value", "i"),  # Its value, in the unit that ends its name.
)  # fmt: skip
COILS_REQUEST = Message(0x18, "coils_request")  # Asks for `coils`.
CALIBRATE = Message(
    0x1C, "calibrate",  # Keeps the resistance of every coil, cold and whole, as a self-test measures it.
    Field("session", "I"),  # The session that asks, as in its `hello`.
    Field("without", "I"),  # Bit mask of coils known to be broken: not tested, and what was kept of them stands.
)  # fmt: skip
SERVICE = Message(0x1D, "service")  # Restarts the robot in service mode; refused unless everything is off.
CLOCK_REQUEST = Message(
    0x1E, "clock_request",  # Asks for `clock`; posted.
    Field("host_us", "I"),  # The host's clock, modulo 2**32.
)  # fmt: skip
PROGRAM = Message(
    0x20, "program",  # Begins the upload of a program.
    Field("header", "s"),  # The program's header, 16 bytes.
)  # fmt: skip
CODE = Message(
    0x21, "code",  # A piece of the program's code.
    Field("offset", "H"),  # Its first byte; of a streamed program modulo 65536.
    Field("code", "s"),  # The piece.
)  # fmt: skip
START = Message(
    0x22, "start",  # Verifies the uploaded program and runs it.
    Field("at_ms", "I"),  # When, by the robot's clock; 0: at once; 4294967295: at the next `sync`.
    Field("paused", "B"),  # 1: it stands still at its beginning, see `pause`. [0..1]
)  # fmt: skip
CANCEL = Message(0x23, "cancel")  # Ends the running program: all coils off, joints hold, still armed.

MOVE = Message(
    0x24, "move",  # Bring joints to a position on a straight line, then hold them there; the order carries its own end.
    Field("joints", "I"),  # Bit mask of channels in the order of the profile.
    Field("target_centi", "h"),  # Where to, in hundredths of the joint's unit, which the profile names.
    Field("over_ms", "H"),  # How long they are to take.
    Field("hold_ms", "I"),  # Limp again after this long there unless driven anew.
)  # fmt: skip
ORIENT = Message(
    0x25, "orient",  # Turn the object that both joints grip, by its angle as the camera sees it, then hold.
    Field("target_centideg", "h"),  # The object's angle.
    Field("time_ms", "H"),  # How long the robot regulates it.
    Field("hold_ms", "I"),  # Both joints limp again after this long unless driven anew.
)  # fmt: skip
PRESS = Message(
    0x26, "press",  # Press with a force, by what the load cell reads, then hold the axis where it stands.
    Field("target_mn", "H"),  # The force, reached on a straight line from the present one.
    Field("over_ms", "H"),  # How long it is to take to reach it.
    Field("time_ms", "I"),  # How long the robot regulates it, that included.
    Field("hold_ms", "I"),  # The joint limp again after this long unless driven anew.
)  # fmt: skip

PAUSE = Message(
    0x27, "pause",  # Stops the running program's clock. Orders on their way end by themselves; guards go on guarding.
    Field("how", "B"),  # Or lets it go on, for good or up to the next step. [PAUSES]
)  # fmt: skip

OK = Message(
    0x40, "ok",  # The request was taken.
    Field("request", "B"),  # Sequence number of the request.
)  # fmt: skip
REFUSED = Message(
    0x41, "refused",  # The request was not taken; nothing changed.
    Field("request", "B"),  # Sequence number of the request.
    Field("code", "H"),  # Why. [CODES]
    Field("channel", "B"),  # The channel it is about, 255: none.
    Field("value", "i"),  # What was asked, in the unit of the limit.
    Field("limit", "i"),  # What is allowed.
)  # fmt: skip
STATUS = Message(
    0x42, "status",  # Answers `status_request`.
    Field("request", "B"),  # Sequence number of the request.
    Field("state", "B"),  # State of the robot. [STATES]
    Field("code", "H"),  # Last fault, 0: none since boot. [CODES]
    Field("uptime_ms", "I"),  # Time since boot.
    Field("lease_ms", "H"),  # What is left of the lease, 0: none.
    Field("step", "H"),  # Step of the program, 0: none.
    Field("paused", "B"),  # 1: the program stands still. [0..1]
    Field("coils", "I"),  # Bit mask of the channels that are driven.
    Field("supply_mv", "H"),  # Supply voltage at the rail of coils and servos.
    Field("current_ma", "H"),  # Supply current.
    Field("board_decidegc", "h"),  # Temperature of the board.
    Field("roll_decideg", "h"),  # Lean to the right; 0 when the attitude is not known.
    Field("pitch_decideg", "h"),  # Turn forward since upright, -180 to 180 deg; 0 when the attitude is not known.
    Field("down", "B"),  # Channel of the coil whose direction is nearest to down; 255: the attitude is not known.
    Field("dropped", "H"),  # Damaged frames since boot, modulo 65536.
    Field("forged", "H"),  # Frames without the tag that the pairing key makes, since boot, modulo 65536.
    Field("repeated", "H"),  # Frames of this session that were heard before, modulo 65536.
    Field("overruns", "H"),  # Control steps that came late, modulo 65536.
)  # fmt: skip
FAULTS = Message(
    0x43, "faults",  # Answers `faults_request`: a page of the faults that were kept over resets and power cuts.
    Field("request", "B"),  # Sequence number of the request.
    Field("start", "I"),  # Number of this start of the firmware in the records.
    Field("count", "B"),  # How many faults there are.
    Field("records", "s"),  # Newest first. Channel 255: none; cause: of that start, see CAUSES.
    # [* start:I now_ms:I code:H channel:B value:i state:B cause:B]
)  # fmt: skip
SETTINGS = Message(
    0x44, "settings",  # Answers `settings_request`.
    Field("request", "B"),  # Sequence number of the request.
    Field("source", "B"),  # What is used: the defaults, unless something whole is stored. [SETTING_SOURCES]
    Field("node", "B"),  # Setting 0: the robot's number on a shared bus.
    Field("board_offset_decidegc", "h"),  # Setting 1: added to what the board's thermometer reads.
    Field("resistances", "s"),  # Setting 2: of each cold coil; 0: as in the profile. [* resistance_mohm:H]
)  # fmt: skip
COILS = Message(
    0x45, "coils",  # Answers `coils_request`: what the resistance of each coil, as measured last, says of it.
    Field("request", "B"),  # Sequence number of the request.
    Field("channels", "s"),  # Of each coil; resistance in 10 mohm, 0: not measured; martensite 65535: not known; its
    # temperature at least and at most, -32768 and 32767: no bound.
    # [* resistance_10mohm:H martensite_permille:H least_decidegc:h most_decidegc:h]
)  # fmt: skip
EVENT = Message(
    0x4F, "event",  # Something happened; sent once and surely.
    Field("event", "B"),  # What. [EVENTS]
    Field("code", "H"),  # Why; 0: in order. [CODES]
    Field("step", "H"),  # Step of the program, 0: none.
    Field("channel", "B"),  # The channel it is about, 255: none.
    Field("value", "i"),  # What was measured, in the unit of the code's limit.
    Field("now_ms", "I"),  # The robot's clock.
)  # fmt: skip
TELEMETRY = Message(
    0x50, "telemetry",  # A record of a subscription, not repeated when lost.
    Field("slot", "B"),  # Which of the subscriptions; 4: of whoever asked by `watch`. [0..4]
    Field("form", "B"),  # 0: the usual variables; else 1 + (seq of `subscribe` modulo 255).
    Field("count", "B"),  # Number of the record, modulo 256; those that found no room on the line are counted too.
    Field("now_ms", "I"),  # The robot's clock.
    Field("values", "s"),  # The variables in the order of the subscription, one with a value per coil with all of them;
    # every byte exclusive-ored with 0x55.
)  # fmt: skip
BEACON = Message(
    0x58, "beacon",  # On CAN only, ten times a second to all: a frame by itself, without segment byte, head and CRC.
    Field("state", "B"),  # State of the robot. [STATES]
    Field("code", "B"),  # Last fault, 0: none since boot. [CODES]
    Field("step", "H"),  # Step of the program, 0: none.
    Field("supply_mv", "H"),  # Supply voltage at the rail of coils and servos.
    Field("current_ma", "H"),  # Supply current.
)  # fmt: skip
BEACON_COILS = Message(
    0x59, "beacon_coils",  # Like `beacon`, every 20 ms: two coils, all of them in turn.
    Field("group", "B"),  # Half the number of the first channel. [0..15]
    Field("duty_a_percent", "B"),  # Duty of the first. [0..100]
    Field("duty_b_percent", "B"),  # Duty of the second, 0 where there is none. [0..100]
    Field("temperature_a_decidegc", "h"),  # Estimated temperature of the first.
    Field("temperature_b_decidegc", "h"),  # Estimated temperature of the second, 0 where there is none.
)  # fmt: skip
CLOCK = Message(
    0x5E, "clock",  # Answers `clock_request`.
    Field("host_us", "I"),  # As in the request.
    Field("received_ms", "I"),  # The robot's clock when it found the request.
    Field("sent_ms", "I"),  # The robot's clock when it made this answer.
)  # fmt: skip

MESSAGES = (
    HELLO, IDENTITY, DICTIONARY, DICTIONARY_PAGE, STOPPED, NAK, SYNC, WATCH,
    ALIVE, ARM, DISARM, CLEAR, FIRE, STATUS_REQUEST, SUBSCRIBE,
    FAULTS_REQUEST, CLEAR_FAULTS, SETTINGS_REQUEST, SET, CALIBRATE, COILS_REQUEST, SERVICE, CLOCK_REQUEST,
    PROGRAM, CODE, START, CANCEL, MOVE, ORIENT, PRESS, PAUSE, OK, REFUSED, STATUS, FAULTS, SETTINGS, COILS, EVENT,
    TELEMETRY, BEACON, BEACON_COILS, CLOCK,
)  # fmt: skip


def by_number(number: int) -> Message | None:
    """Return the message of that number, or None."""
    for message in MESSAGES:
        if message.number == number:
            return message
    return None
