"""Firmware in which one line reads otherwise, to see whether a test would notice."""

import pytest

from hil_sim.worlds.image import Image


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
