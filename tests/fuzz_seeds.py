"""The seeds of the corpus: valid exchanges from which the fuzzer starts, written to tests/corpus by this file.

.venv/bin/python -m tests.fuzz_seeds
"""

from collections.abc import Iterator
from pathlib import Path

from protocol import frames, messages, program
from tests.fuzz_gait import WORDS, coded
from tests.fuzz_script import SESSION

CORPUS = Path(__file__).parent / "corpus"
SAMPLES = {"B": 1, "b": -1, "H": 300, "h": -300, "I": 5, "i": -5, "s": b"\x01\x02"}
ORDERS = [message for message in messages.MESSAGES if 0x10 <= message.number < 0x40]
ANSWERS = [message for message in messages.MESSAGES if 0x40 <= message.number < 0x60]
CODE = program.fire(1, 500, 100) + program.delay(50) + program.off(1) + program.halt()
HELLO, WAIT, ARM, STOP, BREAK = b"\x01", b"\xfc", b"\x06\x00", b"\x03", b"\x15"  # acts of the target `core`
IDENTITY, MOMENT = b"\x01\x01\x00", b"\x28\x00"  # acts of the target `session`
FOR = [
    "gait 1\nrobot circular\n",
    "for",
    "c",
    "in",
    "A",
    "B",
    ":",
    "\n    ",
    "fire",
    "$c",
    "at",
    "60",
    "%",
    "for",
    "600",
    "ms",
]
TEXTS = {
    "circular": "param duty = 60 % [5 % .. 90 %]\ndef push(c):\n    fire $c at $duty for 600 ms until 95 C\n"
    "repeat 2:\n    together:\n        push(A)\n        fire D E at 30 % for 800 ms ramp 100 ms  # both\n",
    "sphere-b": "circle roll = A100 A001 Am100 A00m1\nguard any.temperature > 120 C\nlet next = roll[down + 1]\n"
    "hold $next at 80 C with 9 % for 1 s\nwait until pitch > 30 deg timeout 4 s else out\nsym z 90 deg:\n"
    "    fire A100 at 9 % for 1 s overlap 200 ms\nlabel out\nwait 1 s\n",
    "fingers-experiment": "for a in 2.5 deg, -2.5 deg:\n    move R to $a over 500 ms\norient 2 deg for 1 s\n"
    'note "turned"\non fault:\n    move all to 0 deg over 1 s\n',
    "press": "move P to 4 mm over 2 s\nwait until force > 5 N timeout 4 s else abort\npress to 5 N over 1 s for 2 s\n"
    "wait until all C1 C2.pressure < 3 kPa timeout 2 * 500 ms else continue\n",
}
WORDY = (
    FOR,
    [*FOR[:7], "\n    ", "sym", "45", "deg", ":", "\n        ", *FOR[8:], "\n", "wait", "2", "s"],
    [
        FOR[0],
        "wait",
        "until",
        "any",
        ".",
        "temperature",
        "<",
        "45",
        "C",
        "timeout",
        "5",
        "s",
        "else",
        "abort",
        "\n",
        "on",
        "fault",
        ":",
        "\n    ",
        "wait",
        "1",
        "s",
    ],
    ["gait 1\nrobot press\n", "press", "to", "5", "N", "over", "1", "s", "for", "8", "s", "\n", "note", '"'],
)


def sized(data: bytes) -> bytes:
    """Return data with its length before it, as a script reads it."""
    return bytes((len(data),)) + data


def payload_of(message: messages.Message) -> bytes:
    """Return a payload of that message."""
    fields = {field.name: SAMPLES[field.letter] for field in message.fields}
    return message.pack(**fields | ({"session": SESSION} if "session" in fields else {}))


def head(kind: int, payload: bytes, flags: int = frames.RELIABLE, seq: int = 0) -> bytes:
    """Return what `Script.line` makes a frame of."""
    return bytes((flags, kind, seq, 0)) + sized(payload)


def told(message: messages.Message, payload: bytes, act: int) -> bytes:
    """Return what makes the targets `core` and `session` hear that message."""
    return bytes((act, message.number)) + sized(payload) + b"\x00"


