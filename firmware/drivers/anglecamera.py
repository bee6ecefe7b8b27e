"""The angle camera, whose five registers hold one frame: who, status, frame counter, angle (hil_sim's is the model)."""

IDENTITY = 0x5A
SEEN = 0x01


class AngleCamera:
    """One camera. `read` raises OSError when it does not answer or another chip does."""

    def __init__(self, bus, address: int) -> None:
        self.address = address
        self.seen = False  # in the last frame
        self.centideg = 0  # there, as long as the object is seen
        self._bus = bus
        self._frame = -1
        self._registers = bytearray(5)
        self._stranger = OSError(19, "ENODEV")  # raised without allocating

    def read(self) -> bool:
        """Bring the last frame into `seen` and `centideg`; return whether it is a new one."""
        registers = self._registers
        self._bus.readfrom_mem_into(self.address, 0, registers)
        if registers[0] != IDENTITY:
            raise self._stranger
        fresh = registers[2] != self._frame
        self._frame = registers[2]
        self.seen = bool(registers[1] & SEEN)
        word = registers[3] | registers[4] << 8
        self.centideg = word - 0x10000 if word & 0x8000 else word
        return fresh
