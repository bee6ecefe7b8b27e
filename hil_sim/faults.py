"""What can go wrong on the bench, by name, at a time.

schedule(bench, 2_000_000, "cable-cut")
"""

from collections.abc import Callable

from hil_sim.bench import Bench
from hil_sim.journal import FAULT
from hil_sim.robotcheck import near


def _cut(bench: Bench) -> None:
    bench.board.uart.cut(bench.clock.now_us)


def _join(bench: Bench) -> None:
    bench.board.uart.join(bench.clock.now_us)


def _pwm_dead(bench: Bench) -> None:
    for chip in bench.board.pwm.values():
        chip.alive = False


def _thermistor(fault: str | None) -> Callable[[Bench], None]:
    def happen(bench: Bench) -> None:
        bench.board.ntc.fault = fault

    return happen


def _monitor_dead(bench: Bench) -> None:
    bench.board.monitor.alive = False


def _monitor_forgets(bench: Bench) -> None:
    bench.board.monitor.reset()


def _bus(stuck: bool) -> Callable[[Bench], None]:
    def happen(bench: Bench) -> None:
        bench.board.bus.stuck = stuck

    return happen


FAULTS: dict[str, Callable[[Bench], None]] = {
    "cable-cut": _cut,
    "cable-join": _join,
    "hang": lambda bench: bench.world.hang(),
    "reset": lambda bench: bench.world.reset(),
    "power-cycle": lambda bench: bench.world.power_on(),
    "estop-open": lambda bench: bench.board.set_estop(False),
    "estop-close": lambda bench: bench.board.set_estop(True),
    "thermistor-open": _thermistor("open"),
    "thermistor-short": _thermistor("short"),
    "thermistor-whole": _thermistor(None),
    "monitor-dead": _monitor_dead,
    "monitor-forgets": _monitor_forgets,
    "pwm-dead": _pwm_dead,
    "bus-stuck": _bus(True),
    "bus-free": _bus(False),
}


def schedule(bench: Bench, at_us: int, name: str) -> None:
    """Let a fault happen at a virtual time; ValueError when there is none of that name or the time has passed."""
    if name not in FAULTS:
        raise ValueError(f"no fault {name!r}: known are {', '.join(FAULTS)}{near(name, FAULTS)}")
    if at_us < bench.clock.now_us:
        raise ValueError(f"fault {name}: time {at_us} us has passed, now {bench.clock.now_us} us")
    bench.clock.at(at_us, lambda: _happen(bench, name))


def _happen(bench: Bench, name: str) -> None:
    bench.journal.note(bench.clock.now_us, FAULT, list(FAULTS).index(name), name.encode())
    FAULTS[name](bench)
