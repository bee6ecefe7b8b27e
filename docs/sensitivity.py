"""Writes docs/sensitivity.md: how each headline figure changes with the numbers that nobody has measured.

Every figure comes from its own script on the bench, through wire, firmware and chips, with one number of the robot file
changed in the address. A figure, a parameter or a terrain is one row of a table below.

    python docs/sensitivity.py             # make sensitivity: a quarter of an hour, two processes at a time
    python docs/sensitivity.py sphere-b    # this robot's figures alone
"""

import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from hil_sim.link import open_link
from hil_sim.robots.file import load as load_robot
from host.errors import SoftrigError
from host.gait.compiler import compile_script
from host.gait.script import load as load_script
from host.keeper import Keeper
from host.robot import Robot
from host.run import run

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs" / "sensitivity.md"
AT_ONCE = 2
CROSSED = 0.85  # of the travel on a plane: less is stuck, or slid back
SLOPE_STEP_DEG = 0.5
Setting = tuple[str, float]


@dataclass(frozen=True)
class Figure:
    """A headline figure: what is run, and how the number is read off."""

    robot: str
    what: str
    unit: str
    script: str
    read: Callable[..., float | None]


@dataclass(frozen=True)
class Change:
    """A number of the robot file and two other values of it, as factors or as differences."""

    what: str
    key: str
    low: float
    high: float
    factors: bool = True

    def values(self, nominal: float) -> tuple[float, float]:
        """Return both values."""
        if self.factors:
            return nominal * self.low, nominal * self.high
        return nominal + self.low, nominal + self.high

    def __str__(self) -> str:
        if self.factors and abs(self.high - 1.0) < 0.5:
            return f"{self.what}, {100 * (self.low - 1):+.0f} / {100 * (self.high - 1):+.0f} %"
        return f"{self.what}, " + (
            f"x {self.low:g} / x {self.high:g}" if self.factors else f"{self.low:+g} / {self.high:+g}"
        )


def observed(figure: Figure, *settings: Setting, seed: int = 1) -> dict[str, Any] | None:
    """Run the figure's script with numbers changed; return what the observer saw, or None when it did not end well."""
    query = urlencode([("seed", seed), *(("set", f"{key}:{value:.6g}") for key, value in settings)])
    link = open_link(f"sim:{figure.robot}?{query}")
    try:
        with Robot(link, Keeper()) as robot:
            robot.connect()
            compiled = compile_script(load_script(str(ROOT / "gaits" / figure.script)), robot.profile, ())
            ending = run(robot, compiled.program, lambda stage, done: None)
            return dict(link.bench.observe()) if ending.result == "done" else None
    except SoftrigError:
        return None


def apex(figure: Figure, *settings: Setting) -> float | None:
    """Return the greatest rise of the centre of mass [mm]."""
    seen = observed(figure, *settings)
    return float(seen["apex_mm"]) if seen else None


def step(figure: Figure, *settings: Setting) -> float | None:
    """Return the travel of each of eight steps [mm]."""
    seen = observed(figure, *settings)
    return float(seen["travel_mm"]) / 8 if seen else None


def slope_limit(figure: Figure, *settings: Setting) -> float | None:
    """Return the steepest slope, in half degrees, on which all steps are taken [deg]; None when there is none."""
    level = step(figure, *settings)
    low, high = 0, round(50 / SLOPE_STEP_DEG)
    while high - low > 1:
        middle = (low + high) // 2
        climbed = step(figure, *settings, ("ground.slope_deg", SLOPE_STEP_DEG * middle))
        if level and climbed and climbed > CROSSED * level:
            low = middle
        else:
            high = middle
    return SLOPE_STEP_DEG * low if low else None


FIGURES = (
    Figure("circular", "travel per step on the flat", "mm", "circular-crawl.gait", step),
    Figure("circular", "steepest slope", "deg", "circular-climb.gait", slope_limit),
    Figure("circular", "apex of the jump", "mm", "circular-jump.gait", apex),
    Figure("sphere-a", "travel per step on the flat", "mm", "sphere-a-crawl.gait", step),
    Figure("sphere-b", "travel per step on the flat", "mm", "sphere-b-crawl.gait", step),
    Figure("sphere-b", "steepest slope", "deg", "sphere-b-climb.gait", slope_limit),
    Figure("sphere-b", "apex of the jump", "mm", "sphere-b-jump.gait", apex),
)
CHANGES = (
    Change("friction", "ground.friction_ratio", 0.8, 1.2),
    Change("bending stiffness", "shell.bending_stiffness_n_m2", 0.93, 1.07),
    Change("mass of the shell", "shell.mass_g", 0.9, 1.1),
    Change("turns of the coils", "coils.turns_count", 0.98, 1.02),
    Change("transformation strain", "coils.transformation_strain_ratio", 0.95, 1.05),
    Change("supply voltage", "wiring.supply_v", 0.97, 1.03),
    Change("charge of the battery [%]", "battery.charge_percent", -15, 50, factors=False),
    Change("ambient temperature [K]", "ground.ambient_degc", -5, 5, factors=False),
    Change("contact stiffness", "ground.contact_stiffness_n_per_m", 0.5, 2),
    Change("nodes of the mesh", "shell.nodes_count", -8, 8, factors=False),
    Change("tolerance of a time step", "numerics.tolerance_um", 0.1, 5),
)
STEPS, ROUGH = (-0.4, 0.05, 0.075, 0.1, 0.125, 0.15, 0.2), (0.01, 0.02, 0.03, 0.04, 0.06)  # of the radius
PLACES, SEEDS = (-0.4, -0.2, 0.0, 0.2), range(1, 9)  # of the edge, in radii; of the roughness
CROSSERS = tuple(figure for figure in FIGURES if figure.read is not apex)