def decoder() -> Iterator[tuple[str, bytes]]:
    for message in messages.MESSAGES:
        line = head(message.number, payload_of(message))
        yield message.name, b"\x01" + line + b"\x00" + sized(b"\x05noise") + b"\x01" + line
    yield "stop", b"\x00" + sized(b"\x07\x21" + frames.STOP) + b"\x01" + head(0x14, bytes(8))
    yield "long", (b"\x00" + sized(b"\x01" * 200)) * 3 + b"\x01" + head(0x14, bytes(228))
    yield "node", b"\x01" + head(0x14, bytes(8), frames.RELIABLE | frames.NODE | 0x50)


def link() -> Iterator[tuple[str, bytes]]:
    said = b"".join(b"\x00\x00" + sized(bytes((number,)) * number) for number in range(6))
    answered = b"\x00\x01" + sized(b"answer") + b"\x02\x01\xff\x03\x00"
    exchange = said + b"\x52\x00\xff\x53\x01" + answered
    for mode, name in ((0, "plain"), (1, "keyed"), (2, "node"), (3, "keyed node")):
        yield name, bytes((mode,)) + exchange * 3
    yield "lost", b"\x01" + said + b"\x52\x00\xff\x5b\x01\x20\x52\x01\xff\x53\x00" + b"\xf2\x00\xff\x53\x01" * 4
    yield "again", b"\x01" + exchange + b"\x04\x01\x00\x04\x01\x01"
    yield "session", b"\x08" + exchange + b"\x06\x00\x05\x0d\x01" + head(0x14, b"new") + exchange
    yield "credit", b"\x00\x07\x00\x01\x02" + exchange + b"\x01\x01\x05" + sized(b"post") + b"\xf2\x01\xff\x53\x00"


def core() -> Iterator[tuple[str, bytes]]:
    armed = b"\x00" + HELLO + WAIT + ARM + WAIT * 5
    fire = told(messages.FIRE, messages.FIRE.pack(coils=3, duty_permille=500, hold_ms=200), 0x07)
    for message in ORDERS:
        yield message.name, b"\x00" + HELLO + WAIT + told(message, payload_of(message), 0x07) + WAIT
    yield "fired", armed + fire + WAIT * 4
    yield "stopped", armed + fire + STOP + WAIT + told(messages.CLEAR, b"", 0x07) + WAIT
    yield "played", armed + b"\x04" + sized(CODE) + WAIT * 3
    yield "at sync", armed + b"\x24" + sized(CODE) + WAIT + b"\x02" + head(messages.SYNC.number, b"", 0) + WAIT * 2
    yield "e-stop", armed + fire + BREAK + WAIT
    never = program.Condition(program.CURRENT, program.ANY, program.ABOVE, 0x7FFF, 0)
    begins = program.step(1) + program.fire(1, 500, 100) + program.wait(never, 100, program.ABORT)
    ends = program.halt() + program.label(program.ON_FAULT) + program.note(2) + program.delay(50) + program.halt()
    resume, one_step = (
        told(messages.PAUSE, messages.PAUSE.pack(how=how), 0x07) for how in (messages.RESUME, messages.ONE_STEP)
    )
    yield "streamed", armed + b"\x44" + sized(begins) + WAIT + b"\x0b" + sized(ends) + WAIT * 3
    yield "starved", armed + b"\x44" + sized(program.fire(1, 500, 500) + program.delay(20)) + WAIT * 2
    yield "stepped", armed + b"\x84" + sized(begins + ends) + one_step + WAIT + resume + WAIT * 4
    yield "stepped in a stream", armed + b"\xc4" + sized(begins) + one_step + b"\x0b" + sized(ends) + WAIT * 4
    yield "taken over", armed + fire + b"\x11" + WAIT + fire + WAIT
    yield "keyed", b"\x01" + HELLO + WAIT + ARM + fire + WAIT


