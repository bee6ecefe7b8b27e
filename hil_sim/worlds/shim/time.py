"""`time` as on a board, on the bench's clock: ticks wrap at 2**30."""

from bench import SLEEP, line

_MASK = (1 << 30) - 1
_HALF = 1 << 29


def ticks_us():
    """Return microseconds since reset."""
    return line.now_us() & _MASK


def ticks_ms():
    """Return milliseconds since reset."""
    return line.now_us() // 1000 & _MASK


ticks_cpu = ticks_us


def ticks_add(ticks, delta):
    """Return the ticks that far away."""
    return ticks + delta & _MASK


def ticks_diff(later, earlier):
    """Return the time from one to the other, with its sign."""
    return (later - earlier + _HALF & _MASK) - _HALF


def sleep_us(us):
    """Let time pass."""
    us = max(us, 1)
    if not isinstance(us, int):
        raise TypeError("can't convert float to int")
    if us < 1 << 16:
        line.post(SLEEP, 0, us, us)
    else:
        line.ask(SLEEP, 0, 0, us.to_bytes(8, "little"))


def sleep_ms(ms):
    """Let time pass."""
    sleep_us(ms * 1000)


def sleep(seconds):
    """Let time pass."""
    sleep_us(int(seconds * 1_000_000))


def time():
    """Return whole seconds since reset."""
    return line.now_us() // 1_000_000
