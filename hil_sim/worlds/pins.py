"""`machine.Pin` and `machine.ADC` as the rp2 port of MicroPython has them."""

from typing import Any, ClassVar

from hil_sim.devices import gpio
from hil_sim.devices.ntc import scaled_to_u16
from hil_sim.worlds.costs import ADC_US, PIN_US
from hil_sim.worlds.processor import Processor


class Pin:
    """A pin; the same object for the same number."""

    IN, OUT, OPEN_DRAIN = gpio.IN, gpio.OUT, gpio.OPEN_DRAIN
    PULL_UP, PULL_DOWN = gpio.PULL_UP, gpio.PULL_DOWN
    _processor: ClassVar[Processor]
    _pins: ClassVar[dict[int, "Pin"]]
    number: int

    def __new__(cls, id: "int | str | Pin", *args: Any, **options: Any) -> "Pin":
        number = _pin_number(id)
        if number not in cls._pins:
            cls._pins[number] = super().__new__(cls)
            cls._pins[number].number = number
        return cls._pins[number]

    def __init__(self, id: "int | str | Pin", mode: int = -1, pull: int | None = -1, **options: Any) -> None:
        if mode != -1 or pull != -1 or options:
            self.init(mode, pull, **options)

    def init(self, mode: int = -1, pull: int | None = -1, *, value: int | None = None) -> None:
        """Configure the pin."""
        self._processor.spend(PIN_US)
        if mode != -1:
            self._processor.board.pulses.release(self.number)
        self._processor.board.gpio.configure(
            self.number,
            None if mode == -1 else mode,
            None if pull == -1 else pull or gpio.NO_PULL,
            None if value is None else int(bool(value)),
        )

    def value(self, level: int | None = None) -> int | None:
        """Return the level, or set it."""
        processor = self._processor
        processor.spend(PIN_US)
        if level is None:
            return processor.board.gpio.read(self.number)
        processor.board.gpio.write(self.number, 1 if level else 0)
        return None

    __call__ = value

    def on(self) -> None:
        """Set the pin high."""
        self.value(1)

    high = on

    def off(self) -> None:
        """Set the pin low."""
        self.value(0)

    low = off

    def toggle(self) -> None:
        """Turn the level over."""
        self._processor.spend(PIN_US)
        pins = self._processor.board.gpio
        pins.write(self.number, 1 - pins.read(self.number))


class ADC:
    """An analogue input."""

    _processor: ClassVar[Processor]

    def __init__(self, pin: Pin | int) -> None:
        number = pin.number if isinstance(pin, Pin) else pin
        is_pin = isinstance(pin, Pin) or number >= 26
        self._channel = number - 26 if is_pin else number
        if not 0 <= self._channel <= (3 if is_pin else 4):
            raise ValueError("Pin doesn't have ADC capabilities")

    def read_u16(self) -> int:
        """Return a conversion scaled to 16 bits."""
        self._processor.spend(ADC_US)
        return scaled_to_u16(self._processor.board.convert(self._channel))


def _pin_number(id: int | str | Pin) -> int:
    if isinstance(id, Pin):
        return id.number
    number = {"LED": 25}.get(id, id) if isinstance(id, str) else id
    if isinstance(number, str):
        number = int(number[2:]) if number.startswith("GP") and number[2:].isdigit() else -1
    if not 0 <= number < gpio.PIN_COUNT:
        raise ValueError("invalid pin")
    return number
