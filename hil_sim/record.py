"""What was done to one coil, for tests and reports: when it was on, how long, how hot, with how much energy."""

from dataclasses import dataclass, field


@dataclass
class CoilRecord:
    """One coil's history. `duty` is what heats it: 0 while the supply or the outputs are off."""

    label: str
    duty: float = 0.0
    history: list[tuple[int, float]] = field(default_factory=list)  # time_us, duty from then on
    on_at_us: int | None = None  # last time it was switched on
    off_at_us: int | None = None  # last time it was switched off
    peak_degc: float = -273.15
    energy_j: float = 0.0
    _on_us: int = 0

    def switch(self, duty: float, now_us: int) -> None:
        """Note a new duty."""
        if duty == self.duty:
            return
        if duty and not self.duty:
            self.on_at_us = now_us
        elif self.duty and not duty:
            self._on_us = self.on_us(now_us)
            self.off_at_us = now_us
        self.duty = duty
        self.history.append((now_us, duty))

    def on_us(self, now_us: int) -> int:
        """Return how long it has been on in all, at whatever duty."""
        running_us = now_us - self.on_at_us if self.duty and self.on_at_us is not None else 0
        return self._on_us + running_us
