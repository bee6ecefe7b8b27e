"""A processor on the bench: its lives from reset to reset, its watchdog, and what an interpreter runs on it.

The interpreter of a life runs in a greenlet. Time that it spends passes at once while nothing else is due; otherwise it
queues behind that in the bench's clock. A reset ends the life and begins another; nothing firmware does can catch it.

    world = World(board, image, cpython.execute)  # or micropython.execute
    world.power_on()
    board.clock.run_until(1_000_000)
"""

import traceback
from collections.abc import Callable
from dataclasses import dataclass

from greenlet import GreenletExit, getcurrent, greenlet

from hil_sim.board import Board
from hil_sim.clock import Event
from hil_sim.worlds.costs import BOOT_US
from hil_sim.worlds.image import Image
from hil_sim.worlds.machine import PWRON_RESET, WDT_RESET

CTRL_C = 3
_PROTESTS_MAX = 100


@dataclass(frozen=True)
class Crash:
    """An exception that escaped the firmware, or its end where it should have run for ever."""

    time_us: int
    error: str
    trace: str


class Crashed(Exception):
    """What an interpreter in a process of its own says of an exception that escaped the firmware."""

    def __init__(self, error: str, trace: str = "") -> None:
        super().__init__(error)
        self.error = error
        self.trace = trace


class Interrupted(BaseException):
    """The board's KeyboardInterrupt: Ctrl-C on its console, not on that of the bench."""


class World:
    """A processor with its flash. `crashes` lists what escaped the firmware, `console` what it printed."""

    def __init__(self, board: Board, image: Image, execute: "Interpreter", ticks_start_us: int = 0) -> None:
        self.crashes: list[Crash] = []
        self.console: list[str] = []
        self.resets = 0
        self.image = image
        self.board = board
        self.execute = execute
        self._ticks_start_us = ticks_start_us
        self._life: Life | None = None

    @property
    def running(self) -> bool:
        """Whether the firmware executes: not while it hangs, has crashed or ended."""
        return self._life is not None and self._life.running

    def power_on(self) -> None:
        """Give the board its supply, or take it away for an instant and give it back."""
        self.board.power_cycle()
        self._begin(PWRON_RESET, self._ticks_start_us)

    def power_off(self) -> None:
        """Take the board's supply away: its pins rest, its chips forget, nothing executes."""
        self.close()
        self.board.power_cycle()
        self.board.reset_processor(PWRON_RESET)

    def reset(self) -> None:
        """Reset the processor as the watchdog, or `machine.reset`, does."""
        self.resets += 1
        self._begin(WDT_RESET, 0)

    def hang(self) -> None:
        """Stop executing: as when the firmware is caught in a loop. The watchdog goes on."""
        if self._life is not None:
            self._life.pause()

    def interrupt(self) -> None:
        """Press Ctrl-C on the board's console."""
        if self._life is not None:
            self._life.interrupt()

    def close(self) -> None:
        """End the firmware for good."""
        if self._life is not None:
            self._life.end()
            self._life = None

    def _begin(self, cause: int, ticks_start_us: int) -> None:
        self.close()
        self.board.reset_processor(cause)
        self._life = Life(self, cause, ticks_start_us)


class Life:
    """The processor from one reset to the next."""

    def __init__(self, world: World, cause: int, ticks_start_us: int) -> None:
        self.board = world.board
        self.clock = world.board.clock
        self.cause = cause
        self.image = world.image
        self.spend: Callable[[int], None] = self._spend
        self._world = world
        self._ticks_zero_us = self.clock.now_us - ticks_start_us
        self._greenlet = greenlet(self._run)
        self._resume_at: Event | None = self.clock.at(self.clock.now_us + BOOT_US, self._resume)
        self._bite_at: Event | None = None
        self._bite_us = 0
        self._protests = 0
        self._heeds = True  # Ctrl-C
        self._ended = False

    @property
    def running(self) -> bool:
        """Whether it has something left to execute and will."""
        return self._resume_at is not None and not self._greenlet.dead

    def ticks_us(self) -> int:
        """Return the time since reset."""
        return self.clock.now_us - self._ticks_zero_us

    def watch(self, timeout_us: int) -> None:
        """Start the watchdog, or start its time-out anew, which may be shorter than the last."""
        bite_us = self.clock.now_us + timeout_us
        if self._bite_at is not None and bite_us < self._bite_us:
            self._bite_at.cancel()
            self._bite_at = None
        self._bite_us = bite_us
        if self._bite_at is None:
            self._bite_at = self.clock.at(bite_us, self._bite)

    def reset(self) -> None:
        """Reset the processor from within; control never comes back to the firmware."""
        self._resume_at = self.clock.at(self.clock.now_us, self._world.reset)
        self._greenlet.parent.switch()

    def lose_power(self) -> None:
        """Take the board's supply away for an instant; control never comes back to the firmware."""
        self._resume_at = self.clock.at(self.clock.now_us, self._world.power_on)
        self._greenlet.parent.switch()

    def heed(self, character: int) -> None:
        """Let that character of the console raise KeyboardInterrupt; -1: none does."""
        self._heeds = character == CTRL_C

    def interrupt(self) -> None:
        """Raise the board's KeyboardInterrupt where the firmware is, unless it does not heed it."""
        if self.running and self._heeds:
            self.pause()
            self._greenlet.parent = getcurrent()
            self._greenlet.throw(Interrupted)

    def pause(self) -> None:
        """Never execute again."""
        if self._resume_at is not None:
            self._resume_at.cancel()
            self._resume_at = None

    def say(self, text: str) -> None:
        """Print on the board's console."""
        if not self._ended:
            self._world.console.append(text)

    def end(self) -> None:
        """Unwind the firmware; its `finally` and `except` blocks reach no hardware any more."""
        self._ended = True
        self.pause()
        if self._bite_at is not None:
            self._bite_at.cancel()
        self.spend = self._protest
        if self._greenlet and not self._greenlet.dead:
            self._greenlet.parent = getcurrent()
            self._greenlet.throw(GreenletExit)

    def _spend(self, cost_us: int) -> None:
        clock = self.clock
        due_us = clock.now_us + cost_us
        if due_us < clock.limit_us:
            clock.now_us = due_us
            return
        self._resume_at = clock.at(due_us, self._resume)
        self._greenlet.parent.switch()

    def _resume(self) -> None:
        self._greenlet.parent = getcurrent()
        self._greenlet.switch()

    def _bite(self) -> None:
        if self.clock.now_us < self._bite_us:
            self._bite_at = self.clock.at(self._bite_us, self._bite)
        else:
            self._world.reset()

    def _run(self) -> None:
        crashes = self._world.crashes
        try:
            self._world.execute(self)
        except (GreenletExit, KeyboardInterrupt):
            raise
        except Crashed as crash:
            crashes.append(Crash(self.clock.now_us, crash.error, crash.trace))
        except BaseException as error:
            crashes.append(Crash(self.clock.now_us, repr(error), traceback.format_exc()))
        else:
            crashes.append(Crash(self.clock.now_us, "main has ended", ""))

    def _protest(self, cost_us: int) -> None:
        """Answer for the hardware after the end; a loop that catches even this is left standing."""
        self._protests += 1
        while self._protests > _PROTESTS_MAX:
            self._greenlet.parent.switch()
        raise GreenletExit


Interpreter = Callable[[Life], None]  # runs boot.py and main.py of a life's flash, for ever if all is well
