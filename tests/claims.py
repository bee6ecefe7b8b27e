"""What an order allows: coils that may be on from one moment to another, some of them only for so long."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from host.limits import ServoLimits
from protocol import program

LIMP_SLACK_US = 50_000


@dataclass
class Claim:
    """Coils that may be on from `from_us` to before `until_us`, each for at most its `budget_us`."""

    mask: int
    from_us: int
    until_us: float
    budget_us: dict[int, float] = field(default_factory=dict)  # of single channels; none: unlimited
    of_program: bool = False
    outlived: bool = False  # the lease, by another program, when this one was ordered

    @property
    def limited(self) -> bool:
        """Whether coils may use it up."""
        return bool(self.budget_us)

    def end(self, now_us: float) -> None:
        """Allow nothing from then on."""
        self.until_us = min(self.until_us, now_us)


def limp_start_us(servo: ServoLimits | None) -> float:
    """Return by how much an order may last longer for a joint that was limp: its slew limit from end to end."""
    if servo is None:
        return 0.0
    return 1e6 * (servo.most_centi - servo.least_centi) / servo.slew_centi_per_s + LIMP_SLACK_US


def budgets(code: bytes, servo: ServoLimits | None = None) -> Iterator[tuple[int, float]]:
    """Yield for each channel how long a program can have it on [us], all its repeats included.

    Joints hold for as long as they may after each order of a program.
    """
    hold_ms = servo.hold_max_ms if servo else 0
    times, total_us = [1], {}
    for _, name, *arguments in program.disassemble(code):
        if name == "repeat":
            times.append(times[-1] * arguments[0])
        elif name == "next":
            times.pop()
        elif name in ("fire", "ramp"):
            for channel in range(32):
                if arguments[0] >> channel & 1:
                    total_us[channel] = total_us.get(channel, 0.0) + 1000.0 * arguments[2] * times[-1]
        elif name == "aimed":
            for channel in range(32):
                total_us[channel] = total_us.get(channel, 0.0) + 1000.0 * arguments[2] * times[-1]
        elif name in ("move", "orient", "press"):
            for channel in range(32):
                if name != "move" or arguments[0] >> channel & 1:
                    lasts_us = 1000.0 * (arguments[-1] + hold_ms) + limp_start_us(servo)
                    total_us[channel] = total_us.get(channel, 0.0) + lasts_us * times[-1]
    yield from total_us.items()
