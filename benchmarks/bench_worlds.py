"""How fast the bench runs in both worlds, with the body's physics and without, and how they compare, in one run.

For each robot and world: virtual over wall seconds of its crawl from start to end, with firmware, chips and host in the
loop. Set-up, compilation and the start of the interpreter's process are not in it. The ratio is T1 to T2: what it costs
to run the firmware under real MicroPython, in a process of its own.

    python benchmarks/bench_worlds.py
"""

import time
from pathlib import Path

from hil_sim.link import open_link
from host.gait.compiler import compile_script
from host.gait.script import load
from host.keeper import Keeper
from host.robot import Robot
from host.run import run

ROOT = Path(__file__).parent.parent
ROBOTS = ("circular", "sphere-a", "sphere-b")
BODIES = {"with physics": "", "body still": "&body=still"}
TURNS = 3
AIMS = {"cpython": 50, "micropython": 5}  # for the circular robot


def factor(robot_name: str, world: str, body: str) -> float:
    """Return virtual over wall seconds of a crawl."""
    link = open_link(f"sim:{robot_name}?world={world}{body}")
    with Robot(link, Keeper()) as robot:
        robot.connect()
        compiled = compile_script(load(str(ROOT / "gaits" / f"{robot_name}-crawl.gait")), robot.profile, ())
        begun_s, wall_s = link.now_s(), time.perf_counter()
        run(robot, compiled.program, lambda stage, done: None)
        return (link.now_s() - begun_s) / (time.perf_counter() - wall_s)


def best(robot_name: str, body: str) -> dict[str, float]:
    """Return the best factor of each world; the worlds take turns, so that a busy machine slows both."""
    found: dict[str, list[float]] = {world: [] for world in AIMS}
    for _ in range(TURNS):
        for world, factors in found.items():
            factors.append(factor(robot_name, world, body))
    return {world: max(factors) for world, factors in found.items()}


def main() -> None:
    """Print a row for each robot and body."""
    print("virtual over wall seconds of a crawl        T1    T2   T1 : T2")
    for robot_name in ROBOTS:
        for name, body in BODIES.items():
            t1, t2 = best(robot_name, body).values()
            print(f"  {robot_name:10} {name:24}{t1:9.1f}{t2:6.1f}{t1 / t2:8.1f}")
    print("aim for the circular robot: " + ", ".join(f"{world} {aim}" for world, aim in AIMS.items()))


if __name__ == "__main__":
    main()
