"""A run of the firmware's core that any Python can make: prints every byte it sends and every duty it sets.

Runs under CPython and under MicroPython; tests/test_firmware_micropython.py compares what the two print. Arguments:
the profile's path, then `lock` to forbid memory allocation in the control step. A profile with an attitude sensor gets
one that rolls, is lost and comes back, and a program that asks where down is; one with joints gets an object that
turns against them, and a camera that is lost and comes back.
"""

import sys
from array import array
from binascii import crc32, hexlify

from firmware import core
from firmware.control import Control
from firmware.core import Core
from firmware.dictionary import Dictionary
from firmware.profile import Profile
from protocol import messages, program
from protocol.frames import STOP
from protocol.link import Link

SESSION = 77


class Chip:
    """A PWM chip that prints what it is told."""

    address = 0x60
    on = [0] * 16

    def begin(self):
        print("begin")

    def set(self, output, permille):
        self.on[output] = permille
        out("set", output, permille)

    def all_off(self):
        for output in range(16):
            self.on[output] = 0
        out("off", 0, 0)

    def configured(self):
        return True


class Monitor:
    """A supply monitor: its averages are always the same, its looks see the coils that are full on."""

    address = 0x40
    ma = 20
    mv = 2000
    mohm = 10_000

    def __init__(self):
        self.seen = 0

    def begin(self):
        print("begin")

    def configured(self):
        return True

    def average(self):
        out("average", 0, 0)

    def hasten(self):
        out("hasten", 0, 0)

    def look(self):
        self.seen = 0
        for permille in Chip.on:
            if permille == 1000 and Table.powered:
                self.seen += self.mv * 1000 // self.mohm

    def seen_ma(self):
        return self.seen

    def seen_mv(self):
        return self.mv

    def seen_mohm(self):
        return self.mv * 1000 // self.seen if self.seen else 0x3FFFFFFF

    def current_ma(self):
        return self.ma

    def voltage_mv(self):
        return self.mv


