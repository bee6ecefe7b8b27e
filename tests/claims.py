"""What an order allows: coils that may be on from one moment to another, some of them only for so long."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from protocol import program

LIMP_START_US = 200_000  # by which an order may last longer for a joint that was limp: its slew limit from end to end


@dataclass
class Claim:
    """Coils that may be on from `from_us` to before `until_us`, each for at most its `budget_us`."""

    mask: int
    from_us: int
    until_us: float
    budget_us: dict[int, float] = field(default_factory=dict)  # of single channels; none: unlimited
    of_program: bool = False

    @property
    def limited(self) -> bool:
        """Whether coils may use it up."""
        return bool(self.budget_us)

    def end(self, now_us: float) -> None:
        """Allow nothing from then on."""
        self.until_us = min(self.until_us, now_us)


def budgets(code: bytes, hold_ms: int = 0) -> Iterator[tuple[int, float]]:
    """Yield for each channel how long a program can have it on [us], all its repeats included.

    Joints hold for `hold_ms` after each order of a program.
    """
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
        elif name in ("move", "orient"):
            for channel in range(32):
                if name == "orient" or arguments[0] >> channel & 1:
                    lasts_us = 1000.0 * (arguments[-1] + hold_ms) + LIMP_START_US
                    total_us[channel] = total_us.get(channel, 0.0) + lasts_us * times[-1]
    yield from total_us.items()
