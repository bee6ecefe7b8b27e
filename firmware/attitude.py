"""Where down is, in the robot's own axes x (forward), y (left), z (up), which are the axes of its attitude sensor.

The gyroscope turns the last answer on, the accelerometer draws it back to what it feels wherever that is about one g:
at rest the accelerometer decides, through a roll the gyroscope. The time constant of 0.64 s leaves little of a knock;
the zero levels of the data sheet, 3 degrees a second and 40 mg on every axis, come to 7 degrees at most. Integers below
2**30 throughout: larger ones allocate on boards.

The sensor guards nothing: a robot that lost it goes on, except a program that asks where down is.
"""

from array import array

from protocol.labels import direction
from protocol.program import NO_COIL

UNIT = 1 << 14  # length of `down`
FINE = 6  # more bits than that in the sums
SETTLING = 6  # a sample of 10 ms draws a 64th of the difference: 0.64 s
PER_MS = 25_578  # 180 / pi / (0.035 deg/s a bit * 0.001 s) / 2**FINE
ONE_G = 512  # of an acceleration in units of 16 bits
LEAST, MOST = 448 * 448, 576 * 576  # one g within an eighth, squared
SILENT_MS = 100  # without a new sample: lost
SAME_MAX = 50  # samples that agree in every bit: stuck; the noise of a sound sensor moves the last bits of each
AGAIN_MS = 1000  # between two attempts to start a lost sensor
# atan(2**-i) in thousandths of a degree, and 2**14 times the length that all these turns together gain
ARCS = (45000, 26565, 14036, 7125, 3576, 1790, 895, 448, 224, 112, 56, 28, 14)
GAIN = 26_981


class Blind:
    """A robot that has no attitude sensor."""

    known = False
    lost = False

    def begin(self, now_ms: int) -> None:
        """Nothing to start."""

    look = check = begin

    def roll_decideg(self) -> int:
        """Return 0."""
        return 0

    pitch_decideg = roll_decideg

    def down_channel(self) -> int:
        """Return NO_COIL."""
        return NO_COIL


