"""The files on the processor's flash, and the power cut that tears one of them.

What a write leaves behind is worse than on littlefs, which commits a file as a whole when it is closed: here each of
truncating, writing and closing takes effect by itself and can be cut in its middle, so firmware that keeps its records
here keeps them on any file system. The files survive resets and power cycles.

    flash = Flash({"robot.json": b"{}"})
    flash.cut_at = 2  # the power fails in the middle of the second write operation from now
    flash.read("/robot.json")
"""

from collections.abc import Mapping

TRUNCATE, WRITE, CLOSE = range(3)
PAGE_BYTES = 256
# Winbond W25Q16JV on the Pico: a page is programmed in 0.4 ms, a sector of 4 KB erased in 45 ms, both typical
# (data sheet, AC characteristics; at most 3 ms and 400 ms, which drivers wait for). ASSUMED: one erased sector a file.
PROGRAM_US = 400
ERASE_US = 45_000


class Flash:
    """Files by path; the leading slash may be left out. `operations` counts the firmware's write operations."""

    def __init__(self, files: Mapping[str, bytes]) -> None:
        self.operations = 0
        self.cut_at = 0  # the write operation from now that the power does not live through; 0: none
        self._files = {_plain(path): data for path, data in files.items()}

    def paths(self) -> list[str]:
        """Return the paths of all files, in order."""
        return sorted(self._files)

    def read(self, path: str) -> bytes:
        """Return a file's bytes; OSError(2, "ENOENT") as on the board when there is none."""
        try:
            return self._files[_plain(path)]
        except KeyError:
            raise OSError(2, "ENOENT") from None

    def store(self, path: str, data: bytes) -> None:
        """Put a file there, as somebody with a cable does: no operation of the firmware, never torn."""
        self._files[_plain(path)] = data

    def remove(self, path: str) -> None:
        """Take a file away; OSError(2, "ENOENT") when there is none."""
        self.read(path)
        del self._files[_plain(path)]

    def operate(self, kind: int, path: str, data: bytes = b"") -> bool:
        """Carry out one write operation; return False when the power failed in its middle."""
        self.operations += 1
        cut = self.cut_at == 1
        self.cut_at = max(0, self.cut_at - 1)
        self._files[_plain(path)] = self._after(kind, _plain(path), data, cut)
        return not cut

    def _after(self, kind: int, path: str, data: bytes, cut: bool) -> bytes:
        """Return what the file holds after an operation: half of it is done, or undone, when it is cut."""
        old = self._files.get(path, b"")
        if kind == TRUNCATE:
            return old[: len(old) // 2] if cut else b""
        if kind == WRITE:
            return old + (data[: len(data) // 2] if cut else data)
        return old[:-1] if cut else old


def cost_us(kind: int, size: int) -> int:
    """Return how long a write operation on `size` bytes takes."""
    if kind == TRUNCATE:
        return ERASE_US
    return PROGRAM_US * max(1, -(-size // PAGE_BYTES))


def _plain(path: str) -> str:
    return path.lstrip("/")
