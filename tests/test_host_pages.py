"""A text that is read from the robot page by page, over good lines and bad ones."""

import random

import pytest

from host.pages import PAGE_MAX, PAGE_MIN, Pages

TEXT = random.Random(1).randbytes(5000)
TRIP_MS = 10


def read(pages, text=TEXT, lost=lambda offset, count: False, until_ms=60_000):
    """Read the text over a line that loses pages as told; return the time it took and the questions."""
    now_ms, on_way, asked = 0, [], []
    while not pages.complete and now_ms < until_ms:
        for offset, count in pages.due(now_ms):
            asked.append((offset, count))
            if not lost(offset, count):
                on_way.append((now_ms + TRIP_MS, offset, text[offset : offset + count]))
        now_ms += 5
        for arrival in [arrival for arrival in on_way if arrival[0] <= now_ms]:
            on_way.remove(arrival)
            pages.take(arrival[1], arrival[2], now_ms)
    return now_ms, asked


def test_over_a_good_line_each_page_is_asked_for_once():
    pages = Pages(len(TEXT))

    time_ms, asked = read(pages)

    assert pages.text == TEXT
    assert len(asked) == len(TEXT) // PAGE_MAX
    assert time_ms <= 100


@pytest.mark.parametrize("seed", range(10))
def test_a_line_that_loses_every_long_page_is_read_in_short_ones(seed):
    draw, pages = random.Random(seed), Pages(len(TEXT))

    time_ms, _ = read(pages, lost=lambda offset, count: draw.random() > 0.995 ** (count + 40))

    assert pages.text == TEXT
    assert time_ms < 5000


def test_pages_never_shrink_below_the_least_and_grow_again():
    pages = Pages(len(TEXT))
    trials = iter(range(10**6))

    _, asked = read(pages, lost=lambda offset, count: next(trials) < 40)

    counts = [count for _, count in asked]
    assert min(counts[:40]) == PAGE_MIN
    assert max(counts[40:]) > 2 * PAGE_MIN


def test_a_lost_page_is_asked_for_again_as_soon_as_a_later_one_has_come():
    pages = Pages(1000)
    (first, _), (second, count), *_ = pages.due(0)

    pages.take(second, TEXT[second : second + count], 10)

    assert pages.due(10)[0] == (first, PAGE_MAX // 2)


def test_without_any_answer_a_page_is_asked_for_again_after_a_quarter_of_a_second():
    pages = Pages(100)
    pages.due(0)

    assert pages.due_ms() == 250
    assert pages.due(249) == []
    assert pages.due(250) == [(0, 50), (50, 50)]


def test_a_slow_line_is_waited_for_longer():
    pages = Pages(2000)
    asked = pages.due(0)

    pages.take(asked[0][0], TEXT[:PAGE_MAX], 500)

    assert pages.due_ms() == 1020


def test_a_text_of_unknown_length_ends_with_an_empty_page():
    pages = Pages()

    read(pages, text=TEXT[:1234])

    assert pages.complete
    assert pages.text == TEXT[:1234]


def test_a_text_without_anything_in_it_is_complete_at_once():
    pages = Pages()

    read(pages, text=b"")

    assert pages.text == b""


def test_pages_that_nobody_asked_for_beyond_the_end_change_nothing():
    pages = Pages(100)

    assert not pages.take(50, bytes(51), 0)
    assert not pages.take(100, b"", 0)
    assert not pages.complete


def test_a_page_that_comes_twice_is_nothing_new():
    pages = Pages(100)
    pages.due(0)

    assert pages.take(0, TEXT[:60], 5)
    assert not pages.take(0, TEXT[:60], 6)
    assert pages.due(6) == [(60, 40)]
