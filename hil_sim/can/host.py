"""A host's CAN controller on the bench: what reaches it and what goes wrong, in order and each with its time.

Errors are told as Linux tells them (include/uapi/linux/can/error.h): a class and eight bytes, the last two of which are
the error counters. One is told whenever an error has changed a counter: so of a frame that nobody acknowledges it is
told until its sender is error-passive, and not for ever. After bus-off the controller comes back by itself.

    host = CanHost(wire, clock, 500_000)
    host.send(Frame(0x123, b"hello"))
    clock.run_until(1_000)
    host.take()         # Heard(...), Trouble(...), or None
"""

from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from hil_sim.clock import Clock
from hil_sim.devices.canerrors import PASSIVE_ABOVE, WARNING
from hil_sim.devices.canframe import Frame
from hil_sim.devices.canstation import CanStation
from hil_sim.devices.canwire import CanWire

CONTROLLER, PROTOCOL, NOT_ACKNOWLEDGED, BUS_OFF, BUS_ERROR, RESTARTED, COUNTERS = (
    0x004,
    0x008,
    0x020,
    0x040,
    0x080,
    0x100,
    0x200,
)  # fmt: skip  (classes)
RECEIVE_OVERFLOW, RECEIVE_WARNING, SEND_WARNING, RECEIVE_PASSIVE, SEND_PASSIVE, ACTIVE = (
    1 << n for n in (0, 2, 3, 4, 5, 6)
)
WHILE_SENDING = 0x80
KEPT_MAX = 4096  # things that wait to be taken; as many as that are lost
WAITING_MAX = 128  # frames that wait to be sent
_COUNT_MAX = 255


class Heard(NamedTuple):
    """A frame that has arrived, or an own one that was acknowledged."""

    time_us: int
    frame: Frame
    own: bool = False


class Trouble(NamedTuple):
    """An error frame: its class and its eight bytes."""

    time_us: int
    kind: int
    detail: bytes


class CanHost(CanStation):
    """One controller on `wire`; `alarm`, where set, is called whenever there is something to take."""

    def __init__(
        self, wire: CanWire, clock: Clock, bitrate_hz: int, silent: bool = False, data_bitrate_hz: int = 0
    ) -> None:
        self.alarm: Callable[[], None] | None = None
        self.overruns = 0
        self._clock = clock
        self._happened: deque[Heard | Trouble] = deque()
        self._told = (0, 0)  # the error counters, as they were told last
        self._level = 0
        self._on_wire = False
        super().__init__(wire, bitrate_hz, silent, data_bitrate_hz)

    def take(self) -> Heard | Trouble | None:
        """Return what happened first of all that was not taken yet."""
        return self._happened.popleft() if self._happened else None

    @property
    def room(self) -> int:
        """How many frames `send` takes now without keeping more than it should."""
        return WAITING_MAX - len(self.waiting)

    def drop_waiting(self) -> None:
        """Forget the frames that wait; one that is on the wire is finished."""
        del self.waiting[int(self._on_wire) :]

    def began(self) -> None:
        """Remember that the first frame is on the wire."""
        self._on_wire = True

    def sent(self) -> None:
        """Take the frame off the queue."""
        self._on_wire = False
        self._note(Heard(self._clock.now_us, self.waiting.pop(0), own=True))
        self._relieve()

    def failed(self) -> None:
        """Tell of it."""
        self._on_wire = False
        super().failed()
        why = NOT_ACKNOWLEDGED if self.errors.unanswered else PROTOCOL
        self._tell(BUS_ERROR | why | (BUS_OFF if self.errors.bus_off else 0), WHILE_SENDING)

    def heard(self, frame: Frame) -> None:
        """Keep it with its time."""
        self._note(Heard(self._clock.now_us, frame))
        self._relieve()

    def garbled(self) -> None:
        """Tell of it."""
        super().garbled()
        self._tell(BUS_ERROR | PROTOCOL, 0)

    def recovered(self) -> None:
        """Tell of it, and go on with the queue."""
        self._level, self._told = 0, (0, 0)
        self._note(Trouble(self._clock.now_us, RESTARTED | COUNTERS, bytes(8)))

    def _tell(self, kind: int, where: int) -> None:
        counters = (min(_COUNT_MAX, self.errors.transmit), min(_COUNT_MAX, self.errors.receive))
        if counters == self._told and not kind & BUS_OFF:
            return
        self._told = counters
        level = self._now_level()
        news = CONTROLLER if level & ~self._level else 0
        self._level = level
        detail = bytes((0, level if news else 0, where, 0, 0, 0, *counters))
        self._note(Trouble(self._clock.now_us, kind | news | COUNTERS, detail))

    def _relieve(self) -> None:
        """After a success: take up the counters, and tell when the last of them has left its warning."""
        self._told = (min(_COUNT_MAX, self.errors.transmit), min(_COUNT_MAX, self.errors.receive))
        before, self._level = self._level, self._now_level()
        if before and not self._level:
            detail = bytes((0, ACTIVE, 0, 0, 0, 0, *self._told))
            self._note(Trouble(self._clock.now_us, CONTROLLER | COUNTERS, detail))

    def _now_level(self) -> int:
        transmit, receive = self.errors.transmit, self.errors.receive
        rows = (
            (SEND_PASSIVE, transmit > PASSIVE_ABOVE),
            (RECEIVE_PASSIVE, receive > PASSIVE_ABOVE),
            (SEND_WARNING, transmit >= WARNING),
            (RECEIVE_WARNING, receive >= WARNING),
        )
        return sum(flag for flag, holds in rows if holds)

    def _note(self, what: Heard | Trouble) -> None:
        if len(self._happened) >= KEPT_MAX:
            self.overruns += 1
            return
        self._happened.append(what)
        if self.alarm is not None:
            self.alarm()
