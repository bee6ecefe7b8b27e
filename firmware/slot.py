"""The sense slot: for about 2 ms one coil is on alone, or none, and the monitor looks at current and voltage.

It happens within one control step. First the outputs are set and the PWM chips given the rest of their period to follow
(NXP: new counts take effect at its end), then two short conversions are waited for. `end` brings back what was ordered
and the monitor's averages, which are fresh again some steps later.

    mohm = slot.measure(channel)
    slot.end()
"""

from firmware.channels import NONE

PWM_US = 700  # more than a period of the PWM, 655 us
CONVERSIONS_US = 750  # two of 332 us, each up to 10 % longer
PULSE_US = 2000  # for which the coil is on: both, and the transfers between them
WRITE_US = 140  # and for each output that `end` sets anew before
_UNTOUCHED = -2


class Slot:
    """Measures one coil at a time. Every method raises OSError when a chip does not answer."""

    def __init__(self, board, monitor, channels, sense, wiring_mohm: int, most_mohm: int) -> None:
        self._board = board
        self._monitor = monitor
        self._channels = channels
        self._sense = sense
        self._wiring_mohm = wiring_mohm
        self._most_mohm = most_mohm
        self.begun = False  # until `end`
        self._on = _UNTOUCHED  # the coil that was put on alone, or NONE

    def measure(self, channel: int) -> int:
        """Return the resistance of a coil that is on alone; the monitor keeps current and voltage.

        It is nothing if so much has flowed that the alert has opened the outputs: the monitor may then see no current.
        """
        if self.begun or not self._channels.is_alone_on(channel):
            self._set(channel)
        self._convert()
        mohm = self._monitor.seen_mohm() - self._wiring_mohm
        return 0 if mohm < 0 or self._board.alert() else min(mohm, self._most_mohm)

    def idle_ma(self) -> int:
        """Return the current that flows while every output is off."""
        self._set(NONE)
        self._convert()
        return self._monitor.seen_ma()

    def seen_mv(self) -> int:
        """Return the voltage at the coils' rail in the last measurement."""
        return self._monitor.seen_mv()

    def end(self) -> None:
        """Bring back outputs and averages, if a slot has been begun."""
        if self.begun:
            self._channels.write()
            self._monitor.average()
            self.begun = False
            self._on = _UNTOUCHED
            self._sense.disturbed()

    def _set(self, channel: int) -> None:
        if channel != self._on:
            self.begun = True
            self._channels.alone(channel)
            self._on = channel
            self._board.wait_us(PWM_US)

    def _convert(self) -> None:
        self.begun = True
        self._monitor.hasten()
        self._board.wait_us(CONVERSIONS_US)
        self._monitor.look()
