"""The bench as a bus of python-can: interface "softrig", on virtual time.

    with can.Bus(interface="softrig", channel="circular@1,sphere-b@2", bitrate=500_000) as bus:
        bus.send(can.Message(arbitration_id=0x123, data=b"hello", is_extended_id=False))
        message = bus.recv(timeout=1.0)         # one virtual second at most, however long that takes
        bus.benches[2].observe()
        other = can.Bus(interface="softrig", desk=bus.desk)

A channel is described in desk.py; an empty one is a bus without robots. Waiting in `recv` is what lets time pass,
for the robots, too; `recv(0)` takes none. Error frames are those of host.py. The robots' controllers are classic:
they destroy frames of CAN FD, which hosts with fd=True can exchange where there is no robot.
"""

import threading
import weakref
from math import ceil
from typing import Any

from can import BusABC, BusState, CanInitializationError, CanOperationError, CanProtocol, Message
from can.broadcastmanager import CyclicSendTaskABC
from can.typechecking import AutoDetectedConfig, CanFilters

from hil_sim.bench import Bench
from hil_sim.can.desk import CanDesk, addresses
from hil_sim.can.host import CanHost
from hil_sim.can.messages import frame_of, message_of
from hil_sim.can.periodic import PeriodicTask
from hil_sim.interrupts import interrupts_deferred
from hil_sim.robots.file import names

PATIENCE_US = 1_000_000  # virtual time between two looks at the keyboard while nothing is due


class SoftrigBus(BusABC):
    """A host on the CAN bus of a desk of robots; other hosts join it with `desk`.

    Options beyond those of the bus are those of an address, for every robot of the channel: slope=10, seed=2. `node` is
    the number of a robot that somebody will look for: the last robot without a number gets it, unless another has it.
    """

    repeatable = True  # what happens is a function of what was asked for, on any machine
    takes_node = True

    def __init__(
        self,
        channel: str | None = "",
        can_filters: CanFilters | None = None,
        bitrate: int = 500_000,
        fd: bool = False,
        data_bitrate: int = 2_000_000,
        receive_own_messages: bool = False,
        listen_only: bool = False,
        desk: CanDesk | None = None,
        node: int = 0,
        **options: Any,
    ) -> None:
        self._thread = threading.get_ident()
        self._own = receive_own_messages
        try:
            with interrupts_deferred(None):
                self.desk = desk or CanDesk(addresses(channel or "", int(node), **options))
            self._host = self.desk.host(int(bitrate), listen_only, int(data_bitrate) if fd else 0)
        except (ValueError, LookupError, OSError, ArithmeticError) as error:
            raise CanInitializationError(str(error)) from error
        self._end = weakref.finalize(self, _leave, self.desk, self._host)
        self.channel_info = f"softrig {self.desk.channel}"
        self._can_protocol = CanProtocol.CAN_FD if fd else CanProtocol.CAN_20
        super().__init__(self.desk.channel, can_filters)

    @property
    def benches(self) -> dict[int, Bench]:
        """The robots by their numbers, to be watched from outside."""
        return self.desk.benches

    def now_s(self) -> float:
        """Return virtual time."""
        return self.desk.clock.now_us / 1e6

    def recv(self, timeout: float | None = None) -> Message | None:
        """Return the next message, or None when `timeout` virtual seconds have passed; None waits for ever."""
        self._check()
        clock = self.desk.clock
        until_us = None if timeout is None else clock.now_us + _whole_us(timeout)
        while (message := self._next()) is None:
            if until_us is not None and clock.now_us >= until_us:
                return None
            with interrupts_deferred(clock):
                self.desk.run(clock.now_us + PATIENCE_US if until_us is None else until_us, self._host)
        return message

    def send(self, msg: Message, timeout: float | None = None) -> None:
        """Queue a message; when the queue is full, wait up to `timeout` virtual seconds for room.

        ValueError for a message that no frame can be, CanOperationError when there is no room.
        """
        self._check()
        frame, clock = frame_of(msg), self.desk.clock
        until_us = clock.now_us + _whole_us(timeout or 0)
        while not self._host.room and clock.now_us < until_us:
            with interrupts_deferred(clock):
                self.desk.run(until_us, self._host)
        if not self._host.room:
            raise CanOperationError("the queue is full: nobody acknowledges, or the bus is busy")
        self._host.send(frame)

    def flush_tx_buffer(self) -> None:
        """Drop what waits to be sent."""
        self._host.drop_waiting()

    @property
    def state(self) -> BusState:
        """The state of the host's own controller; ERROR is bus-off, from which it comes back by itself."""
        errors = self._host.errors
        return BusState.ERROR if errors.bus_off else BusState.PASSIVE if errors.passive else BusState.ACTIVE

    @state.setter
    def state(self, new_state: BusState) -> None:
        """Refuse: errors make the state."""
        raise NotImplementedError("errors make the state of a controller, nobody else")

    def shutdown(self) -> None:
        """Leave the bus; the last host takes the robots with it."""
        super().shutdown()
        self._end()

    def _next(self) -> Message | None:
        while (happened := self._host.take()) is not None:
            message = message_of(happened, self.desk.channel)
            if (message.is_rx or self._own) and (message.is_error_frame or self._matches_filters(message)):
                return message
        return None

    def _check(self) -> None:
        if not self._end.alive:
            raise CanOperationError("the bus is shut down")
        if threading.get_ident() != self._thread:
            raise CanOperationError("a bus on virtual time belongs to the thread that opened it: no Notifier here")

    def _send_periodic_internal(self, msgs: Any, period: float, *options: Any, **named: Any) -> CyclicSendTaskABC:
        return PeriodicTask(self, self.desk.clock, msgs, period, *options, **named)

    @staticmethod
    def _detect_available_configs() -> list[AutoDetectedConfig]:
        return [{"interface": "softrig", "channel": name} for name in names()]


def _leave(desk: CanDesk, host: CanHost) -> None:
    if not desk.leave(host):
        desk.close()


def _whole_us(seconds: float) -> int:
    """Return a time to wait in whole microseconds: none only for none, so that who waits in a loop gets there."""
    return max(1, ceil(seconds * 1e6 - 1e-3)) if seconds > 0 else 0
