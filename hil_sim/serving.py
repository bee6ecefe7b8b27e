"""Robots of the bench behind real ports, in real time, until the operator ends it: what `softrig sim` does.

    with Serving("circular", desk, Path("robot"), ("127.0.0.1", 7000)) as serving:
        serving.can("slcan", "")
        serving.run(speed=1.0, say=print)

Each robot has a pseudo-terminal of its own; a link and a TCP port belong to the one with the lowest number. CAN ports
are of all.
"""

import signal
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from hil_sim.announcement import Announcement
from hil_sim.can.desk import CanDesk
from hil_sim.can.ports import SlcanPort, SocketcandPort
from hil_sim.ports import End, Pace, Port, Pty, SerialEnd, Tcp, serve

SOCKETCAND_PORT = 29_536  # socketcand's own
Say = Callable[[dict[str, Any], str], None]


class Serving:
    """The robots of a desk with their ports; PortError when one cannot be made."""

    def __init__(self, name: str, desk: CanDesk, link: Path | None, tcp: tuple[str, int] | None) -> None:
        self._desk = desk
        self._stack = ExitStack()
        self._ends: list[End] = []
        self._where: dict[str, Any] = {"robot": name, "pty": None, "link": str(link.absolute()) if link else None}
        try:
            self._lay_lines(link, tcp)
        except BaseException:
            self._stack.close()
            raise

    def can(self, kind: str, argument: str) -> None:
        """Serve the bus as "slcan", at a link, or "socketcand", at a port."""
        port: SlcanPort | SocketcandPort
        if kind == "slcan":
            port = self._stack.enter_context(SlcanPort(self._desk, Path(argument) if argument else None))
        else:
            port = self._stack.enter_context(SocketcandPort(self._desk, int(argument or SOCKETCAND_PORT)))
        self._ends.append(port)
        self._where.setdefault("can", []).extend(f"{port.address}@{number}" for number in sorted(self._desk.benches))

    def run(self, speed: float, say: Say) -> None:
        """Say where everything is, serve until a signal comes, and say what was observed of each robot."""
        ended = _until_a_signal(self._stack)
        self._stack.enter_context(Announcement(self._where))
        say({"event": "listening", **self._where, "speed": speed}, self._told())
        pace = Pace(speed)
        serve(self._desk.clock, self._ends, pace, ended)
        for number, bench in sorted(self._desk.benches.items()):
            which = {"node": number} if len(self._desk.benches) > 1 else {}
            seen = {**which, **bench.observe(), "slipped_s": round(pace.slipped_s, 3)}
            told = [f"{key}: {_short(value)}" for key, value in seen.items() if value != {}]
            say({"event": "observed", **seen}, "\n".join(told))

    def _lay_lines(self, link: Path | None, tcp: tuple[str, int] | None) -> None:
        for number, bench in sorted(self._desk.benches.items()):
            first = not self._ends
            pty = self._stack.enter_context(Pty(link if first else None))
            ports: list[Port] = [pty]
            if first and tcp is not None:
                server = self._stack.enter_context(Tcp(tcp[1], tcp[0]))
                ports.append(server)
                self._where["tcp"] = f"socket://{f'[{tcp[0]}]' if ':' in tcp[0] else tcp[0]}:{server.port}"
            if len(self._desk.benches) > 1:
                self._where.setdefault("ptys", {})[number] = pty.path
            self._where["pty"] = self._where["pty"] or pty.path
            self._ends.append(SerialEnd(bench, ports))

    def _told(self) -> str:
        where = self._where
        places = ", ".join(str(where[key]) for key in ("link", "pty", "tcp") if where.get(key))
        lines = [f"{where['robot']} listens on {places}; Ctrl-C ends it"]
        lines += [f"robot {number}: --robot {path}" for number, path in where.get("ptys", {}).items()]
        lines += [f"on CAN: --robot {address}" for address in where.get("can", ())]
        return "\n".join(lines)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._stack.close()


def _until_a_signal(stack: ExitStack) -> Callable[[], bool]:
    """Return a function that says whether the operator has ended the bench; handlers are put back with the stack."""
    came: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        before = signal.signal(number, lambda number, _: came.append(number))
        stack.callback(signal.signal, number, before)
    return lambda: bool(came)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, dict):
        return " ".join(f"{key}={_short(item)}" for key, item in value.items())
    if isinstance(value, list) and value:
        return ", ".join(map(_short, value))
    return str(value)