def hand() -> Iterator[tuple[str, bytes]]:
    for mode, joints, name in ((0, 0, ""), (2, 2, "mixed ")):  # the second robot's joints stand behind two coils
        right, left = 1 << joints, 2 << joints
        armed = bytes((mode,)) + HELLO + b"\xfc" * 2 + ARM + WAIT * 5
        fields = {"over_ms": 200, "hold_ms": 3000}
        grip = b"".join(
            told(messages.MOVE, messages.MOVE.pack(joints=joint, target_centi=target, **fields), 0x07)
            for joint, target in ((right, 250), (left, -250))
        )
        turn = told(messages.ORIENT, messages.ORIENT.pack(target_centideg=500, time_ms=1000, hold_ms=1000), 0x07)
        there = program.Condition(program.POSITION, program.ALL, program.BELOW, 300, right | left)
        strained = program.Condition(program.JOINT_CURRENT, program.ANY, program.ABOVE, 2000, right)
        turned = program.Condition(program.ORIENTATION, program.ANY, program.ABOVE, 400, 0)
        closed = program.move(right, 250, 200) + program.move(left, -250, 200) + program.delay(200)
        code = program.guard(strained) + closed + program.wait(there, 300, 0) + program.orient(500, 900)
        code += program.wait(turned, 300, program.CONTINUE) + program.halt()
        yield f"{name}gripped", armed + grip + WAIT * 4
        yield f"{name}turned", armed + grip + WAIT * 4 + turn + WAIT * 2 + b"\xc5" + WAIT * 3 + b"\x05" + WAIT
        yield f"{name}blind", armed + grip + WAIT * 4 + turn + WAIT + b"\x95" + WAIT * 4 + b"\x05" + turn + WAIT
        yield f"{name}strained", armed + grip + b"\xe5" + WAIT * 7 + told(messages.CLEAR, b"", 0x07) + ARM + WAIT
        yield f"{name}played", armed + b"\x04" + sized(code) + WAIT * 14
        yield f"{name}cancelled", armed + b"\x14" + sized(code) + WAIT * 7 + told(messages.CANCEL, b"", 0x07) + WAIT * 2
        yield f"{name}stopped", armed + grip + STOP + WAIT + told(messages.CLEAR, b"", 0x07) + WAIT


def press() -> Iterator[tuple[str, bytes]]:
    armed = b"\x00" + HELLO + b"\xfc" * 2 + ARM + WAIT * 5

    def pressed(target_mn: int, over_ms: int = 200, time_ms: int = 900) -> bytes:
        fields = {"over_ms": over_ms, "time_ms": time_ms, "hold_ms": 3000}
        return told(messages.PRESS, messages.PRESS.pack(target_mn=target_mn, **fields), 0x07)

    def moved(target_centi: int, over_ms: int = 1500) -> bytes:
        fields = {"joints": 1, "target_centi": target_centi, "over_ms": over_ms, "hold_ms": 3000}
        return told(messages.MOVE, messages.MOVE.pack(**fields), 0x07)

    clear = told(messages.CLEAR, b"", 0x07)
    hard = program.Condition(program.FORCE, program.ANY, program.ABOVE, 1500, 0)
    felt = program.Condition(program.PRESSURE, program.ANY, program.ABOVE, 3000, 0b111111)
    deep = program.Condition(program.POSITION, program.ALL, program.ABOVE, 200, 1)
    code = program.guard(felt) + program.press(2000, 200, 1200) + program.wait(hard, 900, program.CONTINUE)
    code += program.wait(deep, 300, program.CONTINUE) + program.press(0, 0, 500) + program.delay(400) + program.halt()
    down = armed + moved(100, 300) + WAIT * 5
    yield "pressed", down + pressed(3000) + WAIT * 14
    yield "let go", down + pressed(3000) + WAIT * 9 + pressed(0, 0, 300) + WAIT * 4 + moved(-200, 600) + WAIT * 6
    yield "overloaded", armed + moved(1000) + WAIT * 26 + clear + ARM + WAIT * 5 + moved(0) + WAIT * 9
    yield "blind", down + pressed(3000) + WAIT * 4 + b"\x95" + WAIT * 2 + b"\x05" + clear + ARM + WAIT
    yield "torn", down + pressed(3000) + WAIT * 4 + b"\xa5" + WAIT * 2 + ARM + b"\x05" + clear + ARM + WAIT
    yield "raised", down + pressed(9000) + WAIT * 4 + b"\xc5" + WAIT * 3 + b"\x05" + WAIT * 3
    yield "stuck", down + b"\xd5" + pressed(9000) + WAIT * 9 + b"\x05" + WAIT
    yield "played", down + b"\x04" + sized(code) + WAIT * 26
    yield "guarded", down + b"\x04" + sized(code) + WAIT * 4 + b"\xb5" + WAIT * 3
    yield "cancelled", down + b"\x14" + sized(code) + WAIT * 7 + told(messages.CANCEL, b"", 0x07) + WAIT * 2
    yield "stopped", down + pressed(3000) + WAIT * 4 + STOP + WAIT + clear + WAIT
    yield "refused", down + pressed(30_000) + pressed(1000, 900, 100) + moved(5000) + WAIT


