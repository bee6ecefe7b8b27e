"""The modules `machine` and `time` of one life of the processor, as the rp2 port of MicroPython has them.

Each access costs its time (costs.py) and then happens on the bench's board. What the port refuses is refused with its
own words, so that a driver's mistake looks the same here.
"""

from types import ModuleType
from typing import Any, ClassVar, Protocol

from hil_sim.board import SCL, SDA, Board
from hil_sim.clock import Clock
from hil_sim.devices import gpio, i2c
from hil_sim.devices.i2c import Bus, bus_time_us
from hil_sim.devices.ntc import scaled_to_u16
from hil_sim.devices.uart import BUFFER_BYTES, Uart
from hil_sim.journal import I2C_READ, I2C_WRITE, UART_SENT
from hil_sim.worlds.costs import ADC_US, PIN_US, TICKS_PERIOD, TICKS_US, UART_US, WATCHDOG_MAX_MS, WATCHDOG_US

PWRON_RESET, WDT_RESET = 1, 3
Buffer = bytearray | memoryview


class Processor(Protocol):
    """What the modules need of the world that runs them."""

    board: Board
    clock: Clock
    cause: int

    def spend(self, cost_us: int) -> None:
        """Let virtual time pass."""

    def reset(self) -> None:
        """Reset the processor; does not return."""

    def watch(self, timeout_us: int) -> None:
        """Reset the processor unless this is called again within `timeout_us`."""

    def ticks_us(self) -> int:
        """Return the time since reset."""


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


