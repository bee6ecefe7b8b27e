"""A bench whose flash holds boot.py, main.py and two slots, for tests of what happens between power-on and program.

bench = slot_bench({"a": REAL, "b": {"firmware/main.py": "raise ValueError"}}, record(1, tries=3, fallback=0))
"""

import struct
from binascii import crc32
from pathlib import Path

from hil_sim.bench import Bench, Parts
from hil_sim.worlds import cpython
from hil_sim.worlds.image import Image
from tests.bench_fakes import FakePlant

ROOT = Path(__file__).parents[1]
PROFILE = (ROOT / "firmware/robots/circular.json").read_bytes()
REAL = {
    path.removeprefix("a/"): Image.installed(PROFILE).read(path)
    for path in Image.installed(PROFILE).paths()
    if path.startswith("a/")
}
CONFIRMED = NOWHERE = 255

# A program of a few lines that is healthy at once, and lives; `{}` is what it prints.
SMALL = """
import time
from machine import WDT
def run(loud, is_new, settled):
    print("{}")
    settled()
    dog = WDT(timeout=200)
    while True:
        time.sleep_ms(50)
        dog.feed()
"""


def small(name: str) -> dict[str, bytes]:
    """Return the files of a slot with a small program that prints its name."""
    return {"firmware/main.py": SMALL.replace("{}", name).encode()}


def record(slot: int, tries: int = CONFIRMED, fallback: int = NOWHERE, service: int = 0, sequence: int = 1) -> bytes:
    """Return a boot record as firmware/start.py documents it."""
    body = struct.pack("<2sBxIH4B", b"sr", 1, sequence, 4, slot, tries, fallback, service)
    return body + struct.pack("<I", crc32(body))


def slot_bench(slots: dict[str, dict[str, bytes]], boot: bytes | None = None, execute=cpython.execute, **options):
    """Return a bench with these programs in its slots and this boot record."""
    files: dict[str, bytes | Path] = {
        "boot.py": ROOT / "firmware/boot.py",
        "main.py": ROOT / "firmware/start.py",
        **{f"{slot}/{path}": data for slot, program in slots.items() for path, data in program.items()},
    }
    if boot is not None:
        files["boot.1"] = boot
    parts = Parts([(0x60, output) for output in range(8)], [0.5] * 8)
    return Bench(parts, FakePlant(), Image(files), execute=execute, **options)


def said(bench: Bench) -> list[str]:
    """Return what the board printed, line by line."""
    return "".join(bench.world.console).split("\n")[:-1]


def fields(bench: Bench) -> tuple[int, int, int, int]:
    """Return slot, tries, fallback and service mark of the newest boot record."""
    whole = []
    for path in ("boot.0", "boot.1"):
        raw = bench.board.flash.read(path) if path in bench.board.flash.paths() else b""
        if len(raw) == 18 and struct.unpack("<I", raw[14:])[0] == crc32(raw[:14]):
            whole.append((struct.unpack("<I", raw[4:8])[0], tuple(raw[10:14])))
    return max(whole)[1]
