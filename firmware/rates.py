"""How fast the serial line runs: as fast as the host does, out of four rates.

A robot begins at 115200 baud. Bytes that come without one intact frame among them are those of a host at another rate:
the robot tries the next one, in turn with the last good one, and stays where it first hears an intact frame. A rate at
which nothing more comes is left after a second for the last good one, so that noise on a quiet line costs no more. The
rate stays as it is while a coil is on or may be, and for two seconds after the last intact frame.

    rates.look(now_ms, core.intact_ms == now_ms, core.at_rest())
"""

RATES = (115_200, 921_600, 460_800, 230_400)
NOISE_BYTES = 8
QUIET_MS = 2000  # since the last intact frame: a host that is there says something more often
TRY_MS = 1000  # four times as long as a host waits before it says hello again
FRAME_MS = 30  # longer than the longest frame takes at the slowest rate


class Rates:
    """The rate of `board`, which counts in `noise` the bytes that came since it was last set to 0."""

    def __init__(self, board) -> None:
        self.trying = False  # a rate at which no intact frame has come yet
        self._board = board
        self._home = self._other = 0  # places in RATES: the last good rate, the one that was tried last
        self._tuned_ms = 0
        self._intact_ms = -1  # when the last intact frame came, -1: never
        self._noisy_ms = -1  # when bytes began to come of which none made sense yet, -1: none did

    def look(self, now_ms: int, is_intact: bool, at_rest: bool) -> None:
        """Change the rate if it is time; `is_intact`: a frame of what has just arrived."""
        if is_intact:
            self._intact_ms = now_ms
            if self.trying:
                self._home, self.trying = self._other, False
            self._hush()
        elif self.trying and now_ms - self._tuned_ms >= TRY_MS:
            self._tune(self._home, now_ms)
        elif self._board.noise >= NOISE_BYTES:
            self._wonder(now_ms, at_rest)

    def _wonder(self, now_ms: int, at_rest: bool) -> None:
        """Change the rate if nothing intact has come of the noise for longer than a frame takes."""
        if not at_rest or (self._intact_ms >= 0 and now_ms - self._intact_ms < QUIET_MS):
            self._hush()
        elif self._noisy_ms < 0:
            self._noisy_ms = now_ms
        elif now_ms - self._noisy_ms >= FRAME_MS:
            self._tune(self._home if self.trying else self._next(), now_ms)

    def _hush(self) -> None:
        """Take what came so far as explained."""
        self._board.noise = 0
        self._noisy_ms = -1

    def _next(self) -> int:
        """Return the place of the rate to try now."""
        self._other = (self._other + 1) % len(RATES)
        if self._other == self._home:
            self._other = (self._other + 1) % len(RATES)
        return self._other

    def _tune(self, place: int, now_ms: int) -> None:
        self._board.tune(RATES[place])
        self._hush()
        self.trying = place != self._home
        self._tuned_ms = now_ms
