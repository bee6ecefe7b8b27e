"""The dictionary on the robot's flash: read in pages, in CPython and in real MicroPython alike, never as a whole."""

import io
from binascii import crc32
from pathlib import Path

import pytest

from firmware.dictionary import DEFINITIONS, HELP, PIECE, Dictionary
from hil_sim.worlds import cpython, micropython
from tests.slot_bench import SMALL, said, slot_bench

DEFINED, PROFILE, WORDS = b"1 hello version:B\n\n", b'{"robot": "x"}' * 40, b"hello Opens a session.\n"
FILES = {"protocol/dictionary.txt": DEFINED, "robot.json": PROFILE, "protocol/help.txt": WORDS}
ALL = DEFINED + PROFILE
READS = """
import sys
from firmware.dictionary import Dictionary
found = Dictionary(open, sys.path[0])
print("crc", found.crc, found.size, found.page(0, 10, 20), found.page(0, 19, 4), found.page(1, 6, 5))
"""


class Flash:
    """Files that remember how much was read of them at once."""

    def __init__(self) -> None:
        self.opened = 0
        self.most = 0

    def open(self, path, mode):
        assert mode == "rb"
        self.opened += 1
        flash = self

        class File(io.BytesIO):
            def read(self, count=-1):
                piece = super().read(count)
                flash.most = max(flash.most, len(piece))
                return piece

        return File(FILES[path.removeprefix("/a/")])


@pytest.fixture
def flash():
    return Flash()


@pytest.fixture
def dictionary(flash):
    return Dictionary(flash.open, "/a")


def test_the_dictionary_is_the_definitions_with_the_profile_behind_them(dictionary):
    assert dictionary.size == len(ALL)
    assert dictionary.crc == crc32(ALL)


@pytest.mark.parametrize("count", [1, 7, 18, 200])
def test_its_pages_are_the_whole_text_and_nothing_beyond(dictionary, count):
    pages = [dictionary.page(DEFINITIONS, at, count) for at in range(0, len(ALL) + count, count)]

    assert b"".join(pages) == ALL
    assert dictionary.page(DEFINITIONS, 65_535, count) == b""


def test_the_help_texts_are_a_part_of_their_own(dictionary):
    assert dictionary.page(HELP, 6, 255) == WORDS[6:]


def test_there_is_no_third_part(dictionary):
    with pytest.raises(ValueError, match="part 2 of the dictionary, there are 2"):
        dictionary.page(2, 0, 10)


def test_no_more_is_read_at_once_than_a_piece_and_no_file_is_opened_twice(flash, dictionary):
    dictionary.page(DEFINITIONS, 0, 200)

    assert (flash.most, flash.opened) == (PIECE, 3)


@pytest.mark.parametrize("world", [cpython, micropython], ids=["cpython", "micropython"])
def test_the_same_is_read_in_both_worlds(world):
    source = (Path(__file__).parents[1] / "firmware/dictionary.py").read_bytes()
    program = {**FILES, "firmware/dictionary.py": source, "firmware/main.py": (READS + SMALL).encode()}
    bench = slot_bench({"a": program}, execute=world.execute)

    bench.clock.run_until(500_000)

    (told,) = [line for line in said(bench) if line.startswith("crc")]
    assert told == f"crc {crc32(ALL)} {len(ALL)} {ALL[10:30]} {ALL[19:23]} {WORDS[6:11]}"
    bench.close()
