"""How fast the sequencer goes in both interpreters, and how many bytes a gait takes in which form.

The sequencer alone, without chips and estimate (step_budget.py has the whole control step), on this machine's CPU; the
best of several runs. Then every script of gaits/: its op-codes against its tree as JSON and as YAML, without blanks
that nobody needs.

    python benchmarks/bench_sequencer.py
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import yaml

from hil_sim.worlds.micropython import interpreter
from host.gait.compiler import compile_script
from host.gait.forms.layout import layout
from host.gait.forms.treejson import as_json
from host.gait.plan import Fire, walk
from host.gait.script import load
from host.profile import read_profile

ROOT = Path(__file__).parent.parent
RUNS = 5


def paces(program: str) -> tuple[float, float]:
    """Return control steps and ops a second of the sequencer under that interpreter."""
    environment = {**os.environ, "MICROPYPATH": f"{ROOT}:.frozen", "PYTHONPATH": str(ROOT)}
    command = [program, str(ROOT / "benchmarks" / "sequencer_trial.py")]
    found = []
    for _ in range(RUNS):
        done = subprocess.run(command, capture_output=True, text=True, env=environment, check=True)
        found.append(tuple(map(float, done.stdout.split())))
    return max(found)


def sizes(path: Path) -> tuple[int, int, int, int, int]:
    """Return the bytes of a script as op-codes, as JSON, as YAML and as text, and how many fires it has."""
    script = load(path)
    profile = read_profile((ROOT / "firmware" / "robots" / f"{script.robot_name()}.json").read_bytes())
    made = compile_script(script, profile)
    trees = [as_json(layout(file)) for file in script.files]
    json_bytes = sum(len(json.dumps(tree, separators=(",", ":"))) for tree in trees)
    yaml_bytes = sum(len(yaml.safe_dump(tree, default_flow_style=True, width=1 << 20)) for tree in trees)
    text = sum(len("\n".join(file.lines).encode()) for file in script.files)
    return len(made.code), json_bytes, yaml_bytes, text, sum(isinstance(op, Fire) for op in walk(made.plan))


def main() -> None:
    """Measure and print."""
    print("sequencer       control steps/s      ops/s   times real time (200 steps/s)")
    for name, program in (("CPython", sys.executable), ("MicroPython", interpreter())):
        steps, ops = paces(program)
        print(f"  {name:12}{steps:17,.0f}{ops:11,.0f}{steps / 200:12,.0f}")
    print("bytes                              op-codes     JSON     YAML     text   a fire")
    for path in sorted((ROOT / "gaits").glob("*.gait")):
        code, json_bytes, yaml_bytes, text, fires = sizes(path)
        each = f"{code / fires:9.1f}" if fires else "        -"
        print(f"  {path.stem:32}{code:9}{json_bytes:9}{yaml_bytes:9}{text:9}{each}")


if __name__ == "__main__":
    main()
