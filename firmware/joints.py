"""The only code that drives a joint: along a straight line to its target, there for as long as was ordered, then limp.

Whatever is asked, no joint is told a position outside its range, faster than its slew limit, or longer than its order.
Orders are checked whole before any of it is taken. A limp joint sets out from where it is measured and takes the time
that its slew limit needs, so that it never jumps. A mask has the channel numbers of the profile: coils come first.
"""

from array import array

from firmware.channels import Refused
from protocol import codes
from protocol.variables import UNKNOWN_CENTI

LIMP = UNKNOWN_CENTI
FINE = 16  # parts of a hundredth, in which pulses follow a line: whole ones would jerk what is pressed
NONE_TOLD = 1 << 29
BACK_MS = 100  # for which a joint that was told a smaller position is on its way back
LONG_MS = 29_000  # a longer way is reckoned in coarser time: 36000 hundredths times more would be beyond 2**30


class Joints:
    """The joints of one robot, each with its `servos` driver; `first` is the channel of the first one."""

    def __init__(self, servos: list, first: int, limits) -> None:
        count = len(servos)
        self.count = count
        self.first = first
        self.mask = (1 << first + count) - (1 << first)
        self.on_mask = 0  # channels of the joints that are driven
        self.commanded_centi = array("h", [LIMP] * count)
        self.measured_centi = array("h", [0] * count)  # see jointsense.py
        self.current_ma = array("H", [0] * count)
        self._servos = servos
        self._limits = limits
        self._back_ms = array("i", [0] * count)  # when it was last told a smaller position than before
        self._fine = array("b", [0] * count)  # beyond what is commanded, in parts of a hundredth
        self._written = array("i", [NONE_TOLD] * count)
        self._start_centi = array("h", [0] * count)
        self._target_centi = array("h", [0] * count)
        self._begin_ms = array("i", [0] * count)
        self._over_ms = array("i", [0] * count)
        self._end_ms = array("i", [0] * count)

    def move(self, mask: int, target_centi: int, over_ms: int, hold_ms: int, now_ms: int) -> None:
        """Bring these joints to a position within that time and hold it for so long, or raise Refused."""
        self._check(mask, target_centi, over_ms, hold_ms)
        for joint in range(self.count):
            if mask >> self.first + joint & 1:
                self._begin(joint, target_centi, over_ms, hold_ms, now_ms)

    def steer(self, joint: int, centi: int, end_ms: int, fine: int = 0) -> None:
        """Have a joint that is driven stand at a position from now on, until then; the caller keeps it in range."""
        self._start_centi[joint] = self._target_centi[joint] = centi
        self._over_ms[joint] = 0
        self._end_ms[joint] = end_ms
        self.commanded_centi[joint] = centi
        self._fine[joint] = fine

    def stand(self) -> None:
        """Have every joint that is driven stand where it is told to be now, up to the end of its order."""
        for joint in range(self.count):
            if self.commanded_centi[joint] != LIMP:
                self.steer(joint, self.commanded_centi[joint], self._end_ms[joint])

    def off(self, mask: int) -> None:
        """Let these joints go limp."""
        for joint in range(self.count):
            if mask >> self.first + joint & 1:
                self.commanded_centi[joint] = LIMP
        self.on_mask &= ~mask
        self.write()

    def all_off(self) -> None:
        """Let every joint go limp."""
        self.off(self.mask)

    def update(self, now_ms: int) -> None:
        """Move on along each order's line; end what has run out."""
        for joint in range(self.count):
            if self.commanded_centi[joint] != LIMP:
                self._follow(joint, now_ms)

    def write(self) -> None:
        """Bring the servos' pulses in line with the orders; a joint that is limp has none."""
        for joint in range(self.count):
            centi, fine = self.commanded_centi[joint], self._fine[joint]
            told = NONE_TOLD if centi == LIMP else centi * FINE + fine
            if told != self._written[joint]:
                self._written[joint] = told
                if told == NONE_TOLD:
                    self._servos[joint].off()
                else:
                    self._servos[joint].pulse(self._limits.width_ns(centi, fine))

    def pushing(self, joint: int, now_ms: int) -> bool:
        """Return whether a joint is driven and not on its way back: not even by a hundredth in a tenth of a second."""
        return self.commanded_centi[joint] != LIMP and now_ms - self._back_ms[joint] > BACK_MS

    def moving(self, now_ms: int) -> bool:
        """Return whether a joint is still on its way."""
        for joint in range(self.count):
            if self.commanded_centi[joint] != LIMP and now_ms - self._begin_ms[joint] < self._over_ms[joint]:
                return True
        return False

    def _check(self, mask: int, target_centi: int, over_ms: int, hold_ms: int) -> None:
        limits = self._limits
        if not mask or mask & ~self.mask:
            raise Refused(codes.UNKNOWN_CHANNEL, 255, mask, self.mask)
        channel = self.first
        while not mask >> channel & 1:
            channel += 1
        if not limits.least_centi <= target_centi <= limits.most_centi:
            limit = limits.least_centi if target_centi < limits.least_centi else limits.most_centi
            raise Refused(codes.RANGE_LIMIT, channel, target_centi, limit)
        if hold_ms > limits.hold_max_ms:
            raise Refused(codes.HOLD_LIMIT, channel, hold_ms, limits.hold_max_ms)
        for joint in range(self.count):
            if mask >> self.first + joint & 1 and self.commanded_centi[joint] != LIMP:
                self._check_speed(joint, target_centi, over_ms)

    def _check_speed(self, joint: int, target_centi: int, over_ms: int) -> None:
        if self._least_ms(self.commanded_centi[joint], target_centi) > over_ms:
            speed = abs(target_centi - self.commanded_centi[joint]) * 1000 // max(1, over_ms)
            raise Refused(codes.SLEW_LIMIT, self.first + joint, speed, self._limits.slew_centi_per_s)

    def _least_ms(self, start_centi: int, target_centi: int) -> int:
        """Return how long a way takes at the slew limit."""
        slew = self._limits.slew_centi_per_s
        return (abs(target_centi - start_centi) * 1000 + slew - 1) // slew

    def _begin(self, joint: int, target_centi: int, over_ms: int, hold_ms: int, now_ms: int) -> None:
        start_centi = self.commanded_centi[joint]
        if start_centi == LIMP:
            limits = self._limits
            start_centi = min(max(self.measured_centi[joint], limits.least_centi), limits.most_centi)
            over_ms = max(over_ms, self._least_ms(start_centi, target_centi))
        self._start_centi[joint] = start_centi
        self._target_centi[joint] = target_centi
        self._begin_ms[joint] = now_ms
        self._over_ms[joint] = over_ms
        self._end_ms[joint] = now_ms + over_ms + hold_ms
        self.commanded_centi[joint] = start_centi
        self._back_ms[joint] = now_ms if target_centi < start_centi else now_ms - BACK_MS - 1
        self._fine[joint] = 0
        self.on_mask |= 1 << self.first + joint

    def _follow(self, joint: int, now_ms: int) -> None:
        if now_ms - self._end_ms[joint] >= 0:
            self.commanded_centi[joint] = LIMP
            self.on_mask &= ~(1 << self.first + joint)
            return
        passed_ms, over_ms = now_ms - self._begin_ms[joint], self._over_ms[joint]
        start_centi, centi = self._start_centi[joint], self._target_centi[joint]
        if passed_ms < over_ms:
            while over_ms > LONG_MS:
                passed_ms, over_ms = passed_ms >> 1, over_ms >> 1
            way = (centi - start_centi) * passed_ms
            centi = start_centi + way // over_ms
            self._fine[joint] = way % over_ms * FINE // over_ms
        elif over_ms:
            self._fine[joint] = 0
        if centi < self.commanded_centi[joint]:
            self._back_ms[joint] = now_ms
        self.commanded_centi[joint] = centi
