"""`main.py` on the flash: chooses a slot and runs the program in it, or leaves the board to its console.

The boot record says which slot, kept twice with a CRC as firmware/store.py keeps its records: slot, tries left
(CONFIRMED: the program has been healthy once), the slot to fall back to, and the service mark. A new program loses one
try at each start until it confirms itself; when none is left the board rolls back. The strap (GP22 to ground), the
service mark, which counts once, and a new program that failed with nothing to fall back to leave the board to its
console: outputs off, no watchdog. So does Ctrl-C there, after a reset, because nothing else stops the watchdog; and a
KeyboardInterrupt that the program itself raises, when it was ordered to.

The console can change everything, so on a robot with a pairing key it stays shut: Ctrl-C does nothing, and a program
that fails is followed by a reset. Only the strap and the service mark, which takes an order with the key, open it.

Only main.py knows the record, so that it cannot differ between two slots: the program is handed `settled`, to call
once it has been healthy for a while. That is said on the console, by slot, so that a deployment hears of a roll-back.
"""

import gc
import struct
import sys
from binascii import crc32

import micropython
from machine import WDT, Pin, reset

SLOTS = ("/a", "/b")
COPIES = ("/boot.0", "/boot.1")
HEAD = "<2sBxIH"  # mark, version, sequence, length
SLOT, TRIES, FALLBACK, SERVICE = 0, 1, 2, 3
CONFIRMED = NOWHERE = 255
SEQUENCES = 1 << 30  # a flash is worn out long before
STRAP = 22
KEY = "/key"
GARBAGE_BYTES = 8192  # collected so often while modules are compiled, their remains leave no holes in the heap
START_MS = 8000  # to import the program, or to write the flash


def load() -> list:
    """Return the sequence of the newest whole record and its fields; slot a when there is none."""
    newest = [0, bytearray((0, CONFIRMED, NOWHERE, 0))]
    for path in COPIES:
        try:
            with open(path, "rb") as file:
                raw = file.read()
        except OSError:
            continue
        if len(raw) == 18 and raw[:3] == b"sr\x01" and struct.unpack("<I", raw[14:])[0] == crc32(raw[:14]):
            sequence = struct.unpack("<I", raw[4:8])[0]
            if newest[0] < sequence < SEQUENCES and raw[10] < len(SLOTS):
                newest = [sequence, bytearray(raw[10:14])]
    return newest


def keep(sequence: int, fields: bytearray) -> None:
    """Write the next record, over the older copy."""
    body = struct.pack(HEAD, b"sr", 1, sequence + 1, 4) + fields
    with open(COPIES[(sequence + 1) & 1], "wb") as file:
        file.write(body + struct.pack("<I", crc32(body)))


def change(field: int, value: int) -> None:
    """Change one field of the record, under a watchdog that outlasts the flash."""
    WDT(timeout=START_MS)
    sequence, fields = load()
    fields[field] = value
    keep(sequence, fields)


def settled() -> bool:
    """Keep the slot that runs for good; return whether that changed the watchdog's time."""
    fields = load()[1]
    on_trial = fields[TRIES] != CONFIRMED
    if on_trial:
        change(TRIES, CONFIRMED)
    print("softrig: slot " + SLOTS[fields[SLOT]][1] + " is healthy")
    return on_trial


def chosen(sequence: int, fields: bytearray) -> bool:
    """Return whether to run the record's slot, after what this start does to the record."""
    if fields[SERVICE]:
        fields[SERVICE] = 0
        keep(sequence, fields)
        return False
    if fields[TRIES] == CONFIRMED:
        return True
    if fields[TRIES]:
        fields[TRIES] -= 1
    elif fields[FALLBACK] >= len(SLOTS):
        return False
    else:
        fields[SLOT], fields[TRIES], fields[FALLBACK] = fields[FALLBACK], CONFIRMED, NOWHERE
    keep(sequence, fields)
    return True


def keyed() -> bool:
    """Return whether there is a pairing key, whole or damaged."""
    try:
        with open(KEY, "rb"):
            return True
    except OSError as error:
        return error.args[0] != 2  # ENOENT; a key that cannot be read is one


def start() -> None:
    """Run the program of the chosen slot for ever."""
    shut = keyed()
    if shut:
        micropython.kbd_intr(-1)
    sequence, fields = load()
    if Pin(STRAP, Pin.IN, Pin.PULL_UP).value() == 0 or not chosen(sequence, fields):
        print("softrig: service")
        return
    sys.path.insert(0, SLOTS[fields[SLOT]])
    gc.threshold(GARBAGE_BYTES)
    WDT(timeout=START_MS)
    try:
        from firmware.main import run  # noqa: PLC0415  (from the slot that was just chosen)

        run(LOUD, fields[TRIES] != CONFIRMED, settled)  # noqa: F821  (boot.py has left LOUD here)
    except KeyboardInterrupt:
        micropython.kbd_intr(-1)
        change(SERVICE, 1)
        reset()
    except Exception as error:
        if not shut:
            raise
        sys.print_exception(error)
        reset()


start()
