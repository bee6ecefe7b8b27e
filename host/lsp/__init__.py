"""The language server: what an editor shows of gait scripts while they are written.

`server.py` speaks the protocol; everything else works on texts and knows no message of it but positions. What is true
of a script is asked of `host.gait` and of the script's robot: nothing of the language is told here a second time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from host.errors import BadRequest

if TYPE_CHECKING:
    from host.lsp.server import GaitServer


def open_server(robot: str | None, key: bytes = b"") -> GaitServer:
    """Return a server for scripts of the robot at an address, else of each its own; BadRequest without pygls."""
    try:
        from host.lsp.desk import Desk  # noqa: PLC0415
        from host.lsp.robots import Robots  # noqa: PLC0415
        from host.lsp.server import make_server  # noqa: PLC0415
    except ImportError as error:
        raise BadRequest("softrig lsp needs pygls: pip install 'softrig[lsp]'") from error
    return make_server(Desk(Robots(key), robot))
