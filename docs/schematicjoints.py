"""The sheets of the schematic that only robots with joints have: fingers under a camera, and a press."""

import schemdraw.elements as elm

from docs import drawn

SPI = (("VDD, VREF", "3V3"), ("CLK", "ADC_SCK"), ("DIN", "ADC_MOSI"), ("DOUT", "ADC_MISO"))


def joints(drawing) -> None:
    """Draw two servos, what measures them, and the camera."""
    left = [*SPI, ("/CS", "/ADC_CS")]
    right = [("CH0", "I_R"), ("CH1", "I_L"), ("CH2", "POT_R"), ("CH3", "POT_L"), ("CH4..7", "GND")]
    drawn.chip(drawing, "U9  MCP3208", (3.0, -35.8), [*left, ("AGND, DGND", "GND")], right)
    left = [("VS", "3V3"), ("IN1+", "COIL+"), ("IN1-", "V_R"), ("IN2+", "COIL+"), ("IN2-", "V_L"), ("GND", "GND")]
    drawn.chip(drawing, "U10  INA2180A2, gain 50", (15.5, -35.8), left, [("OUT1", "I_R"), ("OUT2", "I_L")])
    for number, label in enumerate("RL"):
        pins = [("pulses", f"SERVO{number}"), ("+", f"V_{label}"), ("-", "GND")]
        drawn.chip(drawing, f"Servo {label}", (34.0, -34.2 - 4.2 * number), pins, [("wiper", f"POT_{label}")])
        y = -34.2 - 4.2 * number
        drawn.net(drawing, (22.5, y), "COIL+", "left")
        drawing += (shunt := elm.Resistor().at((22.5, y)).right().label(f"R{2 + number} 10 mOhm 1 %"))
        drawn.net(drawing, shunt.end, f"V_{label}")
        drawn.net(drawing, (22.5, y - 1.6), f"POT_{label}", "left")
        drawing += (down := elm.Resistor().at((22.5, y - 1.6)).right().label("1M"))
        drawing += elm.Ground().at(down.end)
    drawn.chip(
        drawing,
        "Angle camera  0x33",
        (43.8, -34.6),
        [("VDD", "3V3"), ("SDA", "SDA"), ("SCL", "SCL"), ("GND", "GND")],
        [],
    )


def press(drawing) -> None:
    """Draw the axis of a press, its load cell, and the force cells in its block."""
    cells = [(f"CH{number + 1}", f"CELL{number}") for number in range(1, 7)]
    drawn.chip(
        drawing,
        "U9  MCP3208",
        (3.0, -48.8),
        [*SPI, ("/CS", "/ADC_CS"), ("AGND, DGND", "GND")],
        [("CH0", "I_P"), ("CH1", "POT_P"), *cells],
    )
    left = [*SPI, ("/CS", "/ADC2_CS"), ("AGND, DGND", "GND")]
    drawn.chip(drawing, "U11  MCP3208", (15.5, -48.8), left, [("CH0", "LOAD"), ("CH1..7", "GND")])
    left = [("VS", "3V3"), ("IN1+", "COIL+"), ("IN1-", "V_P"), ("GND", "GND")]
    drawn.chip(drawing, "U10  INA2180A2, gain 50", (27.0, -47.4), left, [("OUT1", "I_P")])
    pins = [("pulses", "SERVO0"), ("+", "V_P"), ("-", "GND")]
    drawn.chip(drawing, "Linear servo P", (38.5, -47.0), pins, [("wiper", "POT_P")])
    drawn.chip(drawing, "Load cell and amplifier", (38.5, -51.2), [("V+", "3V3"), ("GND", "GND")], [("OUT", "LOAD")])
    drawn.chip(drawing, "Force cells, six", (27.0, -51.8), [("V+", "3V3"), ("GND", "GND")], [("OUT n", "CELLn")])
    drawing += elm.Vdd().at((15.0, -53.4)).label("3V3")
    drawing += (pull := elm.Resistor().at((15.0, -53.4)).down().label("10k", loc="bottom"))
    drawn.net(drawing, pull.end, "/ADC2_CS", "bottom")
    drawn.net(drawing, (1.0, -54.0), "COIL+", "left")
    drawing += (shunt := elm.Resistor().at((1.0, -54.0)).right().label("R2 10 mOhm 1 %"))
    drawn.net(drawing, shunt.end, "V_P")
    drawn.note(
        drawing,
        (19.0, -54.4),
        "POT_P, CELL1 to CELL6 and LOAD: 1M to GND each, so that a broken wire reads 0.\n"
        "LOAD: 0.66 V without load, 0.1007 V/N. CELLn: 0 V at 0, 3.3 V at 20 kPa.",
    )
