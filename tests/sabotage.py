"""Firmware in which one line reads otherwise, to see whether a test would notice."""

from collections.abc import Callable

import pytest

from hil_sim.worlds.image import Image
from tests.hil_rig import HilRig


def sabotage(patch: pytest.MonkeyPatch, file: str, line: str, instead: str) -> None:
    """Have every bench that is built from now on run firmware in which `line` of a file reads `instead`."""
    genuine = Image.installed

    def installed(profile: bytes) -> Image:
        image = genuine(profile)
        files = {path: image.read(path) for path in image.paths()}
        path = next(path for path in files if path.endswith(file))
        assert files[path].count(line.encode()) == 1, f"{file} has no such line: {line}"
        return Image({**files, path: files[path].replace(line.encode(), instead.encode())})

    patch.setattr(Image, "installed", installed)


def reproaches(address: str, deed: Callable[[HilRig], None]) -> str:
    """Return which invariants did not hold while that was done to a robot, a sentence a line."""
    rig = HilRig(address)
    deed(rig)
    return "\n".join(rig.bench.witness.broken())
