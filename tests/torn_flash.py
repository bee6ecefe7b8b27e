"""The bench's flash under firmware code that runs in the test's own process: a power cut is an exception."""

import io

from hil_sim.devices.flash import CLOSE, TRUNCATE, WRITE, Flash


class PowerCut(BaseException):
    """The power failed: nothing more is executed."""


class Opened(io.BytesIO):
    """A file that is open for writing."""

    def __init__(self, flash: Flash, path: str) -> None:
        super().__init__()
        self._flash, self._path = flash, path
        self._operate(TRUNCATE)

    def write(self, data: bytes) -> int:
        self._operate(WRITE, data)
        return len(data)

    def __exit__(self, *error: object) -> None:
        if error[0] is not PowerCut:
            self._operate(CLOSE)

    def _operate(self, kind: int, data: bytes = b"") -> None:
        if not self._flash.operate(kind, self._path, data):
            raise PowerCut


def opener(flash: Flash):
    """Return the `open` of a board with that flash."""

    def open_file(path: str, mode: str):
        return Opened(flash, path) if mode == "wb" else io.BytesIO(flash.read(path))

    return open_file
