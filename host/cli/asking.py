"""Lines that an operator types while a program runs, without waiting for them where a robot must hear its host."""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Callable

from host.errors import BadRequest
from host.stepping import QUIT

PIECE = 4096


def typed_lines(waits: bool) -> Callable[[], str | None]:
    """Return what gives the next line that was typed, None if there is none yet unless it `waits`.

    BadRequest when nobody can type. The end of the input, typed as Ctrl-D, is the line that ends the program.
    """
    if sys.stdin is None or sys.stdin.closed or not sys.stdin.isatty():
        raise BadRequest("--step asks for a key at each step: stdin is no terminal on which one can be pressed")
    number, typed = sys.stdin.fileno(), bytearray()

    def read() -> str | None:
        while b"\n" not in typed:
            if not waits and not select.select([number], [], [], 0)[0]:
                return None
            piece = os.read(number, PIECE)
            if not piece:
                return QUIT
            typed.extend(piece)
        line, _, rest = bytes(typed).partition(b"\n")
        typed[:] = rest
        return line.decode(errors="replace")

    return read
