"""Draws docs/schematic.svg: the core board, in nine sheets on one page, so that an engineer can solder it.

A name beside a pin is a net: equal names are one wire. `python docs/generate.py` writes the file.
"""

import re

import schemdraw
import schemdraw.elements as elm

from docs.board import PINS

TITLES = (
    ((-2.5, 1.2), "1  Processor"),
    ((13.5, 1.2), "2  Coil drivers (both chips on one bus)"),
    ((13.5, -16.3), "3  One coil of up to 22"),
    ((29.5, 1.2), "4  Coil supply: measured, then switched"),
    ((29.5, -8.3), "5  Output enable: heartbeat, e-stop, over-current"),
    ((29.5, -20.3), "6  Options"),
    ((-2.5, -19.3), "7  Sensing and strap"),
    ((13.5, -24.2), "8  Memory of warmth, about a minute"),
    ((-2.5, -32.2), "9  Joints: servos on the switched supply, their currents and angles, and an angle camera"),
)


def svg() -> str:
    """Return the drawing as SVG text, the same each time."""
    schemdraw.use("svg")
    with schemdraw.Drawing(show=False) as drawing:
        drawing.config(unit=1.6, fontsize=10, lw=1.2, font="sans-serif")
        for place, title in TITLES:
            drawing += elm.Label().at(place).label(title, fontsize=15, loc="right", halign="left")
        _processor(drawing)
        _drivers(drawing)
        _coil(drawing)
        _supply(drawing)
        _enable(drawing)
        _options(drawing)
        _sensing(drawing)
        _memory(drawing)
        _joints(drawing)
    text = drawing.get_imagedata("svg").decode()
    return re.sub(r"<svg ", '<svg style="background:white" ', text, count=1) + "\n"


def _chip(drawing, name: str, at: tuple[float, float], left: list[tuple[str, str]], right: list[tuple[str, str]]):
    """Draw a chip at its upper left corner; each pin is (name, net)."""
    rows = max(len(left), len(right))
    pins = [
        elm.IcPin(name=pin, side="left", slot=f"{rows - n}/{rows}", anchorname=f"l{n}")
        for n, (pin, _) in enumerate(left)
    ]
    pins += [
        elm.IcPin(name=pin, side="right", slot=f"{rows - n}/{rows}", anchorname=f"r{n}")
        for n, (pin, _) in enumerate(right)
    ]
    chip = elm.Ic(pins=pins, size=(5.0, 0.75 * rows + 0.5), pinspacing=0.75, leadlen=0.5, fontsize=10)
    drawing += chip.at(at).anchor("center").label(name, loc="top", fontsize=11)
    for side, nets in (("l", left), ("r", right)):
        for number, (_, net) in enumerate(nets):
            if net:
                place = getattr(chip, f"{side}{number}")
                where = "left" if side == "l" else "right"
                drawing += elm.Label().at(place).label(net, loc=where, fontsize=10, color="#0a3d8f")
    return chip


def _net(drawing, place, name: str, where: str = "right") -> None:
    far = {"bottom": (0, -0.25), "top": (0, 0.1), "left": (-0.1, 0), "right": (0.1, 0)}[where]
    drawing += elm.Dot(open=True).at(place).label(name, loc=where, ofst=far, fontsize=10, color="#0a3d8f")


def _note(drawing, place, text: str) -> None:
    drawing += elm.Label().at(place).label(text, loc="right", halign="left", fontsize=10)


def _processor(drawing) -> None:
    left = [("VBUS", "USB 5V"), ("VSYS", "5V"), ("3V3(OUT)", "3V3"), ("GND", "GND")]
    right = [(f"GP{pin}", net) for pin, net, _ in PINS]
    _chip(drawing, "U1  Raspberry Pi Pico (RP2040) or Pico 2", (3.0, -8.2), left, right)
    _note(
        drawing,
        (-2.5, -17.8),
        (
            "The console is the Pico's own USB; the robot's protocol is on GP0, GP1.\n"
            "100 nF at every chip between 3V3 and GND; 10 uF at the PWM chips."
        ),
    )


