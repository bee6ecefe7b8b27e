"""The robot's dictionary, read from its flash: what its messages mean and what it is, never held in RAM.

It has two parts: the definitions, which end in a blank line, with the profile behind them; and the help texts. The
CRC-32 of the first seeds the frames. A page is read when it is asked for, so that no call takes long; only the CRC
takes the whole text, piece by piece, before the control loop begins.

    dictionary = Dictionary(open, "/a")
    dictionary.crc, dictionary.size
    dictionary.page(DEFINITIONS, 200, 100)
"""

from binascii import crc32

DEFINITIONS, HELP = 0, 1  # the parts
FILES = (("/protocol/dictionary.txt", "/robot.json"), ("/protocol/help.txt",))
PIECE = 256  # bytes read at once while the CRC is made


class Dictionary:
    """The dictionary of the program in `folder`. Its files stay open: to find one on the flash takes longer."""

    def __init__(self, open, folder: str) -> None:
        self._parts = [[_Text(open(folder + path, "rb")) for path in paths] for paths in FILES]
        self.crc = 0
        self.size = 0
        for text in self._parts[DEFINITIONS]:
            self.crc = text.crc_from(self.crc)
            self.size += text.size

    def page(self, part: int, offset: int, count: int) -> bytes:
        """Return `count` bytes of a part, fewer at its end and none beyond; ValueError when there is no such part."""
        if part >= len(self._parts):
            raise ValueError(f"part {part} of the dictionary, there are {len(self._parts)}")
        page = b""
        for text in self._parts[part]:
            if 0 <= offset < text.size and count > len(page):
                page += text.read(offset, count - len(page))
            offset = offset - text.size if offset >= text.size else 0
        return page


class _Text:
    """A file on the flash."""

    def __init__(self, file) -> None:
        self._file = file
        self.size = file.seek(0, 2)

    def read(self, offset: int, count: int) -> bytes:
        self._file.seek(offset)
        return self._file.read(count)

    def crc_from(self, crc: int) -> int:
        """Return the CRC of all that stands before this text and of itself."""
        for offset in range(0, self.size, PIECE):
            crc = crc32(self.read(offset, PIECE), crc)
        return crc
