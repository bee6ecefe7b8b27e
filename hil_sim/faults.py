"""What can go wrong on the bench, by name, at a time.

    schedule(bench, 2_000_000, "cable-cut")
    schedule(bench, 0, "coil-open:B10m1")

`coil-open` and `coil-whole` break and mend the wire of one coil, named after a colon. `battery-empty` leaves in a
battery on board what its protection ends at once. `imu-stuck` has the attitude sensor give its last sample for ever.
"""

from collections.abc import Callable

from hil_sim.bench import Bench
from hil_sim.devices.lsm6ds3tr import Lsm6ds3tr
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


def _battery_empty(bench: Bench) -> None:
    if bench.supply.battery is not None:
        bench.supply.battery.charge = 0.0


def _imu(change: Callable[[Lsm6ds3tr], None]) -> Callable[[Bench], None]:
    def happen(bench: Bench) -> None:
        if bench.board.imu is not None:
            change(bench.board.imu)

    return happen


def _imu_stuck(imu: Lsm6ds3tr) -> None:
    imu.stuck = True


def _imu_dead(imu: Lsm6ds3tr) -> None:
    imu.alive = False


def _imu_whole(imu: Lsm6ds3tr) -> None:
    imu.alive, imu.stuck = True, False


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
    "battery-empty": _battery_empty,
    "imu-dead": _imu(_imu_dead),
    "imu-stuck": _imu(_imu_stuck),
    "imu-forgets": _imu(Lsm6ds3tr.reset),
    "imu-whole": _imu(_imu_whole),
}
OF_A_COIL: dict[str, Callable[[Bench, str], None]] = {
    "coil-open": lambda bench, label: bench.break_coil(label),
    "coil-whole": lambda bench, label: bench.break_coil(label, broken=False),
}
NAMES = (*FAULTS, *OF_A_COIL)


def schedule(bench: Bench, at_us: int, name: str) -> None:
    """Let a fault happen at a virtual time; ValueError when this bench has none of that name or the time has passed."""
    happen = _fault(bench, name)
    if at_us < bench.clock.now_us:
        raise ValueError(f"fault {name}: time {at_us} us has passed, now {bench.clock.now_us} us")
    bench.clock.at(at_us, lambda: _happen(bench, name, happen))


def _fault(bench: Bench, name: str) -> Callable[[Bench], None]:
    if name == "battery-empty" and bench.supply.battery is None:
        raise ValueError("fault battery-empty: this robot has no battery")
    if name.startswith("imu-") and bench.board.imu is None:
        raise ValueError(f"fault {name}: this robot has no attitude sensor")
    if name in FAULTS:
        return FAULTS[name]
    kind, _, label = name.partition(":")
    if kind not in OF_A_COIL:
        raise ValueError(f"no fault {name!r}: known are {', '.join(NAMES)}{near(name, NAMES)}")
    if label not in bench.plant.labels:
        raise ValueError(f"fault {name}: name a coil of this robot, as in {kind}:{bench.plant.labels[0]}")
    return lambda bench: OF_A_COIL[kind](bench, label)


def _happen(bench: Bench, name: str, happen: Callable[[Bench], None]) -> None:
    bench.journal.note(bench.clock.now_us, FAULT, NAMES.index(name.partition(":")[0]), name.encode())
    happen(bench)
