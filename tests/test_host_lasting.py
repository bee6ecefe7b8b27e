"""A line that breaks and is opened again, on a virtual clock."""

import pytest

from host.errors import LinkLost, PortAbsent
from host.lasting import LastingLink, can_last


class Cable:
    """A line on a virtual clock that is plugged in at some times; `tries` are the times at which it was opened."""

    observer = None

    def __init__(self, absent=()):
        self.absent = absent  # spans of time in which the port is not there
        self.time_s = 0.0
        self.tries = []
        self.written = []
        self.broken = self.closed = False

    def now_s(self):
        return self.time_s

    def there(self):
        return not any(since <= self.time_s < until for since, until in self.absent)

    def write(self, data):
        self._check()
        self.written.append(data)

    def read(self, until_s):
        self._check()
        self.time_s = min([until_s, *(since for since, _ in self.absent if since > self.time_s)])
        self._check()
        return b"x" if self.time_s < until_s else b""

    def pause(self, until_s):
        self.time_s = max(self.time_s, until_s)

    def reopen(self):
        self.tries.append(round(self.time_s, 6))
        if not self.there():
            raise PortAbsent("no port")
        self.broken = False
        return self

    def close(self):
        self.closed = True

    def _check(self):
        self.broken = self.broken or not self.there()
        if self.broken:
            raise LinkLost("unplugged")


def serve(link, until_s):
    while link.now_s() < until_s:
        link.read(min(until_s, link.now_s() + 0.1))


def test_a_line_is_tried_again_after_longer_and_longer_times():
    cable = Cable(absent=[(0, 5)])
    link = LastingLink(cable, patience_s=10)

    serve(link, 6)

    assert cable.tries == pytest.approx([0.05, 0.15, 0.35, 0.75, 1.55, 2.55, 3.55, 4.55, 5.55])


def test_a_line_that_is_back_goes_on():
    cable = Cable(absent=[(1, 1.3)])
    link = LastingLink(cable, patience_s=10)

    serve(link, 2)
    link.write(b"again")

    assert link.cause is None
    assert link.reopened == 1
    assert cable.written == [b"again"]


def test_what_is_written_to_a_broken_line_is_lost_and_raises_nothing():
    cable = Cable(absent=[(0, 0.5)])
    link = LastingLink(cable, patience_s=10)

    link.write(b"lost")
    link.write(b"lost")

    assert str(link.cause) == "unplugged"
    assert cable.written == []


def test_a_reading_of_a_broken_line_ends_at_its_deadline():
    link = LastingLink(Cable(absent=[(0, 100)]), patience_s=50)
    serve(link, 3)

    link.read(3.01)

    assert link.now_s() == pytest.approx(3.01)


def test_patience_ends_with_the_reason_of_the_break():
    link = LastingLink(Cable(absent=[(1, 100)]), patience_s=3)

    with pytest.raises(LinkLost, match="unplugged"):
        serve(link, 60)

    assert link.now_s() == pytest.approx(4, abs=0.1)


def test_each_break_has_its_own_patience_and_its_own_first_try():
    cable = Cable(absent=[(1, 2.9), (5, 6.9)])
    link = LastingLink(cable, patience_s=3)

    serve(link, 10)

    assert link.reopened == 2
    assert 5.05 in cable.tries


def test_only_a_line_that_can_be_opened_again_can_last():
    assert can_last(Cable())
    assert not can_last(object())
