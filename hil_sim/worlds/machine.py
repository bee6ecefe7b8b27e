"""The modules `machine` and `time` of one life of the processor, as the rp2 port of MicroPython has them.

Each access costs its time (costs.py) and then happens on the bench's board. What the port refuses is refused with its
own words, so that a driver's mistake looks the same here.
"""

from operator import index
from types import ModuleType
from typing import ClassVar

from hil_sim.worlds.costs import TICKS_PERIOD, TICKS_US, WATCHDOG_MAX_MS, WATCHDOG_US
from hil_sim.worlds.lines import I2C, UART
from hil_sim.worlds.pins import ADC, Pin
from hil_sim.worlds.processor import Processor
from hil_sim.worlds.pulses import PWM
from hil_sim.worlds.spi import SPI

PWRON_RESET, WDT_RESET = 1, 3


def machine_module(processor: Processor) -> ModuleType:
    """Return `machine` for one life of a processor."""
    module = ModuleType("machine")
    for peripheral in (Pin, I2C, SPI, PWM, ADC, UART, WDT):
        owned = {"_processor": processor, "_pins": {}, "_duties": {}, "_timed": set(), "_timeout_us": 0}
        setattr(module, peripheral.__name__, type(peripheral.__name__, (peripheral,), owned))
    vars(module).update(
        PWRON_RESET=PWRON_RESET,
        WDT_RESET=WDT_RESET,
        reset=processor.reset,
        reset_cause=lambda: processor.cause,
        unique_id=lambda: processor.board.unique_id,
        freq=lambda: 125_000_000,
    )
    return module


def time_module(processor: Processor) -> ModuleType:
    """Return `time` for one life of a processor. Ticks wrap at 2**30 as on boards."""
    mask = TICKS_PERIOD - 1
    half = TICKS_PERIOD >> 1

    def ticks_us() -> int:
        processor.spend(TICKS_US)
        return processor.ticks_us() & mask

    def ticks_ms() -> int:
        processor.spend(TICKS_US)
        return processor.ticks_us() // 1000 & mask

    def sleep_us(us: int) -> None:
        processor.spend(max(TICKS_US, index(us)))

    def sleep_ms(ms: int) -> None:
        processor.spend(max(TICKS_US, index(ms) * 1000))

    module = ModuleType("time")
    vars(module).update(
        ticks_us=ticks_us,
        ticks_cpu=ticks_us,
        ticks_ms=ticks_ms,
        ticks_add=lambda ticks, delta: ticks + delta & mask,
        ticks_diff=lambda later, earlier: (later - earlier + half & mask) - half,
        sleep_us=sleep_us,
        sleep_ms=sleep_ms,
        sleep=lambda seconds: sleep_us(int(seconds * 1_000_000)),
        time=lambda: processor.ticks_us() // 1_000_000,
    )
    return module


class WDT:
    """The watchdog; nothing stops it but a reset. There is one: whoever feeds it loads the time-out that was set last.

    That is how the port has it: the pico-sdk keeps one `load_value` (hardware_watchdog/watchdog.c).
    """

    _processor: ClassVar[Processor]
    _timeout_us: ClassVar[int]

    def __init__(self, id: int = 0, timeout: int = 5000) -> None:
        if timeout > WATCHDOG_MAX_MS:
            raise ValueError(f"timeout exceeds {WATCHDOG_MAX_MS}")
        type(self)._timeout_us = timeout * 1000
        self.feed()

    def feed(self) -> None:
        """Start the time-out anew."""
        self._processor.spend(WATCHDOG_US)
        self._processor.watch(self._timeout_us)