class Imu:
    """An attitude sensor that turns forward by 180 deg/s, falls silent from the third second on for half a second."""

    def __init__(self):
        self.words = array("h", [0] * 6)
        self._turn = 0

    def begin(self):
        print("begin")

    def configured(self):
        return True

    def read(self):
        self._turn += 1
        way = CIRCLE[self._turn // 25 % 8]
        self.words[1] = 5143
        self.words[2] = self._turn & 1
        self.words[3] = way[0]
        self.words[5] = way[1]
        return not 300 <= self._turn < 350


WIDTHS = [0, 0]  # of the pulses that each servo had last [ns]


class Servo:
    """A servo that prints its pulses, and is where they say at once."""

    def __init__(self, place):
        self._place = place

    def pulse(self, width_ns):
        WIDTHS[self._place] = width_ns
        out("pulse", self._place, width_ns)

    def off(self):
        out("limp", self._place, 0)


class Converter:
    """Currents, joints where their servos were sent last, and what presses the harder the further they went."""

    def counts(self, channel):
        for place in range(len(profile.joints)):
            if channel == profile.joints[place].current:
                return 200
            if channel == profile.joints[place].position:
                return 410 + (WIDTHS[place] - 500_000) // 1000 * 3276 // 2000
        return 819 + max(0, WIDTHS[0] - 1_500_000) // 400 + channel


class Camera:
    """An object that turns against the joints' swing; nobody sees it from the third second on for half a second."""

    def __init__(self):
        self.seen = True
        self.centideg = 0
        self.turn = 0

    def read(self):
        self.turn += 1
        self.centideg = -((WIDTHS[0] + WIDTHS[1]) // 2 - 1_500_000) * 7 // 1000
        return self.turn % 2 == 0 and not 600 <= self.turn < 700


class Table:
    """A board on a table top."""

    powered = False
    serial = b"the table"
    credit_bytes = 960
    byte_ns = 86_805

    def open(self, path, mode):
        raise OSError(2, "ENOENT")

    def dictionary(self):
        return Dictionary(on_flash, "")

    def imu(self, address):
        return Imu()

    def servo(self, pin, hz):
        WIDTHS[pin - 8] = 1_500_000
        return Servo(pin - 8)

    def adc(self):
        return Converter()

    def camera(self, address):
        return Camera()

    def pwm(self, address):
        return Chip()

    def monitor(self, shunt_mohm, alert_ma):
        return Monitor()

    def wait_us(self, time_us):
        out("wait", time_us, 0)

    def alert(self):
        return False

    def power(self, on):
        Table.powered = on
        out("power", int(on), 0)

    def beat(self):
        pass

    def estop_closed(self):
        return True

    def board_decidegc(self):
        return 251


def on_flash(path, mode):
    """Open a file of the slot that runs."""
    return open(sys.argv[1] if path == "/robot.json" else __file__.rsplit("/", 2)[0] + path, mode)


CIRCLE = ((0, 8197), (-5796, 5796), (-8197, 0), (-5796, -5796), (0, -8197), (5796, -5796), (8197, 0), (5796, 5796))
told = []
LOCKED = "lock" in sys.argv


def out(what, first, second):
    """Note what a chip was told, unless memory is locked; printed between the steps."""
    if not LOCKED:
        told.append((what, first, second))


class Locked(Control):
    """A control step that may not allocate."""

    def step(self, now_ms, state):
        micropython.heap_lock()
        try:
            return super().step(now_ms, state)
        finally:
            micropython.heap_unlock()


def script():
    """Return a program with every op in it."""
    warm = program.Condition(program.TEMPERATURE, program.ANY, program.ABOVE, 400, 0xFF)
    hot = program.Condition(program.TEMPERATURE, program.ALL, program.ABOVE, 1100, 0xFF)
    ops = (
        program.guard(hot), program.repeat(2), program.step(1), program.fire(0b101, 700, 200, 600), program.delay(100),
        program.step(2), program.ramp(0b10, 400, 300, 0, 150), program.wait(warm, 300, program.CONTINUE),
        program.next_(), program.off(0b10), program.halt(),
    )  # fmt: skip
    return b"".join(ops)


def rolling():
    """Return a program that asks where down is in every way."""
    ahead = program.Condition(program.DOWN, program.CHOSEN, program.IS, 0, 1)
    cool = program.Condition(program.HEAT, program.CHOSEN, program.BELOW, 500, 1)
    turned = program.Condition(program.PITCH, program.ANY, program.ABOVE, 300, 0)
    leans = program.Condition(program.ROLL, program.ANY, program.ABOVE, 800, 0)
    ops = (
        program.guard(leans), program.repeat(20), program.step(1), program.aim(1, 1, [5, 12, 0, 10, 4, 11, 1, 13]),
        program.wait(cool, 300, program.ABORT), program.aimed(1, 700, 60, 1000, 20), program.delay(80),
        program.wait(ahead, 200, program.CONTINUE), program.wait(turned, 40, program.CONTINUE), program.next_(),
        program.halt(),
    )  # fmt: skip
    return b"".join(ops)


def turning():
    """Return a program that moves joints and asks for them and for the object in every way."""
    strained = program.Condition(program.JOINT_CURRENT, program.ANY, program.ABOVE, 2000, 0b11)
    arrived = program.Condition(program.POSITION, program.ALL, program.BELOW, 900, 0b11)
    turned = program.Condition(program.ORIENTATION, program.ANY, program.ABOVE, 150, 0)
    ops = (
        program.guard(strained), program.step(1), program.move(1, 250, 100), program.move(2, -250, 100),
        program.wait(arrived, 500, program.ABORT), program.delay(100), program.step(2), program.orient(200, 4000),
        program.wait(turned, 900, program.CONTINUE), program.delay(4000), program.halt(),
    )  # fmt: skip
    return b"".join(ops)


def pressing():
    """Return a program that presses and asks for force and cells in every way."""
    hard = program.Condition(program.FORCE, program.ANY, program.ABOVE, 15_000, 0)
    deep = program.Condition(program.POSITION, program.ANY, program.ABOVE, 200, 0b1)
    felt = program.Condition(program.PRESSURE, program.ALL, program.ABOVE, 4000, 0b111111)
    ops = (
        program.guard(hard), program.step(1), program.move(1, 20, 300), program.wait(felt, 500, program.CONTINUE),
        program.delay(100), program.step(2), program.press(6000, 500, 1200), program.wait(deep, 900, program.CONTINUE),
        program.delay(700), program.press(0, 200, 70_000), program.delay(300), program.move(1, -10, 1000),
        program.halt(),
    )  # fmt: skip
    return b"".join(ops)


def driving(profile):
    """Return (time_ms, message, fields) of what drives the robot at once, mistakes included."""
    if profile.press:
        return [
            (190, messages.PRESS, {"target_mn": 18_001, "over_ms": 10, "time_ms": 10, "hold_ms": 10}),
            (200, messages.PRESS, {"target_mn": 4000, "over_ms": 50, "time_ms": 80, "hold_ms": 40}),
            (2510, messages.PRESS, {"target_mn": 3000, "over_ms": 0, "time_ms": 700, "hold_ms": 600_000}),
        ]
    if profile.joints:
        return [
            (30, messages.MOVE, {"joints": 1, "target_centi": 0, "over_ms": 10, "hold_ms": 10}),
            (190, messages.MOVE, {"joints": 3, "target_centi": 3001, "over_ms": 10, "hold_ms": 10}),
            (195, messages.MOVE, {"joints": 3, "target_centi": 321, "over_ms": 50, "hold_ms": 40}),
            (200, messages.ORIENT, {"target_centideg": -100, "time_ms": 30, "hold_ms": 20}),
            (2010, messages.ORIENT, {"target_centideg": 0, "time_ms": 1000, "hold_ms": 1000}),
        ]
    return [
        (30, messages.FIRE, {"coils": 1, "duty_permille": 500, "hold_ms": 100}),
        (190, messages.FIRE, {"coils": 3, "duty_permille": 1001, "hold_ms": 100}),
        (195, messages.FIRE, {"coils": 3, "duty_permille": 321, "hold_ms": 100}),
        (2010, messages.FIRE, {"coils": 0x80, "duty_permille": 1000, "hold_ms": 9000}),
    ]


def orders(profile):
    """Return (time_ms, message, fields) of a whole session, mistakes included."""
    crc = profile.crc
    driven = pressing() if profile.press else turning()
    code = driven if profile.joints else rolling() if profile.imu_address else script()
    found = driving(profile)
    found += [
        (0, messages.HELLO, {"version": 2, "session": SESSION, "attach": 0, "nonce_a": 0, "nonce_b": 0}),
        (20, messages.DICTIONARY, {"part": 0, "offset": 0, "count": 200}),
        (40, messages.SUBSCRIBE, {"slot": 0, "period_ms": 50, "on_change": 0, "variables": b""}),
        (50, messages.ARM, {"session": SESSION, "lease_ms": 0, "without": 0 if profile.joints else 0b100}),
        (260, messages.COILS_REQUEST, {}),
        (300, messages.PROGRAM, {"header": program.header(code, crc)}),
        (310, messages.CODE, {"offset": 0, "code": code}),
        (320, messages.START, {"at_ms": 0, "paused": 0}),
        (1900, messages.SETTINGS_REQUEST, {}),
        (1910, messages.SET, {"setting": messages.NODE, "channel": 255, "value": 3}),
        (1920, messages.FAULTS_REQUEST, {"skip": 0}),
        (2000, messages.STATUS_REQUEST, {}),
    ]
    return sorted(found, key=lambda order: order[0])


def session(core, profile):
    """Run the session, then stop; print all that happens."""
    host = Link()
    host.begin(core.link.decoder.dictionary_crc, SESSION)
    plan = orders(profile)
    for now_ms in range(0, 4500, 5):
        line = b""
        while plan and plan[0][0] <= now_ms:
            _, message, fields = plan.pop(0)
            if message.number < 16:
                host.post(message.number, message.pack(**fields))
            else:
                host.send(message.number, message.pack(**fields), now_ms)
        if now_ms < 4000:
            host.acknowledge()
            line = host.poll(now_ms)
        if now_ms == 3600:
            line += STOP
        answer = core.step(now_ms, line, 1024)
        host.receive(answer, now_ms)
        for row in told:
            print(now_ms, *row)
        told.clear()
        if answer:
            print(now_ms, "sent", hexlify(answer).decode())


with open(sys.argv[1], "rb") as file:
    profile = Profile(file.read())
Monitor.mv = profile.supply.nominal_mv
Monitor.mohm = profile.coil.resistance_mohm + profile.coil.wiring_mohm
if LOCKED:
    import micropython

    core.Control = Locked
    session(Core(Table(), profile, 1), profile)
else:
    session(Core(Table(), profile, 1), profile)
dictionary = Table().dictionary()
print("dictionary", dictionary.crc, dictionary.size, crc32(dictionary.page(1, 100, 100)))