def _drivers(drawing) -> None:
    for number, (name, address, strap, outputs) in enumerate(
        (("U2", "0x60", "GND", "0..15"), ("U3", "0x61", "3V3", "16..21"))
    ):
        left = [("VDD", "3V3"), ("SDA", "SDA"), ("SCL", "SCL"), ("/OE", "/OE"), ("A5", "3V3"), ("A4..A1", "GND")]
        left += [("A0", strap), ("EXTCLK, VSS", "GND")]
        right = [
            ("LED0", f"G{outputs.split('.')[0]}"),
            ("...", ""),
            (f"LED{15 if not number else 5}", f"G{outputs.split('.')[-1]}"),
        ]
        _chip(drawing, f"{name}  PCA9685  I2C {address}", (18.5, -3.0 - 8.0 * number), left, right)
    drawing += elm.Label().at((23.0, -4.0)).label("G0..G21: see 3", loc="right", halign="left", fontsize=10)
    for x, net in ((23.6, "SDA"), (25.6, "SCL")):
        drawing += elm.Vdd().at((x, -6.0)).label("3V3")
        drawing += (line := elm.Resistor().at((x, -6.0)).down().label("2.2k", loc="bottom"))
        _net(drawing, line.end, net, "bottom")


def _coil(drawing) -> None:
    _net(drawing, (14.5, -20.5), "Gn", "left")
    drawing += (series := elm.Resistor().at((14.5, -20.5)).right().label("R 100"))
    drawing += elm.Dot().at(series.end)
    drawing += (pull := elm.Resistor().at(series.end).down().label("100k", loc="bottom"))
    drawing += elm.Ground().at(pull.end)
    drawing += elm.Line().at(series.end).right().length(1.0)
    drawing += (fet := elm.NFet().theta(0).reverse().anchor("gate"))
    drawing += elm.Label().at((fet.source[0] + 0.2, -20.2)).label("Qn AO3400A", loc="right", halign="left", fontsize=10)
    drawing += elm.Ground().at(fet.source)
    drawing += (coil := elm.Inductor2(loops=5).at(fet.drain).up().length(2.0).label("SMA coil n", loc="bottom"))
    _net(drawing, coil.end, "COIL+", "top")
    _note(
        drawing,
        (20.5, -18.4),
        (
            "The coil's own twisted pair ends\nat COIL+ and at the drain. No free-wheel\n"
            "diode: ASSUMED that a spring and its pair\nstore less than Qn absorbs at turn-off."
        ),
    )


def _supply(drawing) -> None:
    _net(drawing, (30.0, -1.5), "VCOIL", "left")
    drawing += (fuse := elm.Fuse().at((30.0, -1.5)).right().label("F1"))
    drawing += (stop := elm.Switch(action="open").at(fuse.end).right().label("S1b (NC)"))
    drawing += elm.Dot().at(stop.end)
    drawing += elm.Line().at(stop.end).right().length(0.6)
    drawing += (shunt := elm.Resistor().right().length(2.4).label("R1 20 mOhm 1 %"))
    drawing += elm.Dot().at(shunt.end)
    drawing += elm.Line().at(shunt.end).right().length(2.4)
    source = (shunt.end[0] + 2.4, -1.5)
    drawing += elm.Dot().at(source)
    drawing += elm.Line().at(source).right().length(0.8)
    drawing += (switch := elm.PFet().anchor("source").theta(90).reverse())
    drawing += elm.Label().at((38.6, -0.9)).label("Q23 AO3401A", loc="right", halign="left", fontsize=10)
    drawing += (rail := elm.Line().at(switch.drain).right().length(0.8))
    _net(drawing, rail.end, "COIL+")
    for place, net, length in ((stop.end, "IN+", 1.2), (shunt.end, "IN-, VBUS", 1.2)):
        drawing += (tap := elm.Line().at(place).down().length(length))
        _net(drawing, tap.end, net, "bottom")
    drawing += (pull := elm.Resistor().at(source).down().length(2.2).label("10k", loc="top"))
    drawing += elm.Dot().at(pull.end)
    drawing += elm.Wire("-|").at(pull.end).to(switch.gate)
    drawing += elm.Line().at(pull.end).down().length(0.5)
    drawing += (driver := elm.NFet().theta(0).anchor("drain").label("Q24 AO3400A", loc="left"))
    drawing += elm.Ground().at(driver.source)
    drawing += (line := elm.Line().at(driver.gate).right().length(0.8))
    drawing += elm.Dot().at(line.end)
    drawing += (down := elm.Resistor().at(line.end).down().label("10k", loc="bottom"))
    drawing += elm.Ground().at(down.end)
    drawing += (enable := elm.Line().at(line.end).right().length(0.8))
    _net(drawing, enable.end, "PWR_EN")
    _note(
        drawing,
        (29.2, -4.9),
        (
            "Below 4.5 V a P-MOSFET does not conduct:\nthere the contact of a relay stands for Q23,\n"
            "its 5 V coil, with a diode across it,\n"
            "from 5V to the drain of Q24, and no 10k."
        ),
    )


