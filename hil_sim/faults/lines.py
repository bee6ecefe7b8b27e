"""What faults of the serial line and of the I2C bus do to a bench; see parts.py for how they are written."""

from random import Random

from hil_sim.bench import Bench
from hil_sim.devices.trouble import BusTrouble, Noise
from hil_sim.faults.parts import Mend, Mishap, Value


def i2c_nack(bench: Bench, count: Value, draw: Random) -> Mend:
    """Let so many transfers find nobody."""
    return _on_the_bus(bench, BusTrouble(draw, nacks=int(count)))


def i2c_bit_error(bench: Bench, count: Value, draw: Random) -> Mend:
    """Flip one bit in each of so many messages on the bus."""
    return _on_the_bus(bench, BusTrouble(draw, flips=int(count)))


def i2c_stuck(bench: Bench, stuck: bool) -> None:
    """Hold the bus's clock low."""
    bench.board.bus.stuck = stuck


def line_noise(kind: str) -> Mishap:
    """Return what disturbs so many bytes in a thousand, both ways: "flip", "lose" or "double" them."""

    def happen(bench: Bench, permille: Value, draw: Random) -> Mend:
        uart = bench.board.uart
        places = (uart.inward.noises, uart.outward.noises)
        noises = [Noise(Random(draw.getrandbits(64)), **{f"{kind}_permille": int(permille)}) for _ in places]
        uart.settle(bench.clock.now_us)
        for place, noise in zip(places, noises, strict=True):
            place.append(noise)

        def mend() -> None:
            uart.settle(bench.clock.now_us)
            for place, noise in zip(places, noises, strict=True):
                place.remove(noise)

        return mend

    return happen


def line_delay(bench: Bench, delay_ms: Value, _draw: Random) -> Mend:
    """Let every byte arrive so much later, both ways."""
    uart = bench.board.uart

    def delay(by_us: int) -> None:
        uart.settle(bench.clock.now_us)
        uart.inward.delay_us += by_us
        uart.outward.delay_us += by_us

    delay(int(delay_ms) * 1000)
    return lambda: delay(-int(delay_ms) * 1000)


def line_baud(bench: Bench, baud: Value, _draw: Random) -> Mend:
    """Have the host's end of the line run at another rate."""
    uart, before = bench.board.uart, bench.board.uart.inward.baud
    uart.retune(int(baud), bench.clock.now_us)
    return lambda: uart.retune(before, bench.clock.now_us)


def cable_cut(bench: Bench, cut: bool) -> None:
    """Pull the cable out, or plug it in."""
    uart = bench.board.uart
    (uart.cut if cut else uart.join)(bench.clock.now_us)


def host_killed(bench: Bench, killed: bool) -> None:
    """Let the host's process die, or a new one come."""
    bench.board.uart.desert(killed, bench.clock.now_us)


def _on_the_bus(bench: Bench, trouble: BusTrouble) -> Mend:
    bench.board.bus.troubles.append(trouble)
    return lambda: bench.board.bus.troubles.remove(trouble)
