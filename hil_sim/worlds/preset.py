"""What a robot was told before it came to the bench: its number on a bus, set by its own firmware.

The bench does not know how the firmware keeps its settings. It lets the image's own modules write them, in an import
world of their own, on a table top: no board is there, and no time passes.

    for path, data in number(image, 7).items():
        flash.store(path, data)
"""

import io

from hil_sim.devices.flash import Flash
from hil_sim.worlds.image import PROFILE, SLOT, Image
from hil_sim.worlds.modules import Modules, gc_module, micropython_module, sys_module

SCRIPT = """
import sys
sys.path.insert(0, "{slot}")
from firmware.profile import Profile
from firmware.settings import VERSION, Settings
from firmware.store import Store
from protocol import messages
with open("{slot}/{profile}", "rb") as file:
    profile = Profile(file.read())
Settings(Store(open, "settings", VERSION), profile).change(messages.NODE, 0, {node})
"""
_PATH = "preset.py"


def number(image: Image, node: int) -> dict[str, bytes]:
    """Return the files that a robot with this image has on its flash once it was given a number."""
    before = {path: image.read(path) for path in image.paths()}
    flash = Flash(before)
    script = SCRIPT.format(slot=SLOT, profile=PROFILE, node=node).encode()
    given = {"sys": sys_module(_ignore), "gc": gc_module(), "micropython": micropython_module()}
    Modules(Image({**before, _PATH: script}), given, _ignore, _Open(flash)).run(_PATH)
    return {path: flash.read(path) for path in flash.paths() if path not in before}


class _Open:
    """`open`, on a flash without a board."""

    def __init__(self, flash: Flash) -> None:
        self._flash = flash

    def __call__(self, path: str, mode: str) -> io.BytesIO:
        return _Written(self._flash, path) if mode == "wb" else io.BytesIO(self._flash.read(path))


class _Written(io.BytesIO):
    """A file that is open for writing."""

    def __init__(self, flash: Flash, path: str) -> None:
        super().__init__()
        self._flash = flash
        self._path = path

    def close(self) -> None:
        """Put what was written on the flash."""
        if not self.closed:
            self._flash.store(self._path, self.getvalue())
        super().close()


def _ignore(text: str) -> None:
    """What is printed here, nobody reads."""