def main(robots: list[str]) -> int:
    """Measure all figures of these robots, or of all, that have their script; what else the page says stays."""
    there = [figure for figure in FIGURES if (ROOT / "gaits" / figure.script).exists()]
    for figure in FIGURES:
        if figure not in there:
            print(f"gaits/{figure.script} is missing: left out", file=sys.stderr)
    chosen = [figure for figure in there if not robots or figure.robot in robots]
    with ProcessPoolExecutor(AT_ONCE) as pool:
        parts = [begin_table(pool, figure) for figure in chosen]
        parts += [begin_terrain(pool, figure) for figure in chosen if figure in CROSSERS]
        measured = [finish() for finish in parts]
    PAGE.write_text(page(measured), encoding="utf-8")
    return 0


def page(measured: list[str]) -> str:
    """Return the page with these sections put in place of those of the same title, or after them all."""
    before = PAGE.read_text(encoding="utf-8").split("\n## ")[1:] if PAGE.exists() else []
    sections = {text.splitlines()[0]: f"## {text.strip()}\n" for text in before}
    sections.update((text.splitlines()[0].removeprefix("## "), text) for text in measured)
    return HEAD + "\n" + "\n".join(sections.values())


HEAD = """\
<!-- Made by docs/sensitivity.py: `make sensitivity`. -->

# Sensitivity

How the headline figures change with numbers that were assumed, and with the numerics. One number is changed at a time;
everything else is as in the robot files, where each number says how it is known. All layers take part: script, wire,
firmware, chips, coils, body, ground. Fitted is the bending stiffness of each robot, to crawl and jump with the coils
within their limits; the times in the jump scripts were searched for. *Fails*: the script was ended by a limit, or no
slope is climbed.
"""


def begin_table(pool: ProcessPoolExecutor, figure: Figure) -> Callable[[], str]:
    """Start all runs of a figure; return what waits for them and returns its table."""
    numbers = {entry.name: entry.value for entry in load_robot(figure.robot).entries}
    nominal = pool.submit(figure.read, figure)
    rows = []
    for change in CHANGES:
        if change.key in numbers:
            values = change.values(numbers[change.key])
            rows.append((change, [pool.submit(figure.read, figure, (change.key, value)) for value in values]))

    def finish() -> str:
        middle = nominal.result()
        lines = [f"## {figure.robot}: {figure.what}", f"`gaits/{figure.script}`: **{told(middle)} {figure.unit}**.\n"]
        lines += [f"| changed | less [{figure.unit}] | more [{figure.unit}] | change less | change more |"]
        lines += ["| --- | --- | --- | --- | --- |"]
        for change, runs in rows:
            ends = [each.result() for each in runs]
            cells = [*map(told, ends), *(relative(end, middle) for end in ends)]
            lines.append(f"| {change} | " + " | ".join(cells) + " |")
        return "\n".join(lines) + "\n"

    return finish


def begin_terrain(pool: ProcessPoolExecutor, figure: Figure) -> Callable[[], str]:
    """Start a script's runs over steps and rough ground; return what waits for them and returns their table."""
    radius_mm = next(e.value for e in load_robot(figure.robot).entries if e.name == "shell.radius_mm")
    plane, rows = pool.submit(observed, figure), []
    for share in STEPS:
        settings = [
            (("ground.step_mm", share * radius_mm), ("ground.step_at_mm", (3.0 + place) * radius_mm))
            for place in PLACES
        ]
        rows.append((f"step of {share * radius_mm:g} mm", [pool.submit(observed, figure, *each) for each in settings]))
    for share in ROUGH:
        rough = (("ground.roughness_mm", share * radius_mm), ("ground.roughness_length_mm", 0.25 * radius_mm))
        runs = [pool.submit(observed, figure, *rough, seed=seed) for seed in SEEDS]
        rows.append((f"roughness of {share * radius_mm:g} mm, over {0.25 * radius_mm:g} mm", runs))

    def finish() -> str:
        level = plane.result()
        lines = [f"## {figure.robot}: steps and rough ground, {figure.script}", "Of the places or seeds tried.\n"]
        lines += ["| ground | crossed |", "| --- | --- |"]
        for what, runs in rows:
            crossed = [crosses(each.result(), level) for each in runs]
            lines.append(f"| {what} | {sum(crossed)} of {len(crossed)} |")
        return "\n".join(lines) + "\n"

    return finish


def crosses(seen: dict[str, Any] | None, level: dict[str, Any] | None) -> bool:
    """Return whether a robot came as far as on the plane, or nearly."""
    return bool(seen and level and seen["travel_mm"] > CROSSED * level["travel_mm"])


def told(value: float | None) -> str:
    """Return a figure as a table shows it."""
    return "fails" if value is None else f"{value:.1f}"


def relative(value: float | None, nominal: float | None) -> str:
    """Return by how many percent a figure differs."""
    return f"{100 * (value / nominal - 1):+.1f} %" if value is not None and nominal else ""


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
