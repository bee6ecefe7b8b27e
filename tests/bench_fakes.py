"""A body without physics and small firmware images, for tests of the bench itself."""

from pathlib import Path

import numpy as np

from hil_sim.bench import Bench, Parts
from hil_sim.worlds import cpython
from hil_sim.worlds.image import Image

EXECUTE = cpython.execute  # what runs the firmware where a test does not say

PINS = """
from machine import ADC, I2C, Pin, UART, WDT, reset, reset_cause
import time
i2c = I2C(0, scl=Pin(5), sda=Pin(4), freq=400_000)
power = Pin(2, Pin.OUT, value=0)
beat = Pin(3, Pin.OUT, value=0)

def set_output(number, permille):
    end = permille * 4096 // 1000
    off = bytes((0, 0, 0, 0x10)) if not permille else bytes((0, 0, end & 255, end >> 8))
    off = bytes((0, 0x10, 0, 0)) if permille == 1000 else off
    i2c.writeto_mem(0x60, 6 + 4 * number, off)

def begin():
    i2c.writeto_mem(0x60, 0, bytes((0x30,)))
    i2c.writeto_mem(0x60, 0xFE, bytes((3,)))
    i2c.writeto_mem(0x60, 0, bytes((0x20,)))
    time.sleep_us(500)
    power.value(1)

def beat_for(ms):
    until = time.ticks_add(time.ticks_ms(), ms)
    while time.ticks_diff(until, time.ticks_ms()) > 0:
        beat.toggle()
        time.sleep_ms(5)
"""


class FakePlant:
    """Coils of 9.5 ohm that warm by 10 K per joule and never cool."""

    def __init__(self, labels: str = "ABCDEFGH") -> None:
        self.labels = list(labels)
        self.resistance = np.full(len(labels), 9.5)
        self.temperature = np.full(len(labels), 25.0)
        self.calls: list[tuple[int, list[float]]] = []

    def advance(self, duration_us, coil_power_w):
        self.calls.append((duration_us, list(coil_power_w)))
        self.temperature += coil_power_w * (duration_us * 1e-5)

    def observe(self):
        return {"travel_mm": 0.0}

    def snapshot(self):
        return {"coils": {label: {} for label in self.labels}}


def bench_of(folder: Path, main: str, files: dict[str, str] | None = None, **options) -> Bench:
    """Return a bench whose flash holds `main` (after PINS) and the other files."""
    sources = {"pins.py": PINS, "main.py": "from pins import *\n" + main, "robot.json": "{}", **(files or {})}
    for name, text in sources.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    plant = options.pop("plant", None) or FakePlant()
    parts = Parts([(0x60, output) for output in range(8)], [0.5] * 8, battery=options.pop("battery", None))
    return Bench(parts, plant, Image.of_folder(folder), **{"execute": EXECUTE, **options})
