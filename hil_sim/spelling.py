"""Words of a file or an address: which one was meant, and whether it stands for several things."""

from collections.abc import Collection
from difflib import get_close_matches


def near(word: str, known: Collection[str]) -> str:
    """Return "; did you mean X?" if one of the known words is like it."""
    match = get_close_matches(word, sorted(known), 1)
    return f"; did you mean {match[0]}?" if match else ""


def many(word: str) -> bool:
    """Return whether this is a word for several things."""
    return word.endswith("s") and not word.endswith("ss")
