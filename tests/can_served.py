"""A CAN desk served in real time by a thread, with somebody on the bus who answers."""

import threading
from contextlib import contextmanager
from dataclasses import replace

from hil_sim.can.desk import CanDesk
from hil_sim.can.host import CanHost, Heard
from hil_sim.devices.canframe import Frame
from hil_sim.ports import Pace, serve

PATIENCE_S = 30


def frames_heard(node: CanHost) -> list[Frame]:
    """Return the frames of others that a node has heard since this was asked."""
    got = []
    while (happened := node.take()) is not None:
        got += [happened.frame] if isinstance(happened, Heard) and not happened.own else []
    return got


class Echo:
    """Answers each frame of an even identifier with the same one under the next."""

    def __init__(self, desk: CanDesk) -> None:
        self._host = desk.host(500_000)

    def handles(self):
        return []

    def exchange(self):
        while (happened := self._host.take()) is not None:
            if isinstance(happened, Heard) and not happened.own and happened.frame.id % 2 == 0:
                self._host.send(replace(happened.frame, id=happened.frame.id + 1))


@contextmanager
def serving(desk: CanDesk, *ends):
    """Serve as long as the context lasts."""
    ended = threading.Event()
    thread = threading.Thread(target=serve, args=(desk.clock, ends, Pace(1.0), ended.is_set))
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join(PATIENCE_S)


def next_frame(bus):
    """Return the next message that is no error frame."""
    while (message := bus.recv(PATIENCE_S)) is not None:
        if not message.is_error_frame:
            return message
    raise TimeoutError("no frame")
