"""What the firmware's modules need of the processor they run on, whatever world provides it."""

from typing import Protocol

from hil_sim.board import Board
from hil_sim.clock import Clock


class Processor(Protocol):
    """What the modules need of the world that runs them."""

    board: Board
    clock: Clock
    cause: int

    def spend(self, cost_us: int) -> None:
        """Let virtual time pass."""

    def reset(self) -> None:
        """Reset the processor; does not return."""

    def lose_power(self) -> None:
        """Take the board's supply away for an instant; does not return."""

    def watch(self, timeout_us: int) -> None:
        """Reset the processor unless this is called again within `timeout_us`."""

    def heed(self, character: int) -> None:
        """Let that character of the console raise KeyboardInterrupt; -1: none does."""

    def ticks_us(self) -> int:
        """Return the time since reset."""
