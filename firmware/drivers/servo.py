"""A hobby servo on a PWM pin: the width of its pulses is its order, and no pulses at all make it limp.

The pins of one slice (8 and 9, say) share its frequency, and `PWM.deinit` stops the slice with both
(ports/rp2/machine_pwm.c). So a servo is let go with pulses of no width: the pin stays low from the end of the present
period on, and its neighbour goes on.
"""


class Servo:
    """The pulses of one pin's PWM, so many a second; none until `pulse`. Only its making allocates memory."""

    def __init__(self, pwm, hz: int) -> None:
        self._pwm = pwm
        self._pwm.freq(hz)
        self.off()

    def pulse(self, width_ns: int) -> None:
        """Send pulses of that width from the next period on."""
        self._pwm.duty_ns(width_ns)

    def off(self) -> None:
        """Send no pulses any more."""
        self._pwm.duty_ns(0)
