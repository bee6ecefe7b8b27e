"""Draws docs/schematic.svg: the core board, in ten sheets on one page, so that an engineer can solder it.

A name beside a pin is a net: equal names are one wire. `python docs/generate.py` writes the file.
"""

import re

import schemdraw
import schemdraw.elements as elm

from docs import drawn
from docs.board import PINS
from docs.schematicjoints import joints, press

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
    ((-2.5, -44.2), "10  Press: its axis and force cells on the first converter, its load cell on the second"),
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
        joints(drawing)
        press(drawing)
    text = drawing.get_imagedata("svg").decode()
    return re.sub(r"<svg ", '<svg style="background:white" ', text, count=1) + "\n"


def _processor(drawing) -> None:
    left = [("VBUS", "USB 5V"), ("VSYS", "5V"), ("3V3(OUT)", "3V3"), ("GND", "GND")]
    right = [(f"GP{pin}", net) for pin, net, _ in PINS]
    drawn.chip(drawing, "U1  Raspberry Pi Pico (RP2040) or Pico 2", (3.0, -8.75), left, right)
    drawn.note(
        drawing,
        (-2.5, -18.45),
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
        drawn.chip(drawing, f"{name}  PCA9685  I2C {address}", (18.5, -3.0 - 8.0 * number), left, right)
    drawing += elm.Label().at((23.0, -4.0)).label("G0..G21: see 3", loc="right", halign="left", fontsize=10)
    for x, net in ((23.6, "SDA"), (25.6, "SCL")):
        drawing += elm.Vdd().at((x, -6.0)).label("3V3")
        drawing += (line := elm.Resistor().at((x, -6.0)).down().label("2.2k", loc="bottom"))
        drawn.net(drawing, line.end, net, "bottom")


def _coil(drawing) -> None:
    drawn.net(drawing, (14.5, -20.5), "Gn", "left")
    drawing += (series := elm.Resistor().at((14.5, -20.5)).right().label("R 100"))
    drawing += elm.Dot().at(series.end)
    drawing += (pull := elm.Resistor().at(series.end).down().label("100k", loc="bottom"))
    drawing += elm.Ground().at(pull.end)
    drawing += elm.Line().at(series.end).right().length(1.0)
    drawing += (fet := elm.NFet().theta(0).reverse().anchor("gate"))
    drawing += elm.Label().at((fet.source[0] + 0.2, -20.2)).label("Qn AO3400A", loc="right", halign="left", fontsize=10)
    drawing += elm.Ground().at(fet.source)
    drawing += (coil := elm.Inductor2(loops=5).at(fet.drain).up().length(2.0).label("SMA coil n", loc="bottom"))
    drawn.net(drawing, coil.end, "COIL+", "top")
    drawn.note(
        drawing,
        (20.5, -18.4),
        (
            "The coil's own twisted pair ends\nat COIL+ and at the drain. No free-wheel\n"
            "diode: ASSUMED that a spring and its pair\nstore less than Qn absorbs at turn-off."
        ),
    )


def _supply(drawing) -> None:
    drawn.net(drawing, (30.0, -1.5), "VCOIL", "left")
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
    drawn.net(drawing, rail.end, "COIL+")
    for place, net, length in ((stop.end, "IN+", 1.2), (shunt.end, "IN-, VBUS", 1.2)):
        drawing += (tap := elm.Line().at(place).down().length(length))
        drawn.net(drawing, tap.end, net, "bottom")
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
    drawn.net(drawing, enable.end, "PWR_EN")
    drawn.note(
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
    drawn.chip(drawing, "U5  74HC423 (half)  50 ms", (33.5, -11.5), left, right)
    drawn.net(drawing, (30.5, -15.6), "C1", "left")
    drawing += (cap := elm.Capacitor().at((30.5, -15.6)).right().label("1 uF film"))
    drawing += elm.Dot().at(cap.end)
    drawn.net(drawing, (cap.end[0], -16.8), "RC", "bottom")
    drawing += elm.Line().at(cap.end).down().length(1.2)
    drawing += (timing := elm.Resistor().at(cap.end).right().label("110k"))
    drawn.net(drawing, timing.end, "3V3")
    drawn.chip(drawing, "U6  74LVC1G00 (NAND)", (43.5, -11.5), [("A", "ALIVE"), ("B", "ESTOP")], [("Y", "/OE")])
    drawn.note(
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
        drawn.net(drawing, line.end, net, "bottom")
    drawn.net(drawing, (42.0, -15.6), "3V3", "left")
    drawing += (contact := elm.Switch(action="open").at((42.0, -15.6)).right().label("S1a (NC)"))
    drawing += elm.Dot().at(contact.end)
    drawing += (down := elm.Resistor().at(contact.end).down().label("10k", loc="bottom"))
    drawing += elm.Ground().at(down.end)
    drawing += (line := elm.Line().at(contact.end).right().length(0.8))
    drawn.net(drawing, line.end, "ESTOP")


def _options(drawing) -> None:
    left = [("VDD", "3V3"), ("SCK", "SCK"), ("SI", "MOSI"), ("SO", "MISO"), ("/CS", "/CAN_CS"), ("/INT", "/CAN_INT")]
    right = [("TXCAN", "transceiver D"), ("RXCAN", "transceiver R"), ("OSC1,2", "8 MHz crystal"), ("VSS", "GND")]
    drawn.chip(drawing, "U7  MCP2515 (CAN)", (33.5, -23.8), left, right)
    drawn.chip(
        drawing,
        "U8  LSM6DS3TR-C  0x6A",
        (43.8, -23.8),
        [("VDD, CS", "3V3"), ("SDA", "SDA"), ("SCL", "SCL"), ("SA0, GND", "GND")],
        [],
    )


def _sensing(drawing) -> None:
    left = [("VS", "3V3"), ("IN+", "IN+"), ("IN-", "IN-"), ("VBUS", "VBUS"), ("A0, A1, GND", "GND")]
    right = [("SDA", "SDA"), ("SCL", "SCL"), ("/ALERT", "/ALERT")]
    drawn.chip(drawing, "U4  INA226  0x40", (3.0, -22.5), left, right)
    drawing += elm.Vdd().at((0.0, -26.5)).label("3V3")
    drawing += (top := elm.Resistor().at((0.0, -26.5)).down().label("10k 1 %", loc="bottom"))
    drawing += elm.Dot().at(top.end)
    drawing += (ntc := elm.Thermistor().at(top.end).down().label("NTC 10k 3950", loc="bottom"))
    drawing += elm.Ground().at(ntc.end)
    drawing += (line := elm.Line().at(top.end).right().length(1.6))
    drawn.net(drawing, line.end, "NTC")
    drawn.net(drawing, (6.5, -27.5), "STRAP", "left")
    drawing += (jumper := elm.Switch().at((6.5, -27.5)).right().label("J1 service"))
    drawing += elm.Ground().at(jumper.end)


def _memory(drawing) -> None:
    """Draw what tells a robot that may be hot from a cold one, though its power was gone."""
    drawn.net(drawing, (15.0, -26.0), "PWR_EN", "left")
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
    drawn.net(drawing, fet.drain, "/WARM", "top")
