"""The tables of docs/hardware.md: pins, parts, and from the robots' profiles their wiring and power."""

import json
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from docs.board import PINS

FUSES_MA = (500, 1000, 1600, 2000, 3150, 4000, 5000, 6300, 8000, 10_000, 16_000)
P_MOSFET_MV = 4500  # below it stays open: a relay
P_MOSFET_MA = 4000
PARTS = (
    ("U1", "Raspberry Pi Pico or Pico 2", "1", "MicroPython, 26 pins, a watchdog, flash for two slots."),
    ("U2, U3", "PCA9685", "1 or 2", "16 outputs of 12 bits, all off by one register; the second from 17 coils on."),
    (
        "U4", "INA226, R1 20 mΩ (with joints 10 mΩ) 1 % 1 W", "1",
        "Current and voltage in one, averaged, and ALERT in hardware.",
    ),
    ("U5", "74HC423", "1", "Retriggerable, and its reset does not trigger; 110 k and 1 µF film: 0.45 R C = 50 ms."),
    ("U6", "74LVC1G00", "1", "/OE is low only while both are there: monostable and emergency-stop loop."),
    (
        "Q1..Q22", "AO3400A", "a coil each",
        "Logic-level MOSFET: at most 48 mΩ at 2.5 V at the gate (AOS data sheet), a few mV lost. A Darlington "
        "array (ULN2803) keeps about 1 V for itself: half of the circular robot's 2 V, and heat.",
    ),
    ("R, R", "100 Ω, 100 kΩ", "a coil each", "Slows the edge; keeps the gate low while the PWM chip has no supply."),
    (
        "Q23 or K1", "AO3401A, or a relay with a 5 V coil", "1",
        "Opens the supply of all coils. The P-MOSFET wants 4.5 V and carries 4 A; else a relay, a diode over its coil.",
    ),
    ("Q24", "AO3400A", "1", "Drives Q23 or K1 from PWR_EN."),
    (
        "Q25, D1", "2N7002, BAT54, 1 kΩ, 1 MΩ, 100 µF", "1",
        "Remembers for about a minute, power or not, that the coil supply was closed: a restarted robot may be warm.",
    ),
    ("S1", "Emergency stop, two NC contacts", "1", "One for /OE, one for the supply; neither needs firmware."),
    ("F1", "Fuse", "1", "See the power budget."),
    ("NTC", "10 k, B 3950, and 10 k 1 %", "1", "The core's temperature; open and short are seen as such."),
    ("U7", "MCP2515, crystal 8 MHz, 3.3 V transceiver", "option", "CAN, once the robot has a number; not CAN FD."),
    ("U8", "LSM6DS3TR-C", "spheres", "Attitude, in the core's axes."),
    ("", "Digital servo, its potentiometer's wiper brought out", "a joint each", "±90° from 0.5 to 2.5 ms, 6 V."),
    ("", "Linear servo with lead screw, wiper brought out", "press", "±10 mm from 0.5 to 2.5 ms, 6 V. ASSUMED."),
    ("U9", "MCP3208", "joints", "Eight inputs of 12 bits: currents and positions of joints, force cells."),
    ("U11", "MCP3208", "press", "Eight more: the load cell."),
    (
        "", "Load cell with its amplifier, 3.3 V", "press",
        "ASSUMED: 0.66 V without load and 0.1007 V/N, so -6.5 to 26.2 N. At either end it counts as broken.",
    ),
    ("", "Force cell, 5 x 5 mm, 3.3 V", "press, six", "ASSUMED: 0 V at 0 and 3.3 V at 20 kPa, cast into the block."),
    (
        "U10, R2, R3", "INA2180A2, two of 10 mΩ 1 % 1 W", "joints",
        "Each servo's current as 0.5 V/A: gain 50 (TI SBOS741); 6.6 A fill the range.",
    ),
    ("", "Angle camera, 3.3 V, I2C 0x33", "joints", "ASSUMED, with its registers: `hil_sim/devices/anglecamera.py`."),
    ("", "Isolated USB serial adapter, 3.3 V", "1", "The host's ground must not carry coil current."),
)  # fmt: skip
POWER = (
    "robot", "supply [V]", "one [mA]", "at once", "at once [mA]", "limit [mA]", "power [W]", "shunt [mV]",
    "F1 [A]", "switch",
)  # fmt: skip
NETS = {number: net for number, net, _ in PINS}
Table = Callable[[Sequence[str], Iterable[tuple[str, ...]]], str]


def fields(robots: Path, table: Table) -> dict[str, str]:
    """Return what the template of the page leaves open."""
    profiles = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(robots.glob("*.json"))]
    return {
        "pins": table(("GP", "net", ""), [(str(number), net, about) for number, net, about in PINS]),
        "parts": table(("", "part", "how many", "why"), PARTS),
        "wiring": table(("robot", "coils or joints"), [(profile["robot"], wiring(profile)) for profile in profiles]),
        "power": table(POWER, [power(profile) for profile in profiles]),
    }


def wiring(profile: dict) -> str:
    """Return each coil of a robot with the net of its gate, each joint with that of its pulses and its two inputs.

    A load cell and force cells follow with their inputs.
    """
    rows = [f"{row['label']} {_net(row)}" for row in profile["channels"]]
    rows += [f"load cell CH{profile['load']['input']}"] if "load" in profile else []
    rows += [f"{cell['label']} CH{cell['input']}" for cell in profile.get("cells", ())]
    return ", ".join(rows)


def _net(row: dict) -> str:
    if row["kind"] == "servo":
        return f"{NETS[row['pin']]}, current CH{row['current']}, position CH{row['position']}"
    return f"G{(row['chip'] - 0x60) * 16 + row['output']}"


def power(profile: dict) -> tuple[str, ...]:
    """Return the row of a robot: what it takes from its supply when its coils are cold, or its servos stall."""
    supply = profile["supply"]
    one_ma = _one_ma(profile)
    together_ma = min(one_ma * supply["at_once_max"], supply["current_max_ma"])
    limit_ma = supply["current_max_ma"]
    mosfet = profile["supply_mv"] >= P_MOSFET_MV and limit_ma <= P_MOSFET_MA
    watts = profile["supply_mv"] * together_ma / 1e6
    fuse_a = next(fuse for fuse in FUSES_MA if fuse > limit_ma) / 1000
    return (
        profile["robot"], f"{profile['supply_mv'] / 1000:g}", str(one_ma), str(supply["at_once_max"]), str(together_ma),
        str(limit_ma), f"{watts:.1f}", f"{limit_ma * supply['shunt_mohm'] / 1000:.0f}", f"{fuse_a:g}",
        "Q23" if mosfet else "K1",
    )  # fmt: skip


def _one_ma(profile: dict) -> int:
    """Return the current of a coil at full duty, or that at which a servo counts as stalled."""
    if "coil" not in profile:
        return profile["servo"]["stall_ma"]
    coil = profile["coil"]
    return profile["supply_mv"] * 1000 // (coil["resistance_mohm"] + coil["wiring_mohm"])
