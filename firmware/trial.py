"""The first seconds of a program: it tells when it has been healthy for a while, or a new one gives itself up.

Healthy is a core that has not tripped, or only by what a program cannot help: the reset that started it, an open
emergency stop, a stop by the host. It is told while no coil can be on, because that may write the flash.
"""

from protocol import codes, messages

HEALTHY_MS, GIVEN_UP_MS = 5000, 10_000
NOT_ITS_FAULT = (codes.WATCHDOG, codes.ESTOP, codes.STOP)


class Trial:
    """One start of a program; `settled` is called once, and returns whether it changed the watchdog's time."""

    def __init__(self, is_new: bool, settled) -> None:
        self._is_new = is_new
        self._settled = settled
        self._ill_ms = 0  # when it was last seen ill

    def over(self, now_ms: int, core) -> bool:
        """Look at the core once each step; return whether the program is to be given up."""
        if self._settled is None:
            return False
        if core.state == messages.TRIPPED and core.code not in NOT_ITS_FAULT:
            self._ill_ms = now_ms
            return self._is_new and now_ms >= GIVEN_UP_MS
        if now_ms - self._ill_ms >= HEALTHY_MS and core.at_rest():
            if self._settled():
                core.board.watch()
            self._settled = None
        return False
