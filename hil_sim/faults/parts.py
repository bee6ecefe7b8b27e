"""What faults of wires, chips and processor do to a bench: one function each, which returns how it ends, if it can.

Every function is handed the bench, the argument of the fault's name, and a generator of random numbers of its own.
"""

from collections.abc import Callable
from random import Random

from hil_sim.bench import Bench
from hil_sim.devices.lsm6ds3tr import Lsm6ds3tr
from hil_sim.devices.trouble import BusTrouble

Value = int | float | str
Mend = Callable[[], None]
Mishap = Callable[[Bench, Value, Random], Mend | None]
TASKS = ("receive", "control", "send")


def once(act: Callable[[Bench], None]) -> Mishap:
    """Return what happens in an instant and leaves nothing to be ended."""

    def happen(bench: Bench, _value: Value, _draw: Random) -> None:
        act(bench)

    return happen


def on_off(switch: Callable[[Bench, bool], None]) -> Mishap:
    """Return what lasts until it is switched back."""

    def happen(bench: Bench, _value: Value, _draw: Random) -> Mend:
        switch(bench, True)
        return lambda: switch(bench, False)

    return happen


def of_a_coil(switch: Callable[[Bench, int, bool], None]) -> Mishap:
    """Return what lasts on one coil, whose label is the argument."""

    def happen(bench: Bench, label: Value, _draw: Random) -> Mend:
        index = list(bench.plant.labels).index(str(label))
        switch(bench, index, True)
        return lambda: switch(bench, index, False)

    return happen


def coil_open(bench: Bench, coil: int, broken: bool) -> None:
    """Break the wire of a coil."""
    bench.supply.break_coil(coil, broken)
    bench.board.rewired()


def coil_short(bench: Bench, coil: int, shorted: bool) -> None:
    """Bridge the terminals of a coil."""
    bench.supply.short_coil(coil, shorted)
    bench.board.rewired()


def coil_whole(bench: Bench, coil: int, _mended: bool) -> None:
    """Mend the wire of a coil and part its terminals."""
    coil_open(bench, coil, False)
    coil_short(bench, coil, False)


def mosfet_stuck(bench: Bench, coil: int, stuck: bool) -> None:
    """Let the MOSFET of a coil conduct for ever."""
    (bench.board.broken.stuck.add if stuck else bench.board.broken.stuck.discard)(coil)
    bench.board.rewired()


def contactor_welded(bench: Bench, welded: bool) -> None:
    """Weld the contactor of the coil supply: it is closed from now on."""
    bench.board.broken.welded = welded
    bench.board.rewired()


def monostable_bypassed(bench: Bench, bypassed: bool) -> None:
    """Wire OE straight to the heartbeat pin."""
    bench.board.broken.bypassed = bypassed
    bench.board.rewired()


def supply_sag(bench: Bench, percent: Value, _draw: Random) -> Mend:
    """Let the source of the coils give so much less than it should."""

    def sag(share: float) -> None:
        bench.supply.sag(share)
        bench.board.rewired()

    sag(float(percent) / 100)
    return lambda: sag(0.0)


def battery_empty(bench: Bench) -> None:
    """Leave in the battery what its protection ends at once."""
    if bench.supply.battery is not None:
        bench.supply.battery.charge = 0.0


def battery_full(bench: Bench) -> None:
    """Put a charged battery in, and with it start a board that had none."""
    if bench.supply.battery is not None:
        was_cut = bench.supply.battery.cut
        bench.supply.battery.charge, bench.supply.battery.cut = 1.0, False
        if was_cut:
            bench.world.power_on()


def brown_out(bench: Bench, out: bool) -> None:
    """Take the board's own supply away: chips and processor forget; or give it back."""
    (bench.world.power_off if out else bench.world.power_on)()


def power_cycle(bench: Bench) -> None:
    """Take the board's supply away for an instant."""
    bench.world.power_on()


def thermistor(fault: str) -> Callable[[Bench, bool], None]:
    """Return what breaks the board's thermistor in that way."""

    def switch(bench: Bench, broken: bool) -> None:
        bench.board.ntc.fault = fault if broken else None

    return switch


def thermistor_whole(bench: Bench) -> None:
    """Mend the thermistor."""
    bench.board.ntc.fault = None
    bench.board.ntc.drift_k_per_s = 0.0


def thermistor_drift(bench: Bench, k_per_s: Value, _draw: Random) -> Mend:
    """Let the thermistor read more by so much with each second."""
    bench.board.ntc.drift_k_per_s = float(k_per_s)
    bench.board.ntc.drifts_from_us = bench.clock.now_us
    return lambda: thermistor_whole(bench)


def pwm_dead(bench: Bench, dead: bool) -> None:
    """Let both PWM chips fall silent; what they drive, they go on driving."""
    for chip in bench.board.pwm.values():
        chip.alive = not dead


def pwm_forgets(bench: Bench) -> None:
    """Let both PWM chips lose their registers."""
    for chip in bench.board.pwm.values():
        chip.reset()


def monitor_dead(bench: Bench, dead: bool) -> None:
    """Let the monitor of the supply fall silent."""
    bench.board.monitor.alive = not dead


def imu(change: Callable[[Lsm6ds3tr, bool], None]) -> Callable[[Bench, bool], None]:
    """Return what does that to the attitude sensor of a robot that has one."""

    def switch(bench: Bench, on: bool) -> None:
        if bench.board.imu is not None:
            change(bench.board.imu, on)

    return switch


def imu_stuck(imu: Lsm6ds3tr, stuck: bool) -> None:
    """Have the attitude sensor give its last sample for ever."""
    imu.stuck = stuck


def imu_dead(imu: Lsm6ds3tr, dead: bool) -> None:
    """Let the attitude sensor fall silent."""
    imu.alive = not dead


def imu_whole(imu: Lsm6ds3tr, _mended: bool) -> None:
    """Mend the attitude sensor."""
    imu.alive, imu.stuck = True, False


def hang(bench: Bench, task: Value, draw: Random) -> None:
    """Catch the processor in a loop: now, or in a task, when that next comes to a line or a bus."""
    if task == "control":
        bench.board.bus.troubles.append(BusTrouble(draw, trap=lambda: _hang_after_this(bench)))
    elif task:
        waited_for = {"receive": "read", "send": "write"}[str(task)]
        bench.board.uart.trap = lambda access: _hang_after_this(bench) if access == waited_for else None
    else:
        bench.world.hang()


def flash_cut(bench: Bench, operation: Value, _draw: Random) -> Mend:
    """Cut the power in the middle of the so-many-th write to the flash from now on."""
    bench.board.flash.cut_at = int(operation)
    return lambda: setattr(bench.board.flash, "cut_at", 0)


def _hang_after_this(bench: Bench) -> None:
    """Hang as soon as the access that is going on has ended; the firmware is in the middle of it."""
    bench.board.uart.trap = None
    bench.clock.at(bench.clock.now_us, bench.world.hang)
