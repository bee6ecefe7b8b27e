"""What was done to one coil or joint, for tests and reports: when it was on or driven, how long, how hot, how far."""

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


@dataclass
class JointRecord:
    """One joint's history. `position` is where its servo is told to go, in its unit: None while it is limp."""

    label: str
    position: float | None = None
    history: list[tuple[int, float | None]] = field(default_factory=list)  # time_us, command from then on
    driven_at_us: int | None = None  # last time it was driven after it had been limp
    peak_a: float = 0.0
    _driven_us: int = 0

    def command(self, position: float | None, now_us: int) -> None:
        """Note a new command."""
        if position == self.position:
            return
        if self.position is None:
            self.driven_at_us = now_us
        elif position is None:
            self._driven_us = self.driven_us(now_us)
        self.position = position
        self.history.append((now_us, position))

    def driven_us(self, now_us: int) -> int:
        """Return how long it has been driven in all."""
        running_us = 0 if self.position is None or self.driven_at_us is None else now_us - self.driven_at_us
        return self._driven_us + running_us