def _enable(drawing) -> None:
    left = [("1A", "GND"), ("1B", "HEARTBEAT"), ("/1RD", "/ALERT"), ("1CEXT", "C1"), ("1REXT/CEXT", "RC")]
    right = [("VCC", "3V3"), ("1Q", "ALIVE"), ("GND", "GND")]
    _chip(drawing, "U5  74HC423 (half)  50 ms", (33.5, -11.5), left, right)
    _net(drawing, (30.5, -15.6), "C1", "left")
    drawing += (cap := elm.Capacitor().at((30.5, -15.6)).right().label("1 uF film"))
    drawing += elm.Dot().at(cap.end)
    _net(drawing, (cap.end[0], -16.8), "RC", "bottom")
    drawing += elm.Line().at(cap.end).down().length(1.2)
    drawing += (timing := elm.Resistor().at(cap.end).right().label("110k"))
    _net(drawing, timing.end, "3V3")
    _chip(drawing, "U6  74LVC1G00 (NAND)", (43.5, -11.5), [("A", "ALIVE"), ("B", "ESTOP")], [("Y", "/OE")])
    _note(
        drawing,
        (29.2, -18.4),
        (
            "0.45 x 110k x 1 uF = 50 ms. The other half of U5: 2A to 3V3, 2B and /2RD to GND.\n"
            "The 4.7k keeps the outputs off when U6 has no supply, or is not fitted.\n"
            "S1a and S1b are the two contacts of one emergency stop; pressed, it opens both."
        ),
    )
    for x, top, net in ((37.6, "3V3", "/OE"), (39.8, "3V3", "/ALERT")):
        drawing += elm.Vdd().at((x, -15.0)).label(top)
        drawing += (line := elm.Resistor().at((x, -15.0)).down().label("4.7k" if net == "/OE" else "10k", loc="bottom"))
        _net(drawing, line.end, net, "bottom")
    _net(drawing, (42.0, -15.6), "3V3", "left")
    drawing += (contact := elm.Switch(action="open").at((42.0, -15.6)).right().label("S1a (NC)"))
    drawing += elm.Dot().at(contact.end)
    drawing += (down := elm.Resistor().at(contact.end).down().label("10k", loc="bottom"))
    drawing += elm.Ground().at(down.end)
    drawing += (line := elm.Line().at(contact.end).right().length(0.8))
    _net(drawing, line.end, "ESTOP")


def _options(drawing) -> None:
    left = [("VDD", "3V3"), ("SCK", "SCK"), ("SI", "MOSI"), ("SO", "MISO"), ("/CS", "/CAN_CS"), ("/INT", "/CAN_INT")]
    right = [("TXCAN", "transceiver D"), ("RXCAN", "transceiver R"), ("OSC1,2", "8 MHz crystal"), ("VSS", "GND")]
    _chip(drawing, "U7  MCP2515 (CAN)", (33.5, -23.8), left, right)
    _chip(
        drawing,
        "U8  LSM6DS3TR-C  0x6A",
        (43.8, -23.8),
        [("VDD, CS", "3V3"), ("SDA", "SDA"), ("SCL", "SCL"), ("SA0, GND", "GND")],
        [],
    )


