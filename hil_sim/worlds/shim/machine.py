"""`machine` as the bench has it: each object stands for one of the bench, each access is a request.

What a control step uses is written out below and allocates nothing; any other method is called by its name. Classes,
constants and functions are those of the bench's own module, which tells them at the start.
"""

from bench import ADC as CONVERT
from bench import DESK, FEED, I2C_READ, I2C_WRITE, MACHINE, PIN_GET, PIN_SET, PULSE, UART_READ, UART_WRITE, Remote, line
from bench import SPI as EXCHANGE

PIN_US, WATCHDOG_US = line.call(DESK, "costs_us")


class Pin(Remote):
    """A pin; the same object for the same number."""

    kind = "Pin"
    _known = {}

    def __new__(cls, *args, **options):
        pin = super().__new__(cls)
        Remote.__init__(pin, *args, **options)
        return cls._known.setdefault(pin.which, pin)

    def __init__(self, *args, **options) -> None:
        pass

    def value(self, level=None):
        """Return the level, or set it."""
        if level is None:
            return line.ask(PIN_GET, self.which, 0)
        line.post(PIN_SET, self.which, 1 if level else 0, PIN_US)
        return None

    __call__ = value


class I2C(Remote):
    """A bus."""

    kind = "I2C"

    def writeto_mem(self, addr, memaddr, buf, addrsize=8):
        """Write `buf` from register `memaddr` on."""
        if addrsize == 8:
            line.ask(I2C_WRITE, self.which, addr << 8 | memaddr & 0xFF, buf)
        else:
            line.call(self.which, "writeto_mem", (addr, memaddr, buf), {"addrsize": addrsize})

    def readfrom_mem_into(self, addr, memaddr, buf, addrsize=8):
        """Fill `buf` from register `memaddr` on."""
        if addrsize == 8:
            line.ask(I2C_READ, self.which, addr << 8 | memaddr & 0xFF, None, len(buf))
            line.take(buf)
        else:
            buf[:] = line.call(self.which, "readfrom_mem", (addr, memaddr, len(buf)), {"addrsize": addrsize})


class SPI(Remote):
    """A bus; every byte that goes out brings one in."""

    kind = "SPI"

    def write_readinto(self, write_buf, read_buf):
        """Send one buffer and fill the other, which may be the same."""
        if len(write_buf) == len(read_buf) > 0:
            line.ask(EXCHANGE, self.which, 0, write_buf)
            line.take(read_buf)
        else:
            line.call(self.which, "write_readinto", (write_buf, read_buf))


class PWM(Remote):
    """The pulses on one pin."""

    kind = "PWM"

    def __init__(self, *args, **options) -> None:
        Remote.__init__(self, *args, **options)
        self._width = bytearray(4)

    def duty_ns(self, value=-1):
        """Return the width of the pulse [ns], or set it."""
        if not 0 <= value < 1 << 30:
            return line.call(self.which, "duty_ns", (value,))
        width = self._width
        for i in range(4):
            width[i] = value >> 8 * i & 0xFF
        line.ask(PULSE, self.which, 0, width)
        return None


class UART(Remote):
    """A serial port."""

    kind = "UART"

    def read(self, nbytes=0xFFFF):
        """Return what has arrived, or None."""
        return line.read(line.ask(UART_READ, self.which, 0, None, nbytes)) or None

    def write(self, buf):
        """Send what the buffer takes; return how much, or None."""
        buf = buf.encode() if isinstance(buf, str) else buf
        count = line.ask(UART_WRITE, self.which, 0, buf)
        return count if count or not buf else None


class ADC(Remote):
    """An analogue input."""

    kind = "ADC"

    def read_u16(self):
        """Return a conversion."""
        return line.ask(CONVERT, self.which, 0)


class WDT(Remote):
    """The watchdog."""

    kind = "WDT"

    def feed(self):
        """Start the time-out anew."""
        line.post(FEED, self.which, 0, WATCHDOG_US)


def _function(name):
    return lambda *args: line.call(MACHINE, name, args)


def _adopt(classes, values, functions) -> None:
    """Take over what the bench's module has."""
    here = globals()
    for name in classes:
        if name not in here:
            here[name] = type(name, (Remote,), {"kind": name})
        for constant in classes[name]:
            setattr(here[name], constant, classes[name][constant])
    for name in values:
        here[name] = values[name]
    for name in functions:
        here[name] = _function(name)


_adopt(*line.call(DESK, "contents"))
