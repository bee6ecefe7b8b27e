"""One handler for each order that a session may give.

A handler changes something and returns, or raises Refused with the code and the limit; nothing that arrives can raise
anything else. Orders are answered with `ok`, `refused` or their own answer, under the number of their frame.
"""

from firmware.channels import Refused
from firmware.upload import Upload
from protocol import codes, messages, variables

NOT, ON_SYNC = -1, -2


class Commands:
    """Serves what the link delivers in order."""

    def __init__(self, core) -> None:
        self.upload = Upload(core.profile)
        self._core = core
        self._arming = -1  # number of the order that waits for its self-test, -1: none
        self._calibrates = False  # that order; else it arms
        self._lease_ms = 0  # that it asked for
        self._paused = False  # whether the program that waits is to stand at its beginning
        self._at = self._begins = NOT  # when a program does that was verified: the robot's clock, NOT or ON_SYNC
        self._orders = (
            (messages.ARM, self._arm), (messages.DISARM, self._disarm), (messages.CLEAR, self._clear),
            (messages.FIRE, self._fire), (messages.STATUS_REQUEST, self._status),
            (messages.SUBSCRIBE, self._subscribe), (messages.PROGRAM, self._program), (messages.CODE, self._piece),
            (messages.START, self._start), (messages.CANCEL, self._cancel), (messages.COILS_REQUEST, self._coils),
            (messages.CALIBRATE, self._calibrate), (messages.SERVICE, self._service),
            (messages.MOVE, self._move), (messages.ORIENT, self._orient),
            (messages.PRESS, self._press), (messages.PAUSE, self._pause),
        ) + core.records.orders()  # fmt: skip

    def serve(self, received) -> None:
        """Serve one received frame."""
        try:
            handler, order = self._understood(received)
            answered = handler(order, received.seq)
        except Refused as refused:
            self._refuse(received.seq, refused)
            return
        if not answered:
            self.answer(messages.OK, request=received.seq)

    def go_on(self) -> None:
        """Answer an order whose self-test is done, go on verifying a program that waits to be started."""
        if self._arming >= 0 and self._core.control.selftest.done:
            self._tested()
        if self.upload.waits:
            self._verify_some()
        if self._begins >= 0 and self._core.now_ms - self._begins >= 0:
            self._begin()

    def sync(self) -> None:
        """Start the program that waits for this."""
        if self._begins == ON_SYNC:
            self._begin()

    def give_up(self, code: int) -> None:
        """Refuse an order that waits for its self-test, and let no program begin that waits for its time."""
        self._begins = NOT
        if self._arming >= 0:
            self._refuse(self._arming, Refused(code))
            self._arming = -1

    def forget(self, is_taken_over: bool) -> None:
        """Drop what waits for an answer, because nobody is left to be answered; and, unless taken over, to begin."""
        if self._arming >= 0:
            self._core.control.all_off(self._core.now_ms)
        self._arming = self.upload.request = -1
        if not is_taken_over:
            self._begins = NOT

    def _tested(self) -> None:
        """Arm or calibrate after a self-test in which every coil and joint was whole, else refuse with its code."""
        core, test = self._core, self._core.control.selftest
        request, self._arming = self._arming, -1
        without = core.channels.without_mask
        test.done = False
        if test.code or self._calibrates:
            core.control.all_off(core.now_ms)
        try:
            if test.code:
                core.records.note(core.now_ms, test.code, test.channel, test.value, core.was)
                raise Refused(test.code, test.channel, test.value, test.limit)
            if self._calibrates:
                core.records.calibrate(without)
            else:
                core.arm(self._lease_ms)
        except Refused as refused:
            self._refuse(request, refused)
        else:
            self.answer(messages.OK, request=request)

    def _verify(self, request: int) -> None:
        """Verify some more of a program that waits to be started, and start it when all is well."""
        try:
            if not self.upload.go_on():
                return
            self._armed()
            self._has_senses()
            self._senses()
        except Refused as refused:
            self._refuse(request, refused)
        else:
            self.answer(messages.OK, request=request)
            self._core.reports.event(messages.ACCEPTED)
            self._begins = self._at
        self.upload.request = -1

    def _verify_some(self) -> None:
        """Verify what has come: for the start that asked for it, or for the streamed program that runs."""
        if self.upload.request >= 0:
            self._verify(self.upload.request)
        else:
            self.upload.waits = False
            if self._core.state == messages.RUNNING:
                self._verify_more()

    def _verify_more(self) -> None:
        """Let the running program have what has come of it since; one that nobody may run is aborted."""
        try:
            self.upload.waits = not self.upload.go_on()
            self._has_senses()
        except Refused as refused:
            self._core.end_program(messages.ABORTED, refused.code, refused.value)
        else:
            self._core.player.end = self.upload.checked

    def _senses(self) -> None:
        """Raise Refused when a program asks for what this robot does not know now."""
        if self.upload.needs_attitude and not self._core.attitude.known:
            raise Refused(codes.NO_ATTITUDE)
        if self.upload.needs_camera and not self._core.limbs.sees():
            raise Refused(codes.NO_CAMERA)

    def _has_senses(self) -> None:
        """Raise Refused when a program asks for what this robot can never know or do."""
        profile, limbs = self._core.profile, self._core.limbs
        if self.upload.needs_attitude and not profile.imu_address:
            raise Refused(codes.NO_ATTITUDE)
        if (self.upload.needs_camera and not (limbs and limbs.camera)) or (self.upload.needs_loop and not limbs.orient):
            raise Refused(codes.NO_CAMERA)
        if (self.upload.needs_load and not (limbs and limbs.load)) or (self.upload.needs_press and not limbs.press):
            raise Refused(codes.NO_LOAD_CELL)

    def _begin(self) -> None:
        self._begins = NOT
        self._core.start(self.upload, self._paused)

    def _understood(self, received) -> tuple:
        for message, handler in self._orders:
            if message.number == received.kind:
                try:
                    return handler, message.unpack(received.payload)
                except ValueError:
                    raise Refused(codes.BAD_PAYLOAD, 255, len(received.payload)) from None
        raise Refused(codes.UNKNOWN_MESSAGE, 255, received.kind)

    def _arm(self, order, seq: int) -> bool:
        """Begin the self-test, whose end answers; a robot that is armed, and without the same coils, just goes on."""
        core = self._core
        lease_ms = order.lease_ms or core.profile.lease_ms
        self._testable(order)
        if lease_ms > core.profile.lease_max_ms:
            raise Refused(codes.LEASE_LIMIT, 255, lease_ms, core.profile.lease_max_ms)
        if core.state == messages.ARMED and order.without == core.channels.without_mask:
            core.arm(lease_ms)
            return False
        self._lease_ms = lease_ms
        self._test(order.without, seq, False)
        return True

    def _calibrate(self, order, seq: int) -> bool:
        """Begin the self-test, whose end answers."""
        self._testable(order)
        if not self._core.at_rest():
            raise Refused(codes.NOT_WHILE_ARMED)
        if not self._core.channels.count:
            raise Refused(codes.UNKNOWN_CHANNEL)
        self._core.records.must_be_cold(order.without)
        self._test(order.without, seq, True)
        return True

    def _testable(self, order) -> None:
        core = self._core
        if order.session != core.session:
            raise Refused(codes.LEASE_HELD)
        if order.without >> core.channels.count:
            raise Refused(codes.UNKNOWN_CHANNEL, 255, order.without, (1 << core.channels.count) - 1)
        self._not_running()
        self._not_tripped()
        if core.is_leaving():
            raise Refused(codes.BUSY)

    def _test(self, without: int, seq: int, calibrates: bool) -> None:
        core = self._core
        core.disarm()
        core.channels.without_mask = without
        core.control.selftest.begin(without)
        self._arming, self._calibrates = seq, calibrates

    def _service(self, order, seq: int) -> None:
        if not self._core.at_rest():
            raise Refused(codes.NOT_WHILE_ARMED)
        self._core.serve_console()

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

    def _move(self, order, seq: int) -> None:
        limbs = self._ready_limbs()
        limbs.move(order.joints, order.target_centi, order.over_ms, order.hold_ms, self._core.now_ms)

    def _orient(self, order, seq: int) -> None:
        self._ready_limbs().turn(order.target_centideg, order.time_ms, order.hold_ms, self._core.now_ms)

    def _press(self, order, seq: int) -> None:
        limbs = self._ready_limbs()
        limbs.push(order.target_mn, order.over_ms, order.time_ms, order.hold_ms, self._core.now_ms)

    def _ready_limbs(self):
        """Return what turns joints, or raise Refused: not now, or this robot has none."""
        self._not_running()
        self._armed()
        limbs = self._core.limbs
        if not limbs:
            raise Refused(codes.UNKNOWN_CHANNEL)
        return limbs

    def _subscribe(self, order, seq: int) -> None:
        core = self._core
        numbers = order.variables or bytes(variables.USUAL)
        core.reports.subscriptions.subscribe(
            order.slot, order.period_ms, order.on_change != 0, numbers, seq, core.now_ms
        )  # fmt: skip

    def _status(self, order, seq: int) -> bool:
        core = self._core
        self.answer(
            messages.STATUS, request=seq, state=core.state, code=core.code, uptime_ms=core.now_ms & 0xFFFFFFFF,
            lease_ms=core.lease_left_ms(), step=core.player.step, paused=int(core.player.paused),
            coils=core.control.driven_mask(), supply_mv=core.sense.supply_mv, current_ma=core.sense.current_ma,
            board_decidegc=core.sense.board_decidegc, roll_decideg=core.attitude.roll_decideg(),
            pitch_decideg=core.attitude.pitch_decideg(), down=core.attitude.down_channel(),
            dropped=core.link.decoder.dropped & 0xFFFF, forged=core.link.forged & 0xFFFF,
            repeated=core.link.duplicates & 0xFFFF, overruns=core.overruns & 0xFFFF,
        )  # fmt: skip
        return True

    def _coils(self, order, seq: int) -> bool:
        self.answer(messages.COILS, request=seq, channels=self._core.reports.coils())
        return True

    def _program(self, order, seq: int) -> None:
        self._not_running()
        self.upload.begin(order.header)

    def _piece(self, order, seq: int) -> None:
        streams = self.upload.streamed and self._core.state == messages.RUNNING
        if not streams:
            self._not_running()
        self.upload.piece(order.offset, order.code, self._core.player if streams else None)

    def _start(self, order, seq: int) -> bool:
        """Have the program verified; the answer follows when it is."""
        self._not_running()
        self._armed()
        on_sync = order.at_ms == messages.AT_SYNC
        if on_sync and self._core.pairing.secured:
            raise Refused(codes.OPEN_START)
        self._at = ON_SYNC if on_sync else order.at_ms
        self._paused = order.paused != 0
        self.upload.verify(seq)
        return True

    def _pause(self, order, seq: int) -> None:
        core = self._core
        if core.state != messages.RUNNING:
            raise Refused(codes.NOT_RUNNING)
        if order.how == messages.PAUSE_NOW:
            core.player.pause(core.now_ms)
        elif order.how <= messages.ONE_STEP:
            core.player.resume(core.now_ms, order.how == messages.ONE_STEP)
        else:
            raise Refused(codes.BAD_PAYLOAD)

    def _cancel(self, order, seq: int) -> None:
        """End the program, or do not start the one that is being verified."""
        if self._core.state == messages.RUNNING:
            self._core.end_program(messages.ABORTED)
        elif self._begins != NOT:
            self._begins = NOT
            self._core.reports.event(messages.ABORTED)
        elif self.upload.request >= 0:
            self._refuse(self.upload.request, Refused(codes.CANCELLED))
            self.upload.request = -1

    def _armed(self) -> None:
        self._not_tripped()
        if self._core.state not in (messages.ARMED, messages.RUNNING):
            raise Refused(codes.NOT_ARMED)

    def _not_tripped(self) -> None:
        if self._core.state == messages.TRIPPED:
            raise Refused(codes.TRIPPED, 255, self._core.code)

    def _not_running(self) -> None:
        if self._core.state == messages.RUNNING or self.upload.request >= 0 or self._arming >= 0:
            raise Refused(codes.BUSY)
        if self._begins != NOT:
            raise Refused(codes.BUSY)

    def _refuse(self, request: int, refused: Refused) -> None:
        self.answer(
            messages.REFUSED, request=request, code=refused.code, channel=refused.channel,
            value=refused.value, limit=refused.limit,
        )  # fmt: skip

    def answer(self, message, **fields) -> None:
        """Send an answer; a host that acknowledges nothing goes without."""
        link = self._core.link
        if link.room():
            link.send(message.number, message.pack(**fields), self._core.now_ms)
