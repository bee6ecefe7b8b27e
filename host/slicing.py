"""Takes slices of a body from an observer that sees inside it, at even times and where a program begins and ends.

A slice is dear (70 kB of a log), so it is taken five times a second at first and more seldom later, see `Rhythm`, and
one in which nothing has changed is kept at the ends only, and before the next change. numpy is imported with the first.

    slicing = Slicing(observer, keep)
    slicing.look(host_ms)                   # as often as time passes
    slicing.take(host_ms)                   # now
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from host.fields import Mesh, Slice

EVERY_MS = 200  # from slice to slice, at first
MOST = 256  # slices of one rhythm; the next has half its speed, so that hours of waiting stay small


class Rhythm:
    """Says when the next slice is due, so that slices lie at even times since the first."""

    def __init__(self, every_ms: int = EVERY_MS) -> None:
        self._every_ms, self._count = every_ms, 0
        self._due_ms: int | None = None

    def restart(self, host_ms: int) -> None:
        """Count from now on, as one was just taken."""
        self._due_ms = host_ms + self._every_ms

    def due(self, host_ms: int) -> bool:
        """Return whether a slice is due, and if so expect the next one."""
        if self._due_ms is not None and host_ms < self._due_ms:
            return False
        late_ms = 0 if self._due_ms is None else (host_ms - self._due_ms) % self._every_ms
        self._count += 1
        if self._count % MOST == 0:
            self._every_ms *= 2
        self._due_ms = host_ms - late_ms + self._every_ms
        return True


class Keeps(Protocol):
    """Whoever keeps slices."""

    def __call__(self, mesh: Mesh, taken: Slice) -> None:
        """Keep a slice over its mesh, which is the same each time."""


class Slicing:
    """Takes slices for `keep`; nothing of an observer that has no fields."""

    def __init__(self, observer: Any, keep: Keeps, every_ms: int = EVERY_MS) -> None:
        self._observer: Any = observer if hasattr(observer, "fields") else None
        self._keep = keep
        self._mesh: Mesh | None = None
        self._last: Slice | None = None
        self._unchanged: Slice | None = None  # since then, and not kept
        self._rhythm = Rhythm(every_ms)

    def look(self, host_ms: int) -> None:
        """Take a slice if one is due."""
        if self._observer is not None and self._rhythm.due(host_ms):
            self._take(host_ms, anyway=False)

    def take(self, host_ms: int) -> None:
        """Take a slice now, and count the next ones from it."""
        if self._observer is not None:
            self._rhythm.restart(host_ms)
            self._take(host_ms, anyway=True)

    def _take(self, host_ms: int, anyway: bool) -> None:
        """Take a slice if time has passed for the body since the last one, and if it changed, or anyway."""
        t_s = self._observer.snapshot()["t_s"]
        if self._last is not None and t_s == self._last.t_s:
            return
        fields = self._observer.fields()
        if fields is None:
            self._observer = None
            return
        from host.fields import mesh_of, same, slice_of  # noqa: PLC0415  (numpy, which most runs do not need)

        self._mesh, taken = self._mesh or mesh_of(fields), slice_of(fields, t_s, host_ms)
        changed = self._last is None or not same(self._last, taken)
        if changed and self._unchanged is not None:
            self._keep(self._mesh, self._unchanged)
        self._unchanged = None if changed or anyway else taken
        if changed or anyway:
            self._last = taken
            self._keep(self._mesh, taken)
