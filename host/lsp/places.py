"""Places of a script as an editor counts them: lines from 0, columns in the units that both have agreed on.

Columns of the gait language count characters; those of editors mostly count UTF-16 units, in which a character beyond
the first 65,536 is two.
"""

from __future__ import annotations

from collections.abc import Sequence

from lsprotocol.types import Position, Range
from pygls.workspace import PositionCodec

from host.gait.tree import Place


class Columns:
    """Translates places of lines into positions and back; what lies outside is brought to the nearest that is there."""

    def __init__(self, codec: PositionCodec | None = None) -> None:
        self._codec = codec or PositionCodec()

    def range(self, place: Place, lines: Sequence[str]) -> Range:
        """Return the range of a place."""
        number = min(max(place.line, 1), len(lines) or 1)
        line = lines[number - 1] if lines else ""
        start = self._units(line, place.column - 1)
        return Range(
            Position(number - 1, start), Position(number - 1, max(self._units(line, place.end_column - 1), start))
        )

    def column(self, position: Position, lines: Sequence[str]) -> int:
        """Return the number of characters before a position in its line."""
        line = lines[position.line] if position.line < len(lines) else ""
        units = 0
        for count, sign in enumerate(line):
            if units >= position.character:
                return count
            units += self._codec.client_num_units(sign)
        return len(line)

    def whole(self, lines: Sequence[str]) -> Range:
        """Return the range of a whole text."""
        last = lines[-1] if lines else ""
        return Range(Position(0, 0), Position(max(len(lines) - 1, 0), self._units(last, len(last))))

    def _units(self, line: str, characters: int) -> int:
        return int(self._codec.client_num_units(line[: max(characters, 0)]))


def within(place: Place, line: int, column: int) -> bool:
    """Return whether a cursor before character `column`, from 0, of a line, from 1, is in or at the end of a place."""
    return place.line == line and place.column - 1 <= column <= place.end_column - 1
