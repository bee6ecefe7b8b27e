"""One handler for each message that a host may send.

A handler changes something and returns, or raises Refused with the code and the limit; nothing that arrives can raise
anything else. Requests are answered with `ok`, `refused` or their own answer, under the number of their frame.
"""

from binascii import crc32

from firmware.channels import Refused
from protocol import codes, frames, messages, program

PAGE = 200  # bytes of dictionary text in an answer
FIGURE_MAX = 0x7FFFFFFF  # that an answer can carry: what a host sent may be greater


class Commands:
    """Serves what the link delivers."""

    def __init__(self, core) -> None:
        self.outlives_host = False  # the uploaded program runs on when the lease runs out
        self._core = core
        self._header = None
        self._code = bytearray(0)
        self._unseeded = ((messages.HELLO, self._hello), (messages.DICTIONARY, self._dictionary))
        self._requests = (
            (messages.ARM, self._arm), (messages.DISARM, self._disarm), (messages.CLEAR, self._clear),
            (messages.FIRE, self._fire), (messages.STATUS_REQUEST, self._status),
            (messages.SUBSCRIBE, self._subscribe), (messages.PROGRAM, self._program), (messages.CODE, self._piece),
            (messages.START, self._start), (messages.CANCEL, self._cancel),
        )  # fmt: skip

    def serve(self, received) -> None:
        """Serve one received frame."""
        if received.kind < frames.UNSEEDED_BELOW:
            self._serve_unseeded(received)
            return
        try:
            handler, order = self._understood(received)
            answered = handler(order, received.seq)
        except Refused as refused:
            self._answer(
                messages.REFUSED, request=received.seq, code=refused.code, channel=refused.channel,
                value=min(refused.value, FIGURE_MAX), limit=min(refused.limit, FIGURE_MAX),
            )  # fmt: skip
            return
        if not answered:
            self._answer(messages.OK, request=received.seq)

    def stopped(self, coils: int) -> None:
        """Say that the stop pattern arrived and every coil is off."""
        core = self._core
        now = core.now_ms & 0xFFFFFFFF
        payload = messages.STOPPED.pack(state=core.state, code=core.code, coils=coils, now_ms=now)
        core.link.post(messages.STOPPED.number, payload)

    def _serve_unseeded(self, received) -> None:
        for message, handler in self._unseeded:
            if message.number == received.kind:
                try:
                    handler(message.unpack(received.payload))
                except ValueError:
                    self._nak(received.kind, codes.BAD_PAYLOAD)
                return
        self._nak(received.kind, codes.UNKNOWN_MESSAGE)

    def _understood(self, received) -> tuple:
        for message, handler in self._requests:
            if message.number == received.kind:
                try:
                    return handler, message.unpack(received.payload)
                except ValueError:
                    raise Refused(codes.BAD_PAYLOAD, 255, len(received.payload)) from None
        raise Refused(codes.UNKNOWN_MESSAGE, 255, received.kind)

    def _hello(self, hello) -> None:
        core = self._core
        if hello.version != frames.VERSION:
            self._nak(messages.HELLO.number, codes.OTHER_VERSION)
            return
        free = core.lease_left_ms() == 0 or hello.session == core.session
        if free and hello.session != core.session:
            core.session = hello.session
            core.link.reset(core.link.decoder.seed)
            core.reports.period_ms = 0
        identity = messages.IDENTITY.pack(
            session=hello.session, boot=core.boot, dictionary_crc=core.link.decoder.seed,
            dictionary_bytes=len(core.dictionary), version=frames.VERSION, state=core.state,
            role=messages.HOLDER if free else messages.VIEWER, firmware=core.version,
        )  # fmt: skip
        core.link.post(messages.IDENTITY.number, identity)

    def _dictionary(self, asked) -> None:
        page = self._core.dictionary[asked.offset : asked.offset + PAGE]
        payload = messages.DICTIONARY_PAGE.pack(offset=asked.offset, text=page)
        self._core.link.post(messages.DICTIONARY_PAGE.number, payload)

    def _arm(self, order, seq: int) -> None:
        core = self._core
        lease_ms = order.lease_ms or core.profile.lease_ms
        if order.session != core.session:
            raise Refused(codes.LEASE_HELD)
        if lease_ms > core.profile.lease_max_ms:
            raise Refused(codes.LEASE_LIMIT, 255, lease_ms, core.profile.lease_max_ms)
        self._not_running()
        self._not_tripped()
        core.arm(lease_ms)

    def _disarm(self, order, seq: int) -> None:
        self._core.disarm()

    def _clear(self, order, seq: int) -> None:
        if self._core.state == messages.TRIPPED and not self._core.clear():
            raise Refused(codes.CAUSE_REMAINS, self._core.guard.channel, self._core.guard.value)

    def _fire(self, order, seq: int) -> None:
        self._not_running()
        self._armed()
        core = self._core
        core.channels.fire(order.coils, order.duty_permille, order.hold_ms, core.now_ms)

    def _subscribe(self, order, seq: int) -> None:
        self._core.reports.period_ms = order.period_ms

    def _status(self, order, seq: int) -> bool:
        core = self._core
        self._answer(
            messages.STATUS, request=seq, state=core.state, code=core.code, uptime_ms=core.now_ms & 0xFFFFFFFF,
            lease_ms=core.lease_left_ms(), step=core.player.step, coils=core.channels.on_mask,
            supply_mv=core.sense.supply_mv, current_ma=core.sense.current_ma,
            board_decidegc=core.sense.board_decidegc, dropped=core.link.decoder.dropped & 0xFFFF,
            overruns=core.overruns & 0xFFFF,
        )  # fmt: skip
        return True

    def _program(self, order, seq: int) -> None:
        self._not_running()
        try:
            header = program.read_header(order.header)
        except program.BadProgram:
            raise Refused(codes.BAD_HEADER) from None
        if header.robot_crc != self._core.profile.crc:
            raise Refused(codes.OTHER_ROBOT)
        if header.length > self._core.profile.program_bytes_max:
            raise Refused(codes.TOO_LARGE, 255, header.length, self._core.profile.program_bytes_max)
        self._header = header
        self._code = bytearray(header.length)

    def _piece(self, order, seq: int) -> None:
        self._not_running()
        end = order.offset + len(order.code)
        if self._header is None:
            raise Refused(codes.NO_PROGRAM)
        if end > len(self._code):
            raise Refused(codes.TOO_LARGE, 255, end, len(self._code))
        self._code[order.offset : end] = order.code

    def _start(self, order, seq: int) -> None:
        core = self._core
        self._not_running()
        self._armed()
        if self._header is None:
            raise Refused(codes.NO_PROGRAM)
        if crc32(self._code) != self._header.crc:
            raise Refused(codes.BAD_CODE, 255, len(self._code))
        try:
            program.check_code(self._code, core.channels.count, core.profile.program_bytes_max)
        except program.BadProgram as bad:
            raise Refused(codes.BAD_CODE, 255, bad.at) from None
        self.outlives_host = self._header.flags & program.OUTLIVES_HOST != 0
        core.start(self._code)

    def _cancel(self, order, seq: int) -> None:
        if self._core.state == messages.RUNNING:
            self._core.end_program(messages.ABORTED)

    def _armed(self) -> None:
        self._not_tripped()
        if self._core.state not in (messages.ARMED, messages.RUNNING):
            raise Refused(codes.NOT_ARMED)

    def _not_tripped(self) -> None:
        if self._core.state == messages.TRIPPED:
            raise Refused(codes.TRIPPED, 255, self._core.code)

    def _not_running(self) -> None:
        if self._core.state == messages.RUNNING:
            raise Refused(codes.BUSY)

    def _answer(self, message, **fields) -> None:
        """Send an answer; a host that acknowledges nothing goes without."""
        link = self._core.link
        if link.room():
            link.send(message.number, message.pack(**fields), self._core.now_ms)

    def _nak(self, kind: int, code: int) -> None:
        payload = messages.NAK.pack(kind=kind, code=code, version=frames.VERSION)
        self._core.link.post(messages.NAK.number, payload)