def _sensing(drawing) -> None:
    left = [("VS", "3V3"), ("IN+", "IN+"), ("IN-", "IN-"), ("VBUS", "VBUS"), ("A0, A1, GND", "GND")]
    right = [("SDA", "SDA"), ("SCL", "SCL"), ("/ALERT", "/ALERT")]
    _chip(drawing, "U4  INA226  0x40", (3.0, -22.5), left, right)
    drawing += elm.Vdd().at((0.0, -26.5)).label("3V3")
    drawing += (top := elm.Resistor().at((0.0, -26.5)).down().label("10k 1 %", loc="bottom"))
    drawing += elm.Dot().at(top.end)
    drawing += (ntc := elm.Thermistor().at(top.end).down().label("NTC 10k 3950", loc="bottom"))
    drawing += elm.Ground().at(ntc.end)
    drawing += (line := elm.Line().at(top.end).right().length(1.6))
    _net(drawing, line.end, "NTC")
    _net(drawing, (6.5, -27.5), "STRAP", "left")
    drawing += (jumper := elm.Switch().at((6.5, -27.5)).right().label("J1 service"))
    drawing += elm.Ground().at(jumper.end)


def _memory(drawing) -> None:
    """Draw what tells a robot that may be hot from a cold one, though its power was gone."""
    _net(drawing, (15.0, -26.0), "PWR_EN", "left")
    drawing += (diode := elm.Schottky().at((15.0, -26.0)).right().label("D1 BAT54"))
    drawing += (series := elm.Resistor().at(diode.end).right().label("1k"))
    drawing += elm.Dot().at(series.end)
    drawing += (store := elm.Capacitor(polar=True).at(series.end).down().label("100 uF", loc="top"))
    drawing += elm.Ground().at(store.end)
    drawing += elm.Line().at(series.end).right().length(1.8)
    drawing += elm.Dot()
    leak = (series.end[0] + 1.8, -26.0)
    drawing += (empties := elm.Resistor().at(leak).down().label("1M", loc="top"))
    drawing += elm.Ground().at(empties.end)
    drawing += elm.Line().at(leak).right().length(0.8)
    drawing += (fet := elm.NFet().theta(0).reverse().anchor("gate"))
    drawing += elm.Label().at((fet.source[0] + 0.2, -26.4)).label("Q25 2N7002", loc="right", halign="left", fontsize=10)
    drawing += elm.Ground().at(fet.source)
    _net(drawing, fet.drain, "/WARM", "top")


def _joints(drawing) -> None:
    left = [("VDD, VREF", "3V3"), ("CLK", "ADC_SCK"), ("DIN", "ADC_MOSI"), ("DOUT", "ADC_MISO"), ("/CS", "/ADC_CS")]
    right = [("CH0", "I_R"), ("CH1", "I_L"), ("CH2", "POT_R"), ("CH3", "POT_L"), ("CH4..7", "GND")]
    _chip(drawing, "U9  MCP3208", (3.0, -35.8), [*left, ("AGND, DGND", "GND")], right)
    left = [("VS", "3V3"), ("IN1+", "COIL+"), ("IN1-", "V_R"), ("IN2+", "COIL+"), ("IN2-", "V_L"), ("GND", "GND")]
    _chip(drawing, "U10  INA2180A2, gain 50", (15.5, -35.8), left, [("OUT1", "I_R"), ("OUT2", "I_L")])
    for number, label in enumerate("RL"):
        pins = [("pulses", f"SERVO{number}"), ("+", f"V_{label}"), ("-", "GND")]
        _chip(drawing, f"Servo {label}", (34.0, -34.2 - 4.2 * number), pins, [("wiper", f"POT_{label}")])
        y = -34.2 - 4.2 * number
        _net(drawing, (22.5, y), "COIL+", "left")
        drawing += (shunt := elm.Resistor().at((22.5, y)).right().label(f"R{2 + number} 10 mOhm 1 %"))
        _net(drawing, shunt.end, f"V_{label}")
        _net(drawing, (22.5, y - 1.6), f"POT_{label}", "left")
        drawing += (down := elm.Resistor().at((22.5, y - 1.6)).right().label("1M"))
        drawing += elm.Ground().at(down.end)
    _chip(
        drawing,
        "Angle camera  0x33",
        (43.8, -34.6),
        [("VDD", "3V3"), ("SDA", "SDA"), ("SCL", "SCL"), ("GND", "GND")],
        [],
    )
