"""First thing after every reset: all outputs off, and seen to be off, before anything else is imported.

The coil supply is opened and the heartbeat stays still, so the monostable shuts the outputs. The PWM chips keep their
registers when only the processor was reset, and would go on driving: both are reset by the general call, told to be
full off on every output, and read back. `LOUD` names the chip that answers but is not off, 0: there is none; a chip
that does not answer is for the core to tell. The console finds the board in this state, too: it runs boot.py and not
main.py when it resets the interpreter. Ctrl-C cannot break in before all is off.
"""

import micropython
from machine import I2C, Pin

AUTO_INCREMENT_ASLEEP, ALL_OFF = b"\x00\x30", b"\xfd\x10"  # PCA9685: MODE1, ALL_LED_OFF_H
FULL_OFF = 0x10


def free() -> None:
    """Clock the bus until a chip that was reset in the middle of a read lets go of the data line."""
    data = Pin(4, Pin.IN, Pin.PULL_UP)
    clock = None
    for _ in range(9):
        if data.value():
            return
        clock = clock or Pin(5, Pin.OPEN_DRAIN, value=1)
        clock.value(0)
        clock.value(1)


def loud(bus, address: int) -> bool:
    """Switch a PWM chip off; return whether it answers, but after three times still is not off."""
    for _ in range(3):
        try:
            bus.writeto(address, AUTO_INCREMENT_ASLEEP)
            bus.writeto(address, ALL_OFF)
            registers = bus.readfrom_mem(address, 0, 70)
        except OSError:
            return False
        off = FULL_OFF
        for led in range(16):
            off &= registers[9 + 4 * led]
        if off and registers[0] == AUTO_INCREMENT_ASLEEP[1]:
            return False
    return True


def quiet() -> int:
    """Switch everything off; return the address of the PWM chip that is not, or 0."""
    Pin(2, Pin.OUT, value=0)
    Pin(3, Pin.OUT, value=0)
    free()
    bus = I2C(0, scl=Pin(5), sda=Pin(4), freq=400_000, timeout=1000)
    try:
        bus.writeto(0, b"\x06")
    except OSError:
        pass  # no chip answers: the supply is off, and the core will say so
    for address in (0x60, 0x61):
        if loud(bus, address):
            return address
    return 0


micropython.kbd_intr(-1)  # until main.py: MicroPython heeds Ctrl-C anew in each file that it runs (its pyexec.c)
LOUD = quiet()
