"""What the pins of the core board are wired to: the one table for the schematic and the page of the hardware.

The numbers come from firmware/boards/pico.py, read and not imported, because that file needs a board.
"""

import ast
from pathlib import Path

PICO = Path(__file__).parents[1] / "firmware" / "boards" / "pico.py"
WIRES = (
    ("TX", "TX", "Serial line to the host, 115200 to 921600 baud, 3.3 V: an isolated USB adapter's RX."),
    ("RX", "RX", "Serial line from the host: the adapter's TX."),
    ("PWR_EN", "PWR_EN", "High closes the coil supply. Pulled down: open while the processor is reset."),
    ("HEARTBEAT", "HEARTBEAT", "Trigger of the monostable; it must move, or the outputs open within 50 ms."),
    ("SDA", "SDA", "I2C data: 0x33 angle camera, 0x40 monitor, 0x60 and 0x61 PWM, 0x6A attitude. 2.2 k to 3V3."),
    ("SCL", "SCL", "I2C clock, 400 kHz. 2.2 k to 3V3."),
    ("ESTOP_SENSE", "ESTOP", "High while the emergency-stop loop is closed."),
    ("ALERT", "/ALERT", "Low from an over-current on, until it is read; clears the monostable, too."),
    ("SERVOS.0", "SERVO0", "Pulses of 0.5 to 2.5 ms, 200 a second, for the servo of the first joint (R, P)."),
    ("SERVOS.1", "SERVO1", "The second joint (L)."),
    ("SERVOS.2", "SERVO2", "A third one."),
    ("ADC_MISO", "ADC_MISO", "SPI from the converters that measure joints, load and force cells."),
    ("ADC_SELECTS.0", "/ADC_CS", "Selects the first one, inputs 0 to 7."),
    ("ADC_SELECTS.1", "/ADC2_CS", "Selects the second one, inputs 8 to 15. 10 k to 3V3."),
    ("ADC_SCK", "ADC_SCK", "Their clock, 1 MHz."),
    ("ADC_MOSI", "ADC_MOSI", "SPI to them."),
    ("MISO", "MISO", "SPI from the CAN controller."),
    ("CAN_SELECT", "/CAN_CS", "Selects the CAN controller."),
    ("SCK", "SCK", "SPI clock."),
    ("MOSI", "MOSI", "SPI to the CAN controller."),
    ("CAN_INTERRUPT", "/CAN_INT", "Low while the CAN controller has something to say."),
    ("WARM", "/WARM", "Low for about a minute after the coil supply was closed, power or not: the coils may be warm."),
    ("STRAP", "STRAP", "Bridged to ground at reset: service mode, nothing runs."),
    ("THERMISTOR", "NTC", "Divider of 10 k to 3V3 and the thermistor on the core to ground."),
)


def constants(path: Path = PICO) -> dict[str, object]:
    """Return the constants of a board's file by their names."""
    found: dict[str, object] = {}
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign):
            value = ast.literal_eval(node.value)
            target = node.targets[0]
            names = [name.id for name in target.elts] if isinstance(target, ast.Tuple) else [target.id]
            found.update(zip(names, value if isinstance(target, ast.Tuple) else [value], strict=True))
    return found


def pins() -> list[tuple[int, str, str]]:
    """Return (GP number, net, what it is for) of every pin that is wired."""
    known = constants()
    rows = []
    for name, net, about in WIRES:
        constant, _, index = name.partition(".")
        number = known[constant]
        rows.append((number[int(index)] if index else number, net, about))
    return sorted(rows)


PINS = pins()
