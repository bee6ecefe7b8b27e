"""The closed loop that turns a gripped object to an angle: both joints swing together, their grip is left alone.

With the grip phi and the swing u the joints stand at u + phi and u - phi. The object turns against the swing, so
that du/dt = -gain (target - angle); it is integrated from each new frame of the camera to the next. The swing is
clamped to its own limit and to the joints' range; it stands still while no frame comes, and when none has come for too
long the loop ends and the joints hold where they are.

Integers below 2**30: the swing is kept in thousandths of a hundredth of a degree.
"""

from firmware.channels import Refused
from protocol import codes

FINE = 1000  # of a centidegree
ERROR_MAX_CENTIDEG = 3000
FRAME_MAX_MS = 100  # a frame counts for no longer than that,
FRAME_MS = 10  # and turns the joints by no more than they may turn from one frame to the next


class Orient:
    """The loop of one robot, over its first two joints."""

    def __init__(self, joints, camera, limits, servo) -> None:
        self.active = False
        self.mask = 0b11 << joints.first  # of the joints that it turns
        self.lost = False  # it ended for want of the camera, since the core last looked
        self._joints = joints
        self._camera = camera
        self._servo = servo
        self._gain = limits.gain_permille_per_s
        self._swing_max = limits.swing_max_centideg
        self._target_centideg = 0
        self._grip_centideg = 0
        self._fine = 0
        self._frame_ms = 0
        self._until_ms = 0
        self._end_ms = 0

    def begin(self, target_centideg: int, time_ms: int, hold_ms: int, now_ms: int) -> None:
        """Regulate to that angle for so long, then hold; or raise Refused."""
        joints, commanded = self._joints, self._joints.commanded_centi
        if not self._camera.known:
            raise Refused(codes.NO_CAMERA)
        if hold_ms > self._servo.hold_max_ms:
            raise Refused(codes.HOLD_LIMIT, joints.first, hold_ms, self._servo.hold_max_ms)
        for joint in (0, 1):
            if not joints.on_mask >> joints.first + joint & 1:
                raise Refused(codes.NOT_HELD, joints.first + joint)
        swing_centideg = (commanded[0] + commanded[1]) // 2
        if abs(swing_centideg) > self._swing_max:
            limit = self._swing_max if swing_centideg > 0 else -self._swing_max
            raise Refused(codes.RANGE_LIMIT, joints.first, swing_centideg, limit)
        self._target_centideg = target_centideg
        self._grip_centideg = (commanded[0] - commanded[1]) // 2
        self._fine = swing_centideg * FINE
        self._frame_ms = now_ms
        self._until_ms = now_ms + time_ms
        self._end_ms = self._until_ms + hold_ms
        self.active = True
        self._steer()

    def cancel(self) -> None:
        """Regulate no more; the joints hold where they are, up to the end of the order."""
        self.active = False

    def busy(self, now_ms: int) -> bool:
        """Return whether its time is not over yet."""
        return self.active and now_ms - self._until_ms < 0

    def update(self, now_ms: int) -> None:
        """Take a new frame into account; end when it is time, or when there is no camera any more."""
        if not self._camera.known:
            self.active = False
            self.lost = True
        elif now_ms - self._until_ms >= 0:
            self.active = False
        elif self._camera.fresh:
            self._integrate(now_ms)
            self._steer()

    def _integrate(self, now_ms: int) -> None:
        passed_ms = min(now_ms - self._frame_ms, FRAME_MAX_MS)
        self._frame_ms = now_ms
        error = self._target_centideg - self._camera.centideg
        error = max(-ERROR_MAX_CENTIDEG, min(ERROR_MAX_CENTIDEG, error))
        change = error * passed_ms // 10 * self._gain // 100
        most = self._servo.slew_centi_per_s * min(passed_ms, FRAME_MS)
        self._fine -= max(-most, min(most, change))

    def _steer(self) -> None:
        servo, grip, reach = self._servo, self._grip_centideg, self._swing_max
        most = min(reach, servo.most_centi - abs(grip)) * FINE
        least = max(-reach, servo.least_centi + abs(grip)) * FINE
        self._fine = max(least, min(most, self._fine))
        swing = self._fine // FINE
        self._joints.steer(0, swing + grip, self._end_ms)
        self._joints.steer(1, swing - grip, self._end_ms)