def session() -> Iterator[tuple[str, bytes]]:
    for message in ANSWERS:
        act = 0x03 if message.number < 0x50 else 0x04
        yield message.name, b"\x00" + IDENTITY + b"\x05\x00" + told(message, payload_of(message), act) + MOMENT * 3
    pages = b"".join(b"\x02" + bytes((number,)) for number in range(80))
    yield "pages", b"\x04" + IDENTITY + pages + MOMENT
    yield "stop", b"\x00" + IDENTITY + b"\x87" + b"\x06" + head(5, payload_of(messages.STOPPED), 0) + MOMENT
    yield "other version", b"\x00\x06" + head(6, messages.NAK.pack(kind=1, code=8, version=3), 0) + MOMENT
    yield "silence", b"\x00" + IDENTITY + (b"\xf8\x00" * 90)


def canbus() -> Iterator[tuple[str, bytes]]:
    for mode, name in ((0, "classic"), (1, "fd"), (2, "from robot"), (3, "fd from robot")):
        fed = b"\x04" + head(0x14, bytes(range(8))) + b"\x04" + head(0x40, bytes(60), 1, 1)
        yield name, bytes((mode,)) + fed + b"\x01" * 12
        yield name + " lost", bytes((mode,)) + fed + b"\x01\x01\x03\x01\x05\x02" + b"\x01" * 9
    yield "stop", b"\x00\x00" + sized(frames.STOP) + b"\x01\x02" + bytes(4) + sized(b"STOP")


def slcan() -> Iterator[tuple[str, bytes]]:
    for text in (
        "V\rN\rS6\rO\rt1232AABB\rT123456783112233\rr1230\rF\rC\r", "S9\rL\rt1230\rF\r",
        "s011C\rO\rT000000008" + "00" * 8,
        "Z0\rX1\rO\rO\rS6\rC\r", "\r\r?\rt12\rT1\rtFFF8\r",
    ):  # fmt: skip
        yield text[:5].replace("\r", "").replace("?", "_"), b"".join(b"\x11" + sized(each) for each in _halves(text))


def socketcand() -> Iterator[tuple[str, bytes]]:
    for name, text in (
        ("send", "< send 123 2 AA BB >< send 12345678 0 >< sendrtr 123 0 >"),
        ("echo", "< echo >< bcmmode >< send 7FF 1 0 >"),
        ("broken", "< send 123 9 >< open >< send zzz 1 1 ><< >>< >"), ("long", "<" * 200),
    ):  # fmt: skip
        yield name, b"".join(b"\x11" + sized(each) for each in _halves(text))


def gait() -> Iterator[tuple[str, bytes]]:
    for robot, text in TEXTS.items():
        yield robot, coded(f"gait 1\nrobot {robot}\n{text}", robot)
    for number, words in enumerate(WORDY):
        yield f"words {number}", bytes((0x80,)) + bytes(WORDS.index(word) for word in words)


def _halves(text: str) -> tuple[bytes, bytes]:
    return text[: len(text) // 2].encode(), text[len(text) // 2 :].encode()


SEEDS = (decoder, link, core, hand, press, session, canbus, slcan, socketcand, gait)


def files() -> Iterator[tuple[Path, bytes]]:
    """Yield all seeds, each with where it is kept."""
    for seeds in SEEDS:
        for name, data in seeds():
            yield CORPUS / seeds.__name__ / name.replace(" ", "-"), data


if __name__ == "__main__":
    for path, data in files():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
