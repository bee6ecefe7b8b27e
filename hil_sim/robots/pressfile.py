"""The press of a robot file in SI units."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hil_sim.bodies.pressnumbers import PressNumbers
from hil_sim.bodies.screw import ScrewNumbers
from hil_sim.physics.block.material import Material, Maxwell

Groups = Mapping[str, dict[str, Any]]
WHOLE = ("columns", "rows")


def press_numbers(path: Path, data: Mapping[str, Any], groups: Groups, choices: Mapping[str, str]) -> PressNumbers:
    """Return the numbers of a press from its file's tables, its numbers in SI units and what was chosen."""
    press = data["press"]
    numbers = {name: int(value) if name in WHOLE else value for name, value in groups["press"].items()}
    return PressNumbers(
        kind=choices["press.indenter"],
        corners=tuple((1e-3 * x, 1e-3 * y) for x, y in press.get("corners_mm", ())),
        centres=centres_of(data),
        relative="centres_percent" in data["cells"],
        g=groups["ground"]["gravity"],
        material=_material(groups["material"], choices["press.plane"]),
        screw=ScrewNumbers(**groups["screw"]),
        mesh=path.parent / press["mesh"] if "mesh" in press else None,
        **numbers,
    )


def centres_of(data: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """Return where the force cells are by their labels [m], or as shares of the block; empty for other robots."""
    cells = data.get("cells", {})
    scale, key = (1e-2, "centres_percent") if "centres_percent" in cells else (1e-3, "centres_mm")
    return {label: (scale * x, scale * y) for label, (x, y) in cells.get(key, {}).items()}


def _material(numbers: Mapping[str, float], plane: str) -> Material:
    """Return the material; a modulus or viscosity of 0 is none, a ratio that is not given that of the first branch."""
    nu = numbers["nu"]
    first = Maxwell(numbers["E"], numbers["c"], nu, numbers.get("c_unloading") or None)
    second = Maxwell(numbers.get("E_2", 0.0), numbers.get("c_2", 0.0), numbers.get("nu_2", nu))
    return Material(
        tuple(branch for branch in (first, second) if branch.E and branch.c),
        numbers["E0"],
        numbers["c0"],
        numbers.get("nu0", nu),
        numbers.get("nu_c", nu),
        numbers.get("c0_unloading") or None,
        plane,
    )
