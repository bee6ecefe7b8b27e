"""How much faster than real time the whole bench runs, and where its time goes.

The crawl of each robot, script to ground, in this process: CPU seconds of the whole; the share of the body
(heat and mechanics), timed by itself; and how the rest divides in a profile, which slows all Python alike.

    python benchmarks/bench_speed.py
"""

import cProfile
import pstats
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
PLACES = (
    ("body", ("hil_sim/bodies/ring.py", "hil_sim/bodies/sphere.py", "hil_sim/bodies/coilbody.py", "hil_sim/physics/")),
    ("chips, wires, supply and clock", ("hil_sim/",)),
    ("firmware", ("firmware/",)),
    ("protocol, both ends", ("protocol/",)),
    ("host", ("host/",)),
)


def script(robot: str) -> str:
    """Return the path of a robot's crawl."""
    return str(ROOT / "gaits" / f"{robot}-crawl.gait")


def crawl(name: str, profile: cProfile.Profile | None = None) -> tuple[float, float]:
    """Run the crawl; return virtual and CPU seconds of the run without its set-up."""
    link = open_link(f"sim:{name}")
    with Robot(link, Keeper()) as robot:
        robot.connect()
        compiled = compile_script(load(script(name)), robot.profile, ())
        begun_s, cpu_s = link.now_s(), time.process_time()
        if profile:
            profile.enable()
        run(robot, compiled.program, lambda stage, done: None)
        if profile:
            profile.disable()
        return link.now_s() - begun_s, time.process_time() - cpu_s


def body_share(name: str) -> float:
    """Return the share of the run that the body takes, timed call by call."""
    spent_s = 0.0
    link = open_link(f"sim:{name}")
    advance = link.bench.plant.advance

    def timed(duration_us, coil_power_w):
        nonlocal spent_s
        begun_s = time.perf_counter()
        advance(duration_us, coil_power_w)
        spent_s += time.perf_counter() - begun_s

    link.bench.plant.advance = timed
    begun_s = time.perf_counter()
    with Robot(link, Keeper()) as robot:
        robot.connect()
        run(robot, compile_script(load(script(name)), robot.profile, ()).program, lambda stage, done: None)
    return spent_s / (time.perf_counter() - begun_s)


def shares(profile: cProfile.Profile) -> dict[str, float]:
    """Return the share of each place in the profiled time; the interpreter's own functions count for nobody."""
    spent = dict.fromkeys((name for name, _ in PLACES), 0.0)
    rows = pstats.Stats(profile).stats.items()
    for (file, _, function), (_, _, own_s, _, _) in rows:
        inside = "hil_sim/physics/" if "hil_sim.physics." in function else file.removeprefix(f"{ROOT}/")
        place = next((name for name, heads in PLACES if inside.startswith(heads)), None)
        if place:
            spent[place] += own_s
    del spent["body"]
    total = sum(spent.values())
    return {name: own_s / total for name, own_s in spent.items()}


def tell(name: str) -> None:
    """Print the real-time factor (best of three) and the split of a profiled run."""
    crawl(name)
    runs = [crawl(name) for _ in range(3)]
    best = max(virtual_s / cpu_s for virtual_s, cpu_s in runs)
    print(f"{name} crawl, {runs[0][0]:.1f} s of virtual time: {best:.1f} x real time on one core")
    body = body_share(name)
    print(f"  {'body':31}{100 * body:4.0f} %")
    profile = cProfile.Profile()
    crawl(name, profile)
    for place, share in shares(profile).items():
        print(f"  {place:31}{100 * share * (1 - body):4.0f} %")


def main() -> None:
    """Tell of every robot."""
    for name in ROBOTS:
        tell(name)


if __name__ == "__main__":
    main()
