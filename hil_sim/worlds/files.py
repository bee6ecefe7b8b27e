"""`open` as the rp2 port of MicroPython has it, for what firmware needs: reading, and writing a file anew.

A file is read whole when it is opened, and like an import that costs no time. Truncating, writing and closing are
operations of their own: each takes its time and reaches the flash at once, or is torn by a power cut, from which
nothing comes back.

    with Files(processor).open("/settings.0", "wb") as file:
        file.write(record)
"""

import io

from hil_sim.devices.flash import CLOSE, TRUNCATE, WRITE, cost_us
from hil_sim.journal import FLASH
from hil_sim.worlds.processor import Processor


class Files:
    """The flash of one life of the processor."""

    def __init__(self, processor: Processor) -> None:
        self._processor = processor

    def open(self, path: str, mode: str = "r") -> "io.IOBase | Written":
        """Return a file object; OSError(2, "ENOENT") when there is none to read, OSError(22) for another mode."""
        if mode == "wb":
            return Written(self, path)
        if mode not in ("r", "rt", "rb"):
            raise OSError(22, "EINVAL")
        data = self._processor.board.flash.read(path)
        return io.BytesIO(data) if mode == "rb" else io.StringIO(data.decode())

    def operate(self, kind: int, path: str, data: bytes = b"") -> None:
        """Carry out a write operation; when the power fails in its middle, it does not return."""
        processor = self._processor
        processor.spend(cost_us(kind, len(data)))
        processor.board.journal.note(processor.clock.now_us, FLASH, kind, path.lstrip("/").encode() + b"\0" + data)
        if not processor.board.flash.operate(kind, path, data):
            processor.lose_power()


class Written:
    """A file that is open for writing."""

    def __init__(self, files: Files, path: str) -> None:
        self._files = files
        self._path = path
        self._is_open = True
        files.operate(TRUNCATE, path)

    def write(self, data: bytes | bytearray | memoryview) -> int:
        """Append `data`; return how many bytes."""
        self._files.operate(WRITE, self._path, bytes(data))
        return len(data)

    def close(self) -> None:
        """Settle the file; closing it twice does nothing."""
        if self._is_open:
            self._is_open = False
            self._files.operate(CLOSE, self._path)

    def __enter__(self) -> "Written":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
