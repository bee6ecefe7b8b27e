"""The angle of the object that a camera sees: the newest frame, whether it is to be trusted, and when it was lost."""

from protocol.variables import UNKNOWN_CENTI

EVERY = 2  # control steps between two looks: as often as it has a new frame
AGAIN = 10  # looks that are left out when it does not answer and has not for long


class Camera:
    """What `driver` sees; `known`: the angle is at most `stale_ms` old; `fresh`: it came in this control step."""

    def __init__(self, driver, stale_ms: int) -> None:
        self.known = False
        self.fresh = False
        self.centideg = 0
        self.seen_ms = 0  # when it was last seen
        self._driver = driver
        self._stale_ms = stale_ms
        self._pause = 0

    def look(self, now_ms: int) -> None:
        """Take a new frame, if there is one."""
        self.fresh = False
        self._pause -= 1
        if self._pause <= 0:
            self._pause = EVERY
            self._take(now_ms)
        if self.known and now_ms - self.seen_ms > self._stale_ms:
            self.known = False

    def object_centideg(self) -> int:
        """Return the angle, or UNKNOWN_CENTI."""
        return self.centideg if self.known else UNKNOWN_CENTI

    def _take(self, now_ms: int) -> None:
        try:
            is_new = self._driver.read()
        except OSError:
            if not self.known:
                self._pause = AGAIN * EVERY  # else its silence would take the time of every step
            return
        if is_new and self._driver.seen:
            self.fresh = self.known = True
            self.centideg = self._driver.centideg
            self.seen_ms = now_ms
