"""The cache of dictionaries: never wrong, never in the way."""

import os
from binascii import crc32

import pytest

from host.dictionaries import KEPT_MAX, Dictionaries, Unknown, cache_folder

TEXT = b"1 hello version:B\n\n{}"


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "cache" / "softrig"


def found(dictionaries, text=TEXT):
    return dictionaries.find(crc32(text), len(text))


def test_a_dictionary_is_found_again_by_a_later_program(folder):
    Dictionaries(folder).keep(TEXT)

    assert found(Dictionaries(folder)) == TEXT


def test_an_unknown_dictionary_is_not_found(folder):
    assert found(Dictionaries(folder)) is None


@pytest.mark.parametrize("damage", [lambda text: text[:-1], lambda text: b"2" + text[1:], lambda text: b""])
def test_a_damaged_file_is_not_found_and_is_mended_by_the_next_reading(folder, damage):
    dictionaries = Dictionaries(folder)
    dictionaries.keep(TEXT)
    (file,) = folder.iterdir()
    file.write_bytes(damage(TEXT))

    assert found(dictionaries) is None
    dictionaries.keep(TEXT)
    assert found(dictionaries) == TEXT


def test_a_text_with_the_same_checksum_and_another_length_is_not_found(folder):
    dictionaries = Dictionaries(folder)
    dictionaries.keep(TEXT)

    assert dictionaries.find(crc32(TEXT), len(TEXT) + 1) is None


def test_a_folder_that_cannot_be_made_is_no_error(tmp_path):
    (tmp_path / "file").write_text("")
    dictionaries = Dictionaries(tmp_path / "file" / "softrig")

    dictionaries.keep(TEXT)

    assert found(dictionaries) is None


def test_a_disk_that_is_full_leaves_no_piece_behind(folder, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "write", full)
    Dictionaries(folder).keep(TEXT)

    assert list(folder.iterdir()) == []


def test_a_directory_in_the_place_of_a_file_is_no_error(folder):
    (folder / f"{crc32(TEXT):08x}.dictionary").mkdir(parents=True)
    dictionaries = Dictionaries(folder)

    dictionaries.keep(TEXT)

    assert found(dictionaries) is None


def test_the_dictionaries_not_used_for_longest_give_way(folder):
    dictionaries = Dictionaries(folder)
    texts = [b"%d" % number for number in range(KEPT_MAX + 1)]
    for age, text in enumerate(texts[:-1]):
        dictionaries.keep(text)
        os.utime(folder / f"{crc32(text):08x}.dictionary", (age, age))

    assert found(dictionaries, texts[0]) == texts[0]
    dictionaries.keep(texts[-1])

    assert found(dictionaries, texts[0]) == texts[0]
    assert found(dictionaries, texts[1]) is None


def test_a_line_that_must_repeat_itself_remembers_nothing():
    dictionaries = Unknown()

    dictionaries.keep(TEXT)

    assert found(dictionaries) is None
    assert found(Dictionaries(None)) is None


def test_the_cache_lies_where_the_user_keeps_caches(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path))
    for named, expected in ((str(tmp_path / "x"), tmp_path / "x"), ("relative", tmp_path / ".cache"), ("", None)):
        monkeypatch.setenv("XDG_CACHE_HOME", named)
        assert cache_folder() == (expected or tmp_path / ".cache") / "softrig"


def test_a_user_without_a_home_has_no_cache(monkeypatch):
    def homeless():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr("pathlib.Path.home", homeless)

    assert cache_folder() is None
    Dictionaries(cache_folder()).keep(TEXT)
