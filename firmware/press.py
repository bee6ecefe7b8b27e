"""The closed loop of a press: the axis goes as fast as the force is off, plus what has proved needed to keep it.

The wanted force follows a straight line to its target and stays there. With the error e the axis goes at the speed
gain (e + reset x integral of e), smoothed: what is pressed answers a jerk like a dashpot, at once. The integral is
there because a block that creeps takes a speed to bear a constant force; it counts only while something is touched,
and while the axis can follow. Before it touches, the axis approaches slowly. It keeps to its slew limit and its range;
where there is nothing to press on it stands at the end of its range.

What is harder than the gain is for makes the force swing about what is wanted. Each swing too many halves gain and
approach, until it does not; they are as in the profile again for an order that begins in the air.

Integers below 2**30: the position is kept in nanometres, the speed in micrometres a second.
"""

from firmware.channels import Refused
from firmware.joints import FINE
from protocol import codes

NM_PER_CENTI = 10_000
RATE_MAX_UM_PER_S = 50_000
ERROR_MAX_MN = 20_000
PASSED_MAX_MS = 20  # a step that came late counts for no longer
LONG_MS = 10_000  # a longer way to the target is reckoned in coarser time
SWING_MN = 800  # a force that is less off does not swing: it is noise, or the dead band of a servo on what is hard
SWINGS_MAX = 2  # in a row; the way to the target is the first
HALVINGS_MAX = 7


class Press:
    """The loop of one robot, over its only joint."""

    def __init__(self, joints, load, limits, servo, most_mn: int) -> None:
        self.active = False
        self.mask = 1 << joints.first
        self._joints = joints
        self._load = load
        self._limits = limits
        self._servo = servo
        self._most_mn = most_mn
        self._most_um_per_s = min(servo.slew_centi_per_s * 10, RATE_MAX_UM_PER_S)
        self._start_mn = self._target_mn = 0
        self._over_ms = 0
        self._rate_um_per_s = self._drift_nm_per_s = 0
        self._nm = 0
        self._begin_ms = self._seen_ms = self._until_ms = self._end_ms = 0
        self._halvings = 0
        self._swings = 0
        self._most_off_mn = 0  # since it was off to the other side last
        self._is_below = True

    def begin(self, target_mn: int, over_ms: int, time_ms: int, hold_ms: int, now_ms: int) -> None:
        """Regulate the force for so long, then hold the axis; or raise Refused. A limp one begins where it stands."""
        joints, servo = self._joints, self._servo
        if time_ms > servo.hold_max_ms or hold_ms > servo.hold_max_ms:
            raise Refused(codes.HOLD_LIMIT, joints.first, max(time_ms, hold_ms), servo.hold_max_ms)
        if target_mn > self._most_mn:
            raise Refused(codes.FORCE_LIMIT, joints.first, target_mn, self._most_mn)
        is_on = joints.on_mask & self.mask
        if not is_on or abs(self._load.force_mn) <= self._limits.touch_mn:
            self._halvings = 0
        if not is_on:
            here_centi = min(max(joints.measured_centi[0], servo.least_centi), servo.most_centi)
            joints.move(self.mask, here_centi, 0, hold_ms, now_ms)
        self._start_mn = min(max(self._load.force_mn, 0), self._most_mn)
        self._target_mn = target_mn
        self._over_ms = over_ms
        self._rate_um_per_s = self._drift_nm_per_s = 0
        self._nm = joints.commanded_centi[0] * NM_PER_CENTI
        self._begin_ms = self._seen_ms = now_ms
        self._swings = self._most_off_mn = 0
        self._is_below = True
        self._until_ms = now_ms + time_ms
        self._end_ms = self._until_ms + hold_ms
        self.active = True
        joints.steer(0, joints.commanded_centi[0], self._end_ms)

    def cancel(self) -> None:
        """Regulate no more; the axis holds where it is, up to the end of the order."""
        self.active = False

    def busy(self, now_ms: int) -> bool:
        """Return whether its time is not over yet."""
        return self.active and now_ms - self._until_ms < 0

    def update(self, now_ms: int) -> None:
        """Move the axis by what the force is off; end when it is time."""
        if now_ms - self._until_ms >= 0:
            self.active = False
            return
        passed_ms = min(max(now_ms - self._seen_ms, 0), PASSED_MAX_MS)
        self._seen_ms = now_ms
        wanted_mn = self._wanted_mn(now_ms)
        self._watch(wanted_mn - self._load.force_mn)
        servo, rate = self._servo, self._rate(wanted_mn, passed_ms)
        self._rate_um_per_s += (rate - self._rate_um_per_s) * passed_ms // self._limits.smooth_ms
        least, most = servo.least_centi * NM_PER_CENTI, servo.most_centi * NM_PER_CENTI
        self._nm = max(least, min(most, self._nm + self._rate_um_per_s * passed_ms))
        centi = self._nm // NM_PER_CENTI
        self._joints.steer(0, centi, self._end_ms, (self._nm - centi * NM_PER_CENTI) * FINE // NM_PER_CENTI)

    def _wanted_mn(self, now_ms: int) -> int:
        passed_ms, over_ms = now_ms - self._begin_ms, self._over_ms
        if passed_ms >= over_ms:
            return self._target_mn
        while over_ms > LONG_MS:
            passed_ms, over_ms = passed_ms >> 1, over_ms >> 1
        return self._start_mn + (self._target_mn - self._start_mn) * max(passed_ms, 0) // over_ms

    def _watch(self, off_mn: int) -> None:
        """Halve the gain when the force has swung too often from one side of what is wanted to the other."""
        if (off_mn > 0) != self._is_below:
            self._swings = self._swings + 1 if self._most_off_mn > SWING_MN else 0
            self._most_off_mn, self._is_below = 0, off_mn > 0
            if self._swings > SWINGS_MAX:
                self._swings = 1
                self._halvings = min(self._halvings + 1, HALVINGS_MAX)
        self._most_off_mn = max(self._most_off_mn, abs(off_mn))

    def _rate(self, wanted_mn: int, passed_ms: int) -> int:
        """Return how fast the axis is to go down [um/s]."""
        limits, most = self._limits, self._most_um_per_s
        force_mn = self._load.force_mn
        error_mn = max(-ERROR_MAX_MN, min(ERROR_MAX_MN, wanted_mn - force_mn))
        rate = error_mn * limits.gain_um_per_s_per_n // 1000 >> self._halvings
        if abs(force_mn) <= limits.touch_mn:
            self._drift_nm_per_s = 0
            return max(-most, min(most, limits.approach_um_per_s >> self._halvings, rate))
        rate = max(-most, min(most, rate))
        wished = rate + self._drift_nm_per_s // 1000
        if abs(wished) < most or (wished < 0) != (rate < 0):  # else the axis is late, not the block creeping
            self._drift_nm_per_s += rate * limits.reset_permille_per_s // 1000 * passed_ms
        return max(-most, min(most, wished))