class I2C:
    """A bus; a transfer that is not acknowledged raises OSError(5, "EIO")."""

    _processor: ClassVar[Processor]

    def __init__(
        self, id: int, *, scl: Pin | None = None, sda: Pin | None = None, freq: int = 400_000, timeout: int = 50_000
    ) -> None:
        scl_number = scl.number if scl is not None else (5, 7)[id]
        sda_number = sda.number if sda is not None else (4, 6)[id]
        for number, rest, name in ((scl_number, 1, "SCL"), (sda_number, 0, "SDA")):
            if number % 4 != 2 * id + rest:
                raise ValueError(f"bad {name} pin")
        self._freq = freq
        wired = (sda_number, scl_number) == (SDA, SCL)
        self._bus = self._processor.board.bus if wired else Bus()

    def scan(self) -> list[int]:
        """Return the addresses that answer."""
        self._processor.spend(bus_time_us(0x70, self._freq))
        return [address for address in range(0x08, 0x78) if self._bus.at(address)]

    def writeto(self, addr: int, buf: bytes | Buffer, stop: bool = True) -> int:
        """Write `buf`; return how many bytes were acknowledged."""
        data = bytes(buf)
        self._write(self._begin(addr, 1 + len(data)), addr, data)
        return len(data)

    def readfrom(self, addr: int, nbytes: int, stop: bool = True) -> bytes:
        """Return `nbytes` bytes."""
        return self._read(self._begin(addr, 1 + nbytes), addr, nbytes)

    def readfrom_into(self, addr: int, buf: Buffer, stop: bool = True) -> None:
        """Fill `buf`."""
        buf[:] = self.readfrom(addr, len(buf))

    def writeto_mem(self, addr: int, memaddr: int, buf: bytes | Buffer, *, addrsize: int = 8) -> None:
        """Write `buf` from register `memaddr` on."""
        self.writeto(addr, memaddr.to_bytes(addrsize // 8, "big") + bytes(buf))

    def readfrom_mem(self, addr: int, memaddr: int, nbytes: int, *, addrsize: int = 8) -> bytes:
        """Return `nbytes` bytes from register `memaddr` on."""
        pointer = memaddr.to_bytes(addrsize // 8, "big")
        chips = self._begin(addr, 2 + len(pointer) + nbytes)
        self._write(chips, addr, pointer)
        return self._read(chips, addr, nbytes)

    def readfrom_mem_into(self, addr: int, memaddr: int, buf: Buffer, *, addrsize: int = 8) -> None:
        """Fill `buf` from register `memaddr` on."""
        buf[:] = self.readfrom_mem(addr, memaddr, len(buf), addrsize=addrsize)

    def _begin(self, addr: int, byte_count: int) -> list[i2c.Chip]:
        """Spend the time of the transfer and return who answers; of the address alone when nobody does."""
        chips = self._bus.at(addr)
        self._processor.spend(bus_time_us(byte_count if chips else 1, self._freq))
        if not chips:
            raise OSError(5, "EIO")
        return chips

    def _write(self, chips: list[i2c.Chip], addr: int, data: bytes) -> None:
        processor = self._processor
        processor.board.journal.note(processor.clock.now_us, I2C_WRITE, addr, data)
        if i2c.write(chips, addr, data) < len(data):
            raise OSError(5, "EIO")

    def _read(self, chips: list[i2c.Chip], addr: int, count: int) -> bytes:
        processor = self._processor
        data = i2c.read(chips, count)
        processor.board.journal.note(processor.clock.now_us, I2C_READ, addr, data)
        return data


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


class UART:
    """A serial port that never blocks: reads give None when there is nothing, writes take what the buffer holds."""

    _processor: ClassVar[Processor]

    def __init__(
        self,
        id: int,
        baudrate: int = 115_200,
        bits: int = 8,
        parity: int | None = None,
        stop: int = 1,
        *,
        tx: Pin | None = None,
        rx: Pin | None = None,
        txbuf: int = BUFFER_BYTES,
        rxbuf: int = BUFFER_BYTES,
        timeout: int = 0,
        timeout_char: int = 0,
    ) -> None:
        processor = self._processor
        wired = id == 0 and (tx is None or tx.number == 0) and (rx is None or rx.number == 1)
        self._line = processor.board.uart if wired else Uart(baudrate)
        processor.spend(UART_US)
        self._line.open(baudrate, processor.clock.now_us, rxbuf, txbuf)

    def any(self) -> int:
        """Return how many bytes wait."""
        self._processor.spend(UART_US)
        return self._line.any(self._processor.clock.now_us)

    def read(self, nbytes: int = -1) -> bytes | None:
        """Return what has arrived, at most `nbytes`, or None."""
        self._processor.spend(UART_US)
        return self._line.read(nbytes if nbytes >= 0 else 1 << 30, self._processor.clock.now_us) or None

    def readinto(self, buf: Buffer, nbytes: int = -1) -> int | None:
        """Fill the front of `buf` with what has arrived and return how much, or None."""
        data = self.read(len(buf) if nbytes < 0 else min(nbytes, len(buf)))
        if data is None:
            return None
        buf[: len(data)] = data
        return len(data)

    def write(self, buf: bytes | Buffer) -> int | None:
        """Send as much of `buf` as the transmit buffer takes and return how much, or None when it is full."""
        processor = self._processor
        processor.spend(UART_US)
        data = bytes(buf)
        count = self._line.write(data, processor.clock.now_us)
        processor.board.journal.note(processor.clock.now_us, UART_SENT, 0, data[:count])
        return count if count or not data else None


class WDT:
    """The watchdog; nothing stops it but a reset."""

    _processor: ClassVar[Processor]

    def __init__(self, id: int = 0, timeout: int = 5000) -> None:
        if timeout > WATCHDOG_MAX_MS:
            raise ValueError(f"timeout exceeds {WATCHDOG_MAX_MS}")
        self._timeout_us = timeout * 1000
        self.feed()

    def feed(self) -> None:
        """Start the time-out anew."""
        self._processor.spend(WATCHDOG_US)
        self._processor.watch(self._timeout_us)


def machine_module(processor: Processor) -> ModuleType:
    """Return `machine` for one life of a processor."""
    module = ModuleType("machine")
    for peripheral in (Pin, I2C, ADC, UART, WDT):
        owned = {"_processor": processor, "_pins": {}}
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
        processor.spend(max(TICKS_US, us))

    def sleep_ms(ms: int) -> None:
        processor.spend(max(TICKS_US, ms * 1000))

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


def _pin_number(id: int | str | Pin) -> int:
    if isinstance(id, Pin):
        return id.number
    number = {"LED": 25}.get(id, id) if isinstance(id, str) else id
    if isinstance(number, str):
        number = int(number[2:]) if number.startswith("GP") and number[2:].isdigit() else -1
    if not 0 <= number < gpio.PIN_COUNT:
        raise ValueError("invalid pin")
    return number
