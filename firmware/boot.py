"""First thing after every reset: all outputs off, before anything else is imported.

The coil supply is opened, the heartbeat stays still (so the monostable shuts the outputs), and both PWM chips are
reset by the general call: they keep their registers, and would go on driving, when only the processor was reset.
"""

import sys

from machine import I2C, Pin

Pin(2, Pin.OUT, value=0)
Pin(3, Pin.OUT, value=0)
try:
    I2C(0, scl=Pin(5), sda=Pin(4), freq=400_000, timeout=1000).writeto(0, b"\x06")
except OSError:
    pass  # no chip answers: the supply is off, and the core will say so
sys.path.insert(0, "a")
