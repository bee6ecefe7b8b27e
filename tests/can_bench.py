"""An MCP2515 on a wire with stations beside it, spoken to byte by byte."""

from hil_sim.clock import Clock
from hil_sim.devices.canframe import Frame
from hil_sim.devices.canstation import CanStation
from hil_sim.devices.canwire import CanWire
from hil_sim.devices.mcp2515 import Mcp2515

CANCTRL, CANSTAT, CNF3, CANINTE, CANINTF, EFLG, TEC, REC = 0x0F, 0x0E, 0x28, 0x2B, 0x2C, 0x2D, 0x1C, 0x1D
RATE_HZ = 500_000
TIMING = (0x02, 0x90, 0x00)  # CNF3 to CNF1 for 500 kbit/s at 8 MHz: eight quanta of 250 ns
NORMAL, SLEEP, LOOPBACK, LISTEN_ONLY, CONFIGURATION = 0x00, 0x20, 0x40, 0x60, 0x80


class CanRig:
    """A chip in configuration mode, 128 clocks after its reset, and one station."""

    def __init__(self, crystal_hz: int = 8_000_000, stations: int = 1) -> None:
        self.clock = Clock()
        self.wire = CanWire(self.clock)
        self.edges: list[int] = []
        self.chip = Mcp2515(self.clock, self.wire, crystal_hz, lambda: self.edges.append(self.chip.int_level()))
        self.stations = [CanStation(self.wire, RATE_HZ) for _ in range(stations)]
        self.run_us(16)

    def run_us(self, us: int) -> None:
        self.clock.run_until(self.clock.now_us + us)

    def say(self, *data: int) -> list[int]:
        """Exchange bytes within one selection; return what came back."""
        self.chip.select(True)
        said = [self.chip.exchange(byte) for byte in data]
        self.chip.select(False)
        return said

    def read(self, register: int, count: int = 1) -> list[int]:
        return self.say(0x03, register, *[0] * count)[2:]

    def get(self, register: int) -> int:
        return self.read(register)[0]

    def write(self, register: int, *values: int) -> None:
        self.say(0x02, register, *values)

    def modify(self, register: int, mask: int, value: int) -> None:
        self.say(0x05, register, mask, value)

    def mode(self) -> int:
        return self.get(CANSTAT) & 0xE0

    def enter(self, mode: int) -> None:
        self.modify(CANCTRL, 0xE0, mode)

    def start(self, mode: int = NORMAL, any_message: bool = True) -> "CanRig":
        """Set the bit timing, let every message pass (or leave the filters on), go into a mode."""
        self.write(CNF3, *TIMING)
        self.write(0x60, 0x64 if any_message else 0x04)
        self.write(0x70, 0x60 if any_message else 0x00)
        self.enter(mode)
        return self

    def load(self, buffer: int, frame: Frame) -> None:
        """Put a standard frame into a transmit buffer."""
        header = (frame.id >> 3, frame.id << 5 & 0xE0, 0, 0, len(frame.data))
        self.say(0x40 | buffer << 1, *header, *frame.data)

    def send(self, frame: Frame, buffer: int = 0) -> None:
        """Put a standard frame into a transmit buffer and request it."""
        self.load(buffer, frame)
        self.say(0x80 | 1 << buffer)
