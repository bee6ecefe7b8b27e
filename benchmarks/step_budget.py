"""What a control step costs in instructions of real MicroPython, held against the committed budget.

Counted by valgrind's callgrind, so the load of the machine does not matter: the interpreter runs tests/step_cost.py
with no steps, then with STEPS of them in one state at a time. The figure is of the 64-bit interpreter, and of the whole
step with its drivers but without the bus; other processors need a band: the C library may choose other routines.

    python benchmarks/step_budget.py            print what each state costs
    python benchmarks/step_budget.py --check    fail when one has left the band of budget.json
    python benchmarks/step_budget.py --write    take today's figures as the budget
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from hil_sim.worlds.micropython import interpreter

ROOT = Path(__file__).parents[1]
BUDGET = ROOT / "benchmarks" / "budget.json"
ROBOTS = ROOT / "firmware" / "robots"
STATES = {
    "idle": "sphere-b", "armed": "sphere-b", "firing": "sphere-b", "running": "sphere-b", "turning": "fingers",
    "pressing": "press",
}  # fmt: skip
STEPS = 640
BAND = 0.05


def counted(robot: str, state: str, steps: int) -> int:
    """Return how many instructions the interpreter executes for a robot, with so many steps in that state."""
    arguments = [str(ROBOTS / f"{robot}.json"), state, str(steps)]
    program = [interpreter(), str(ROOT / "tests" / "step_cost.py"), *arguments]
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *program]
    environment = {**os.environ, "MICROPYPATH": f"{ROOT}:.frozen", "PYTHONHASHSEED": "0"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode or not found:
        raise SystemExit(f"callgrind failed: {done.stdout[-500:]}{done.stderr[-500:]}")
    return int(found[1])


def measured() -> dict[str, int]:
    """Return the instructions of a step in each state."""
    return {
        state: (counted(robot, state, STEPS) - counted(robot, state, 0)) // STEPS for state, robot in STATES.items()
    }


def main() -> int:
    """Measure; return how many states have left their band."""
    if shutil.which("valgrind") is None:
        print("valgrind is not here, so no instruction can be counted: apt install valgrind", file=sys.stderr)
        return 1
    found = measured()
    if "--write" in sys.argv:
        BUDGET.write_text(json.dumps(found, indent=2) + "\n")
    budget = json.loads(BUDGET.read_text())
    off = 0
    for state, cost in found.items():
        moved = cost / budget[state] - 1
        off += abs(moved) > BAND
        mark = f"  beyond {100 * BAND:g} %: make it cheaper, or --write a new budget" if abs(moved) > BAND else ""
        print(f"{state:8} {cost:8} instructions a control step, budget {budget[state]} ({100 * moved:+.1f} %){mark}")
    return off if "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
