"""Everything of a robot that drives joints: their orders, what is measured of them, and the closed loops over that.

Loaded only where the profile names joints: a robot of coils has that memory for itself.

    limbs = Limbs(board, profile)
    limbs.look(now_ms)
    code = limbs.drive(now_ms, powered)
"""

from firmware.camera import Camera
from firmware.channels import NONE, Refused
from firmware.joints import Joints
from firmware.jointsense import JointSense
from firmware.orient import Orient
from firmware.selftest import NO_JOINT
from protocol import codes

SLACKEN_MS = 150  # for which a servo holds after its last pulse. ASSUMED: 100 ms, and the period that has begun


class Limbs:
    """The joints of one robot and what moves them; `channel` and `value` are those of the last fault."""

    def __init__(self, board, profile) -> None:
        servos = [board.servo(joint.pin, profile.servo.pulse_hz) for joint in profile.joints]
        self.joints = Joints(servos, len(profile.coils), profile.servo)
        converter = board.adc()
        self.sense = JointSense(converter, self.joints, profile)
        self.load = self.cells = self.press = None
        if profile.load or profile.cells:
            self._feel(converter, profile)
        self.camera = Camera(board.camera(profile.camera.address), profile.camera.stale_ms) if profile.camera else None
        self.orient = None
        if self.camera and profile.orient:
            self.orient = Orient(self.joints, self.camera, profile.orient, profile.servo)
        self.channel = NONE
        self.value = 0
        self._hold_max_ms = profile.servo.hold_max_ms
        self._driven_ms = -SLACKEN_MS  # when a joint was driven last
        self._told_ms = 0  # for when the joints were told last where to stand

    def look(self, now_ms: int) -> None:
        """Read what is measured."""
        self.sense.read(now_ms)
        if self.load:
            self.load.read(self.joints.pushing(0, now_ms))
        if self.cells:
            self.cells.read()
        if self.camera:
            self.camera.look(now_ms)

    def drive(self, now_ms: int, powered: bool) -> int:
        """Bring every joint up to its order; return the code of a fault, or 0."""
        if self.orient and self.orient.active:
            self.orient.update(now_ms)
        if self.press and self.press.active:
            self.press.update(now_ms)
        self.joints.update(now_ms)
        self.joints.write()
        self._told_ms = now_ms
        if self.joints.on_mask:
            self._driven_ms = now_ms
        return self._check(now_ms) if powered else 0

    def move(self, mask: int, target_centi: int, over_ms: int, hold_ms: int, now_ms: int) -> None:
        """Move joints as ordered, or raise Refused; a loop that drove them ends."""
        now_ms = self._reached(now_ms)
        self.joints.move(mask, target_centi, over_ms, hold_ms, now_ms)
        if self.orient and mask & self.orient.mask:
            self.orient.cancel()
        if self.press and mask & self.press.mask:
            self.press.cancel()

    def turn(self, target_centideg: int, time_ms: int, hold_ms: int, now_ms: int) -> None:
        """Regulate the object's angle, or raise Refused."""
        if not self.orient:
            raise Refused(codes.NO_CAMERA)
        now_ms = self._reached(now_ms)
        self.orient.begin(target_centideg, time_ms, hold_ms, now_ms)

    def push(self, target_mn: int, over_ms: int, time_ms: int, hold_ms: int, now_ms: int) -> None:
        """Regulate the force of the press, or raise Refused."""
        if not self.press:
            raise Refused(codes.NO_LOAD_CELL)
        now_ms = self._reached(now_ms)
        self.press.begin(target_mn, over_ms, time_ms, hold_ms, now_ms)

    def stand(self) -> None:
        """Leave every joint that is driven where it is, up to the end of its order."""
        self._cancel()
        self.joints.stand()

    def play_move(self, mask: int, target_centi: int, over_ms: int, now_ms: int) -> None:
        """Move joints as a program orders: they hold as long as any order may."""
        self.move(mask, target_centi, over_ms, self._hold_max_ms, now_ms)

    def play_turn(self, target_centideg: int, time_ms: int, now_ms: int) -> None:
        """Regulate as a program orders."""
        self.turn(target_centideg, time_ms, self._hold_max_ms, now_ms)

    def play_push(self, target_mn: int, over_ms: int, time_ms: int, now_ms: int) -> None:
        """Press as a program orders."""
        self.push(target_mn, over_ms, time_ms, self._hold_max_ms, now_ms)

    def sees(self) -> bool:
        """Return whether the camera knows how the object lies."""
        return self.camera is not None and self.camera.known

    def busy(self, now_ms: int) -> bool:
        """Return whether an order is still being carried out; holding is none."""
        if self.joints.moving(now_ms) or (self.press is not None and self.press.busy(now_ms)):
            return True
        return self.orient is not None and self.orient.busy(now_ms)

    def may_draw(self, now_ms: int) -> bool:
        """Return whether a servo may take current: a joint is driven, or was a moment ago."""
        return now_ms - self._driven_ms < SLACKEN_MS

    def all_off(self) -> None:
        """Let every joint go limp."""
        self._cancel()
        self.joints.all_off()

    def broken_channel(self) -> int:
        """Return the channel of a joint whose position cannot be read, or NO_JOINT."""
        joint = self.sense.broken()
        return NO_JOINT if joint == NONE else self.joints.first + joint

    def lost(self) -> bool:
        """Return, once, whether the loop has ended because the camera was lost."""
        if self.orient is None or not self.orient.lost:
            return False
        self.orient.lost = False
        return True

    def _feel(self, converter, profile) -> None:
        """Set up what measures forces, and the loop over it; loaded only here, as others do without."""
        from firmware.load import Cells, Load  # noqa: PLC0415
        from firmware.press import Press  # noqa: PLC0415

        self.load = Load(converter, profile.load) if profile.load else None
        self.cells = Cells(converter, profile.cells, profile.cell_full_pa) if profile.cells else None
        if profile.press:
            self.press = Press(self.joints, self.load, profile.press, profile.servo, profile.load.most_mn)

    def _check(self, now_ms: int) -> int:
        """Return the code of a fault, and keep what it is about, or 0."""
        sense, load = self.sense, self.load
        code = sense.check(now_ms)
        self.channel, self.value = sense.channel, sense.value
        if load and not code:
            code = load.check()
            self.channel = self.joints.first
            self.value = load.counts if code == codes.LOAD_CELL else load.force_mn
        return code

    def _cancel(self) -> None:
        """End the loops."""
        if self.orient:
            self.orient.cancel()
        if self.press:
            self.press.cancel()

    def _reached(self, now_ms: int) -> int:
        """Bring the joints to where they have come to by then, from where an order sets out; return that time.

        No joint goes back: a program that is behind its time has its orders begin where the joints were told last.
        """
        if now_ms - self._told_ms < 0:
            now_ms = self._told_ms
        self.joints.update(now_ms)
        return now_ms
