"""`machine.I2C` and `machine.UART` as the rp2 port of MicroPython has them."""

from typing import ClassVar

from hil_sim.board import SCL, SDA
from hil_sim.devices import i2c
from hil_sim.devices.i2c import Bus, bus_time_us
from hil_sim.devices.uart import BUFFER_BYTES, Uart
from hil_sim.journal import I2C_READ, I2C_WRITE, UART_SENT
from hil_sim.worlds.costs import UART_US
from hil_sim.worlds.pins import Pin
from hil_sim.worlds.processor import Processor

Buffer = bytearray | memoryview


class I2C:
    """A bus; no acknowledgement is OSError(5, "EIO"), a line held low OSError(110, "ETIMEDOUT") after a time."""

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
        self._timeout_us = timeout
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
        self.writeto(addr, _pointer(memaddr, addrsize) + bytes(buf))

    def readfrom_mem(self, addr: int, memaddr: int, nbytes: int, *, addrsize: int = 8) -> bytes:
        """Return `nbytes` bytes from register `memaddr` on."""
        pointer = _pointer(memaddr, addrsize)
        chips = self._begin(addr, 2 + len(pointer) + nbytes)
        self._write(chips, addr, pointer)
        return self._read(chips, addr, nbytes)

    def readfrom_mem_into(self, addr: int, memaddr: int, buf: Buffer, *, addrsize: int = 8) -> None:
        """Fill `buf` from register `memaddr` on."""
        buf[:] = self.readfrom_mem(addr, memaddr, len(buf), addrsize=addrsize)

    def _begin(self, addr: int, byte_count: int) -> list[i2c.Chip]:
        """Spend the time of the transfer and return who answers; of the address alone when nobody does."""
        if self._bus.stuck:
            self._processor.spend(self._timeout_us)
            raise OSError(110, "ETIMEDOUT")
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

    def write(self, buf: bytes | Buffer | str) -> int | None:
        """Send as much of `buf` as the transmit buffer takes and return how much, or None when it is full."""
        processor = self._processor
        processor.spend(UART_US)
        data = buf.encode() if isinstance(buf, str) else bytes(buf)
        count = self._line.write(data, processor.clock.now_us)
        processor.board.journal.note(processor.clock.now_us, UART_SENT, 0, data[:count])
        return count if count or not data else None


def _pointer(memaddr: int, addrsize: int) -> bytes:
    """Return a register address as it goes over the bus: what does not fit into it is cut off, as in extmod."""
    return (memaddr & (1 << addrsize) - 1).to_bytes(addrsize // 8, "big")
