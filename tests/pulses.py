"""Ears on the pulses of one servo: when it was driven, and whereto, whatever its own dead band makes of them."""

from hil_sim.bench import Bench
from host.limits import ServoLimits

LIVE_US = (400.0, 2600.0)  # widths that a servo takes for a pulse


class Pulses:
    """The pulses on a pin of a bench, from its first moment on; they count whether there is power or not."""

    def __init__(self, bench: Bench, pin: int) -> None:
        self.history: list[tuple[int, float]] = []  # from when on it was driven: 1.0, or not: 0.0
        self.widths: list[tuple[int, float]] = []  # [us], while it was driven
        self.found: dict[int, float] = {}  # where the joint stood when it began to be driven, by the time
        self._bench = bench
        self._servo = bench.board.servos[pin]
        self._width_us = 0.0
        pulses = bench.board.pulses
        watcher = pulses._watchers[pin]

        def pulsed(from_us: int, width_us: float, period_us: float) -> None:
            watcher(from_us, width_us, period_us)
            self._width_us = width_us
            self.note()

        pulses.watch(pin, pulsed)

    def note(self) -> None:
        """Take down what holds from now on."""
        now_us = self._bench.clock.now_us
        live = LIVE_US[0] <= self._width_us <= LIVE_US[1]
        was_live = bool(self.history and self.history[-1][1])
        if live != was_live:
            self.history.append((now_us, float(live)))
        if live and not was_live:
            self._find(now_us)
        if live and not (was_live and self.widths[-1][1] == self._width_us):
            self.widths.append((now_us, self._width_us))

    def _find(self, now_us: int) -> None:
        joints = self._bench._joints
        if joints is not None and self._servo in joints._servos:
            self.found[now_us] = float(self._bench.plant.joint_position[joints._servos.index(self._servo)])

    def positions(self, limits: ServoLimits) -> list[tuple[int, float]]:
        """Return from when on it was told which position, in the unit of the limits."""
        middle_us = (limits.low_us + limits.high_us) / 2
        per_us = limits.span_centi / 100 / (limits.high_us - limits.low_us)
        return [(time_us, (width_us - middle_us) * per_us) for time_us, width_us in self.widths]
