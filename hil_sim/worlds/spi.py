"""`machine.SPI` as the rp2 port of MicroPython has it (ports/rp2/machine_spi.c, extmod/machine_spi.c).

Pins are `Pin` objects or their numbers; the rate is what the divider of the pico-sdk's spi_set_baudrate reaches.
"""

from typing import ClassVar

from hil_sim.board import ADC_MISO, ADC_MOSI, ADC_SCK, MISO, MOSI, SCK, Board
from hil_sim.devices.pwm import CLOCK_HZ
from hil_sim.devices.spi import SpiBus, transfer_time_us
from hil_sim.journal import SPI as SPI_TRANSFER
from hil_sim.worlds.costs import SPI_US
from hil_sim.worlds.pins import Pin
from hil_sim.worlds.processor import Processor

Buffer = bytearray | memoryview
_DEFAULTS = ((18, 19, 16), (10, 11, 8))  # SCK, MOSI and MISO of each


class SPI:
    """A bus; every byte that goes out brings one in."""

    MSB, LSB = 0, 1
    _processor: ClassVar[Processor]

    def __init__(
        self,
        id: int,
        baudrate: int = 1_000_000,
        polarity: int = 0,
        phase: int = 0,
        bits: int = 8,
        firstbit: int = 0,
        sck: Pin | int | None = None,
        mosi: Pin | int | None = None,
        miso: Pin | int | None = None,
    ) -> None:
        if id not in (0, 1):
            raise ValueError(f"SPI({id}) doesn't exist")
        given = (_number(sck), _number(mosi), _number(miso))
        for name, rest, number in zip(("SCK", "MOSI", "MISO"), (2, 3, 0), given, strict=True):
            if number is not None and (number & 3 != rest or number >> 3 & 1 != id):
                raise ValueError(f"bad {name} pin")
        pins = tuple(default if pin is None else pin for pin, default in zip(given, _DEFAULTS[id], strict=True))
        board = self._processor.board
        self._which = id
        self._bus = _wired(board, pins)
        self._rate_hz = 0
        self._mode = 0
        self.init(baudrate, polarity, phase, bits, firstbit)

    def init(self, baudrate: int = -1, polarity: int = -1, phase: int = -1, bits: int = -1, firstbit: int = -1) -> None:
        """Set what is given."""
        self._processor.spend(SPI_US)
        if firstbit == self.LSB:
            raise NotImplementedError("LSB")
        if baudrate != -1:
            self._rate_hz = rate_hz(baudrate)
        old_polarity, old_phase = divmod(self._mode, 2)
        self._mode = 2 * (old_polarity if polarity == -1 else polarity) + (old_phase if phase == -1 else phase)

    def deinit(self) -> None:
        """Nothing to give back."""

    def transfer(self, data: bytes) -> bytes:
        """Send bytes; return those that came meanwhile. All methods below are this one."""
        processor = self._processor
        processor.spend(SPI_US + transfer_time_us(len(data), self._rate_hz))
        came = self._bus.transfer(data, self._rate_hz, self._mode)
        processor.board.journal.note(processor.clock.now_us, SPI_TRANSFER, self._which, data + came)
        return came

    def write(self, buf: bytes | Buffer) -> None:
        """Send `buf`."""
        self.transfer(bytes(buf))

    def read(self, nbytes: int, write: int = 0) -> bytes:
        """Return `nbytes` bytes, sending `write` for each."""
        return self.transfer(bytes((write,)) * nbytes)

    def readinto(self, buf: Buffer, write: int = 0) -> None:
        """Fill `buf`, sending `write` for each byte."""
        buf[:] = self.read(len(buf), write)

    def write_readinto(self, write_buf: bytes | Buffer, read_buf: Buffer) -> None:
        """Send one buffer and fill the other, which may be the same."""
        if len(write_buf) != len(read_buf):
            raise ValueError("buffers must be the same length")
        read_buf[:] = self.transfer(bytes(write_buf))


def rate_hz(wanted_hz: int) -> int:
    """Return the rate that the SDK arrives at: not above the one that is wanted, save for some of the lowest."""
    prescales = range(2, 256, 2)
    prescale = next((scale for scale in prescales if (scale + 2) * 256 * wanted_hz > CLOCK_HZ), prescales[-1])
    postdivs = range(256, 1, -1)
    postdiv = next((div for div in postdivs if CLOCK_HZ // (prescale * (div - 1)) > wanted_hz), 1)
    return CLOCK_HZ // (prescale * postdiv)


def _wired(board: Board, pins: tuple[int, ...]) -> SpiBus:
    """Return what hangs on SCK, MOSI and MISO at these pins."""
    if pins == (SCK, MOSI, MISO):
        return board.spi
    return board.adc_spi if pins == (ADC_SCK, ADC_MOSI, ADC_MISO) else SpiBus({}, lambda pin: False)


def _number(pin: Pin | int | None) -> int | None:
    return pin.number if isinstance(pin, Pin) else pin