class Attitude:
    """What `imu` says about down, and which of the coils called `labels` points there. `known`: it is to be trusted."""

    def __init__(self, imu, labels: list) -> None:
        self.known = False
        self.lost = False  # since the reports last told
        self._missing = False
        self._started = False
        self.down = array("i", [0, 0, -UNIT])
        self._fine = array("i", [0, 0, 0])
        self._imu = imu
        self._last = array("h", [0] * 6)
        self._same = 0
        self._fresh_ms = 0
        self._again_ms = 0
        self._turn = 0
        self._nearest = NO_COIL
        self._length = 0
        self._directions = array("b", [0] * (3 * len(labels)))
        self._shares = array("H", [0] * len(labels))  # 256 / length of the direction, 0: has none
        for channel in range(len(labels)):
            self._point(channel, direction(labels[channel]))

    def begin(self, now_ms: int) -> None:
        """Start the sensor; what it says is known some samples later."""
        self._again_ms = now_ms + AGAIN_MS
        self._fresh_ms = now_ms
        self.known = False
        self._started = False
        try:
            self._imu.begin()
            self._started = True
        except OSError:
            self._lose()

    def look(self, now_ms: int) -> None:
        """Take a sample at every second call; a sensor that gives none is lost, and started again once a second."""
        self._turn ^= 1
        if self._turn:
            return
        if self._started and self._sampled() and self._same < SAME_MAX:
            self._update(now_ms)
        elif self.known and (self._same >= SAME_MAX or now_ms - self._fresh_ms > SILENT_MS):
            self._lose()
        elif not self.known and now_ms - self._again_ms >= 0:
            self._lose()
            self.begin(now_ms)

    def check(self, now_ms: int) -> None:
        """Start the sensor again if it has lost its settings."""
        try:
            sound = self._imu.configured()
        except OSError:
            return  # `look` counts its silence
        if not sound and self.known:
            self._lose()
            self.begin(now_ms)

    def pitch_decideg(self) -> int:
        """Return by how much the robot has turned forward since upright, -1800 to 1800; 0 when that is not known."""
        return self._angle(-self.down[2] << 4, self.down[0] << 4) if self.known else 0

    def roll_decideg(self) -> int:
        """Return how far the axle of that turn leans to the right, -900 to 900; 0 when that is not known."""
        if not self.known:
            return 0
        self._angle(-self.down[2] << 4, self.down[0] << 4)
        return self._angle(self._length, -self.down[1] * GAIN >> 10)

    def down_channel(self) -> int:
        """Return the coil whose direction is nearest to down, NO_COIL when that is not known."""
        if self._nearest == NO_COIL and self.known:
            most = 0
            for channel in range(len(self._shares)):
                nearness = self.nearness(channel)
                if nearness > most:
                    most = nearness
                    self._nearest = channel
        return self._nearest

    def nearness(self, channel: int) -> int:
        """Return the greater the nearer that coil's direction is to down."""
        at = 3 * channel
        ways, down = self._directions, self.down
        along = ways[at] * down[0] + ways[at + 1] * down[1] + ways[at + 2] * down[2]
        return along * self._shares[channel]

    def _point(self, channel: int, way: tuple | None) -> None:
        if way is None:
            return
        for i in range(3):
            self._directions[3 * channel + i] = way[i]
        self._shares[channel] = (256, 181, 148)[sum([abs(digit) for digit in way]) - 1]

    def _sampled(self) -> bool:
        """Take a new sample; return whether there was one."""
        try:
            if not self._imu.read():
                return False
        except OSError:
            return False
        words, last = self._imu.words, self._last
        self._same += 1
        for i in range(6):
            if words[i] != last[i]:
                last[i] = words[i]
                self._same = 0
        return True

    def _lose(self) -> None:
        """Know nothing from now on, and have that told once."""
        self.known = False
        self.lost = self.lost or not self._missing
        self._missing = True
        self._nearest = NO_COIL

    def _update(self, now_ms: int) -> None:
        """Turn `down` on by the last sample's rate and draw it to its acceleration."""
        divisor = PER_MS // max(1, min(now_ms - self._fresh_ms, SILENT_MS))
        self._fresh_ms = now_ms
        fine, down = self._fine, self.down
        words = self._imu.words
        fine[0] += (down[1] * words[2] - down[2] * words[1]) // divisor
        fine[1] += (down[2] * words[0] - down[0] * words[2]) // divisor
        fine[2] += (down[0] * words[1] - down[1] * words[0]) // divisor
        square = 0
        for i in range(3, 6):
            square += (words[i] >> 4) * (words[i] >> 4)
        if LEAST < square < MOST:
            for i in range(3):
                felt = -words[3 + i] << 7
                fine[i] = fine[i] + (felt - fine[i] >> SETTLING) if self.known else felt
            self.known = self.known or self._same == 0
            self._missing = not self.known
        self._level()

    def _level(self) -> None:
        """Bring `down` up to the sums, and both back to their length."""
        fine, down = self._fine, self.down
        for i in range(3):
            down[i] = max(-UNIT, min(UNIT, fine[i] >> FINE))
        short = UNIT * UNIT - down[0] * down[0] - down[1] * down[1] - down[2] * down[2] >> 15
        for i in range(3):
            fine[i] += down[i] * short >> 8
        self._nearest = NO_COIL

    def _angle(self, x: int, y: int) -> int:
        """Return the direction of (x, y) in tenths of a degree and leave its length, with GAIN, in `_length`."""
        angle = 0
        if x < 0:
            angle = 180_000 if y >= 0 else -180_000
            x = -x
            y = -y
        for i in range(len(ARCS)):
            across = x >> i
            if y > 0:
                x += y >> i
                y -= across
                angle += ARCS[i]
            else:
                x -= y >> i
                y += across
                angle -= ARCS[i]
        self._length = x
        return (angle + 50) // 100
