"""What a joint's servo says of itself, through a converter: its position by its potentiometer, and its current.

A joint that takes its stall current for long cannot turn as it is told; one that stands elsewhere than it was told for
longer than any lag behind a quick move has no torque; a potentiometer that reads what none of its positions gives is
broken or cut off.
"""

from array import array

from firmware.channels import NONE
from protocol import codes

BESIDE_COUNTS = 205  # beyond either end of the potentiometer's way: no position of it
BROKEN_READS = 10  # that a reading must be impossible before it is believed


class JointSense:
    """Reads the joints of one robot; `channel` and `value` are those of the last fault."""

    def __init__(self, converter, joints, profile) -> None:
        self.channel = 255
        self.value = 0
        self._converter = converter
        self._joints = joints
        self._rows = profile.joints
        self._limits = profile.servo
        self._turn = 0
        self._counts = array("H", [0] * joints.count)
        self._broken = array("B", [0] * joints.count)
        self._strained_ms = array("i", [0] * joints.count)
        self._followed_ms = array("i", [0] * joints.count)  # when it was last where it was told, or limp

    def read(self, now_ms: int) -> None:
        """Read position and current of one joint in its turn."""
        joints, limits, joint = self._joints, self._limits, self._turn
        self._turn = joint + 1 if joint + 1 < joints.count else 0
        row = self._rows[joint]
        is_on = joints.on_mask >> joints.first + joint & 1
        current_ma = self._converter.counts(row.current) * limits.ua_per_count // 1000
        joints.current_ma[joint] = current_ma
        if current_ma < limits.stall_ma or not is_on:
            self._strained_ms[joint] = now_ms
        counts = self._converter.counts(row.position)
        self._counts[joint] = counts
        if limits.low_counts - BESIDE_COUNTS <= counts <= limits.high_counts + BESIDE_COUNTS:
            self._broken[joint] = 0
            joints.measured_centi[joint] = limits.position_centi(counts)
        elif self._broken[joint] < BROKEN_READS:
            self._broken[joint] += 1
        if not is_on or abs(self._off_centi(joint)) <= limits.astray_centi:
            self._followed_ms[joint] = now_ms

    def check(self, now_ms: int) -> int:
        """Return the code of a fault, or 0."""
        joints = self._joints
        joint = self.broken()
        if joint != NONE:
            return self._fault(codes.JOINT, joint, self._counts[joint])
        for joint in range(joints.count):
            if now_ms - self._strained_ms[joint] > self._limits.stall_ms:
                return self._fault(codes.STALL, joint, joints.current_ma[joint])
            if now_ms - self._followed_ms[joint] > self._limits.astray_ms:
                return self._fault(codes.ASTRAY, joint, self._off_centi(joint))
        return 0

    def broken(self) -> int:
        """Return a joint whose position cannot be read, or NONE."""
        for joint in range(self._joints.count):
            if self._broken[joint] >= BROKEN_READS:
                return joint
        return NONE

    def counts(self, channel: int) -> int:
        """Return the last reading of a joint's potentiometer."""
        return self._counts[channel - self._joints.first]

    def _off_centi(self, joint: int) -> int:
        """Return how far a joint that is driven stands from where it was told."""
        return self._joints.measured_centi[joint] - self._joints.commanded_centi[joint]

    def _fault(self, code: int, joint: int, value: int) -> int:
        self.channel = self._joints.first + joint
        self.value = value
        return code
