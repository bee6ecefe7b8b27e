"""The first minutes of a new program: it confirms itself once it has been healthy for a while, or gives itself up.

Healthy is a core that has not tripped, or only by what a program cannot help: the reset that started it, an open
emergency stop, a stop by the host. The slot is confirmed while no coil can be on, because that writes the flash.
"""

from protocol import codes, messages

HEALTHY_MS, GIVEN_UP_MS = 5000, 10_000
NOT_ITS_FAULT = (codes.WATCHDOG, codes.ESTOP, codes.STOP)


class Trial:
    """One start of a program; `confirm` keeps its slot, and is None when that was done before."""

    def __init__(self, confirm) -> None:
        self._confirm = confirm
        self._ill_ms = 0  # when it was last seen ill

    def over(self, now_ms: int, core) -> bool:
        """Look at the core once each step; return whether the program is to be given up."""
        if self._confirm is None:
            return False
        if core.state == messages.TRIPPED and core.code not in NOT_ITS_FAULT:
            self._ill_ms = now_ms
            return now_ms >= GIVEN_UP_MS
        if now_ms - self._ill_ms >= HEALTHY_MS and core.state in (messages.IDLE, messages.TRIPPED):
            self._confirm()
            self._confirm = None
            core.board.watch()
        return False
