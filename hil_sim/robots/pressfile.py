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
        corners=_places(dict(enumerate(press.get("corners_mm", ())))),
        centres=dict(zip(data["cells"]["centres_mm"], _places(data["cells"]["centres_mm"]), strict=True)),
        g=groups["ground"]["gravity"],
        material=_material(groups["material"], choices["press.plane"]),
        screw=ScrewNumbers(**groups["screw"]),
        mesh=path.parent / press["mesh"] if "mesh" in press else None,
        **numbers,
    )


def _places(places: Mapping[Any, list[float]]) -> tuple[tuple[float, float], ...]:
    return tuple((1e-3 * x, 1e-3 * y) for x, y in places.values())


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
