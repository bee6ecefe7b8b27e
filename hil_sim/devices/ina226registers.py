"""The registers of an INA226: their numbers and bits, what they hold after a reset, what their limit means."""

CONFIG, SHUNT, BUS, POWER, CURRENT, CALIBRATION, MASK, LIMIT, MAKER_ID, DIE_ID = (*range(8), 0xFE, 0xFF)
RESET = 0x8000
SHUNT_OVER, SHUNT_UNDER, BUS_OVER, BUS_UNDER, POWER_OVER, READY_ALERT = 0x8000, 0x4000, 0x2000, 0x1000, 0x800, 0x400
OF_SHUNT, LIMITS, WATCHED = 0xC000, 0xF800, 0xFC00
ALERT_FLAG, READY_FLAG, OVERFLOW_FLAG, ALERT_HIGH, LATCH = 0x10, 0x08, 0x04, 0x02, 0x01


def after_reset() -> dict[int, int]:
    """Return the registers in the power-on state."""
    return dict.fromkeys(range(8), 0) | {CONFIG: 0x4127, MAKER_ID: 0x5449, DIE_ID: 0x2260}


def signed(value: int) -> int:
    """Return what a register holds as a number with its sign."""
    return value - 0x10000 if value & 0x8000 else value


def take_averages(registers: dict[int, int], shunt: int | None, bus: int | None) -> None:
    """Store the results of a cycle, those that were converted, and what follows from them."""
    if shunt is not None:
        registers[SHUNT] = shunt & 0xFFFF
        current = int(shunt * registers[CALIBRATION] / 2048)
        registers[CURRENT] = max(-0x8000, min(0x7FFF, current)) & 0xFFFF
        overflow = OVERFLOW_FLAG if not -0x8000 <= current <= 0x7FFF else 0
        registers[MASK] = registers[MASK] & ~OVERFLOW_FLAG | overflow
    if bus is not None:
        registers[BUS] = bus
    registers[POWER] = min(0xFFFF, abs(signed(registers[CURRENT])) * registers[BUS] // 20_000)
    registers[MASK] |= READY_FLAG


def is_beyond_limit(registers: dict[int, int], shunt: int, bus: int) -> bool:
    """Return whether the one watched value, the highest bit where several are set, is beyond the limit."""
    mask, limit = registers[MASK], registers[LIMIT]
    power = abs(int(shunt * registers[CALIBRATION] / 2048)) * bus // 20_000
    watched = (
        (SHUNT_OVER, shunt > signed(limit)),
        (SHUNT_UNDER, shunt < signed(limit)),
        (BUS_OVER, bus > limit),
        (BUS_UNDER, bus < limit),
        (POWER_OVER, power > limit),
    )
    return next((beyond for bit, beyond in watched if mask & bit), False)
