"""What boot.py is followed by, `main.py` on the flash: the program of the slot that boot.py has chosen."""

from firmware.main import run

run()
