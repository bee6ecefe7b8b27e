"""The only code that energises a coil.

Whatever is asked, no coil is on above its duty limit, longer than its order, beyond its cut-off, or without a rest
after `on_max_ms`. Orders are checked whole before any of it is taken. Outputs are written only when they change; a step
in which nothing may have changed does not even look.
`alone` puts the orders aside for a measurement; the next `write` brings them back.
"""

from array import array

from protocol import codes, program

FULL_PERMILLE = 1000
UNKNOWN = 0xFFFF  # no duty: what the chip holds must be written anew
NONE = -1
FIGURE_MAX = 0x7FFFFFFF  # that the fields of a refusal, of an event and of a fault's record hold


class Refused(Exception):
    """An order that breaks a limit; nothing was changed."""

    def __init__(self, code: int, channel: int = 255, value: int = 0, limit: int = 0) -> None:
        super().__init__(code)
        self.code = code
        self.channel = channel
        self.value = min(value, FIGURE_MAX)
        self.limit = min(limit, FIGURE_MAX)


class Channels:
    """The coils of one robot, driven through `outputs`, a list of (chip driver, output number) on these chips."""

    def __init__(self, chips: list, outputs: list, coil, at_once_max: int) -> None:
        count = len(outputs)
        self.count = count
        self.on_mask = 0
        self.duty_permille = array("H", [0] * count)
        self.cut_off_mask = 0  # coils whose cut-off ended their order since the reports last told them
        self.without_mask = 0  # coils known to be broken: orders pass them over
        self._chips = chips
        self._outputs = outputs
        self._coil = coil
        self._on_max_ms = coil.on_max_ms
        self._at_once_max = at_once_max
        self._target = array("H", [0] * count)
        self._written = array("H", [0] * count)
        self._is_written = True  # no output differs from its order
        self._end_ms = array("i", [0] * count)
        self._cutoff_decidegc = array("i", [0] * count)  # below 0: the coil is kept near so much
        self._ramp_ms = array("H", [0] * count)
        self._begin_ms = array("i", [0] * count)
        self._since_ms = array("i", [0] * count)
        self._rested_ms = array("i", [0] * count)

    def fire(self, mask: int, duty_permille: int, hold_ms: int, now_ms: int, cutoff_decidegc: int = 0,
             ramp_ms: int = 0) -> None:  # fmt: skip
        """Drive these coils until now_ms + hold_ms, or raise Refused; those known to be broken are passed over.

        The cut-off is that of a program, with its KEEP.
        """
        self._check(mask, duty_permille, hold_ms, now_ms)
        mask &= ~self.without_mask
        for channel in range(self.count):
            if mask >> channel & 1:
                self._order(channel, duty_permille, now_ms)
                self._end_ms[channel] = now_ms + hold_ms
                self._cutoff_decidegc[channel] = (
                    cutoff_decidegc if cutoff_decidegc < program.KEEP else program.KEEP - cutoff_decidegc
                )
                self._ramp_ms[channel] = ramp_ms

    def off(self, mask: int, now_ms: int) -> None:
        """Switch these coils off."""
        for channel in range(self.count):
            if (mask & self.on_mask) >> channel & 1:
                self._end(channel, now_ms)

    def all_off(self, now_ms: int) -> None:
        """Switch every coil off."""
        self.off(self.on_mask, now_ms)

    def update(self, now_ms: int, temperature_millidegc: array) -> int:
        """End what has run out, move ramps; return a channel that was on for too long, or -1."""
        mask, channel = self.on_mask, 0
        while mask:
            if mask & 1:
                cutoff = self._cutoff_decidegc[channel]
                if now_ms - self._end_ms[channel] >= 0:
                    self._end(channel, now_ms)
                elif cutoff > 0 and temperature_millidegc[channel] >= cutoff * 100:
                    self._end(channel, now_ms)
                    self.cut_off_mask |= 1 << channel
                elif now_ms - self._since_ms[channel] > self._on_max_ms:
                    return channel
                elif cutoff < 0:
                    self._keep(channel, temperature_millidegc[channel] < -100 * cutoff)
                elif self._ramp_ms[channel]:
                    self._ramp(channel, now_ms)
            mask >>= 1
            channel += 1
        return -1

    def write(self) -> None:
        """Bring the chips' outputs in line with the orders; OSError when a chip does not answer."""
        if self._is_written:
            return
        for channel in range(self.count):
            duty = self.duty_permille[channel]
            if duty != self._written[channel]:
                chip, output = self._outputs[channel]
                chip.set(output, duty)
                self._written[channel] = duty
        self._is_written = True

    def alone(self, channel: int) -> None:
        """Switch every output off and that of one coil, or NONE, full on, whatever was ordered."""
        self._is_written = False
        for other in range(self.count):
            if self._written[other]:
                self._written[other] = UNKNOWN  # until the chips have answered
        self.shut()
        if channel != NONE:
            self._written[channel] = UNKNOWN
            chip, output = self._outputs[channel]
            chip.set(output, FULL_PERMILLE)
            self._written[channel] = FULL_PERMILLE

    def shut(self) -> None:
        """Switch every output off, whatever was ordered; OSError when a chip does not answer."""
        for chip in self._chips:
            chip.all_off()
        self.forget_written()

    def forget_written(self) -> None:
        """Take all outputs as off: the chips were reset or switched off behind our back."""
        self._is_written = False
        for channel in range(self.count):
            self._written[channel] = 0

    def is_alone_on(self, channel: int) -> bool:
        """Return whether that coil is on at full duty, and no other is on, as far as the chips were told."""
        for other in range(self.count):
            if self._written[other] != (FULL_PERMILLE if other == channel else 0):
                return False
        return True

    def busy(self, now_ms: int) -> bool:
        """Return whether a coil has an order that goes on beyond now."""
        return self._busy_mask(now_ms) != 0

    def on_for_ms(self, channel: int, now_ms: int) -> int:
        """Return for how long that coil has been on without a pause."""
        return now_ms - self._since_ms[channel]

    def _busy_mask(self, now_ms: int) -> int:
        mask = 0
        for channel in range(self.count):
            if self.on_mask >> channel & 1 and now_ms - self._end_ms[channel] < 0:
                mask |= 1 << channel
        return mask

    def _check(self, mask: int, duty_permille: int, hold_ms: int, now_ms: int) -> None:
        if not 0 < mask < 1 << self.count:
            raise Refused(codes.UNKNOWN_CHANNEL, 255, mask, (1 << self.count) - 1)
        if duty_permille > self._coil.duty_max_permille:
            raise Refused(codes.DUTY_LIMIT, _first(mask), duty_permille, self._coil.duty_max_permille)
        if hold_ms > self._coil.hold_max_ms:
            raise Refused(codes.HOLD_LIMIT, _first(mask), hold_ms, self._coil.hold_max_ms)
        if duty_permille == 0:
            return
        at_once = bits(mask & ~self.without_mask | self._busy_mask(now_ms))
        if at_once > self._at_once_max:
            raise Refused(codes.AT_ONCE_LIMIT, _first(mask), at_once, self._at_once_max)
        for channel in range(self.count):
            left_ms = self._rested_ms[channel] - now_ms
            if mask >> channel & 1 and not self.on_mask >> channel & 1 and left_ms > 0:
                raise Refused(codes.RESTING, channel, left_ms, 0)

    def _order(self, channel: int, duty_permille: int, now_ms: int) -> None:
        if duty_permille == 0:
            self._end(channel, now_ms)
            return
        if not self.on_mask >> channel & 1:
            self.on_mask |= 1 << channel
            if not self._written[channel]:  # else its output was never off
                self._since_ms[channel] = now_ms
        self._target[channel] = duty_permille
        self._begin_ms[channel] = now_ms
        self._drive(channel, duty_permille)

    def _end(self, channel: int, now_ms: int) -> None:
        if self.on_mask >> channel & 1 and now_ms - self._since_ms[channel] >= self._on_max_ms:
            self._rested_ms[channel] = now_ms + self._coil.rest_ms
        self.on_mask &= ~(1 << channel)
        self._target[channel] = 0
        self._drive(channel, 0)

    def _keep(self, channel: int, is_below: bool) -> None:
        """Heat a coil that is to be kept at a temperature only while it is below it."""
        duty_permille = self._target[channel] if is_below else 0
        if self.duty_permille[channel] != duty_permille:
            self._drive(channel, duty_permille)

    def _ramp(self, channel: int, now_ms: int) -> None:
        ramp_ms = self._ramp_ms[channel]
        passed_ms = now_ms - self._begin_ms[channel]
        target = self._target[channel]
        self._drive(channel, target if passed_ms >= ramp_ms else target * passed_ms // ramp_ms)

    def _drive(self, channel: int, duty_permille: int) -> None:
        self.duty_permille[channel] = duty_permille
        self._is_written = False


def bits(mask: int) -> int:
    """Return how many bits are set."""
    count = 0
    while mask:
        mask &= mask - 1
        count += 1
    return count


def _first(mask: int) -> int:
    channel = 0
    while not mask >> channel & 1:
        channel += 1
    return channel
