"""The worst case that the checker tells of a script, held against what the bench then measures.

Random scripts of the whole language that keep the limits run on a healthy robot of the bench: none is refused, none
trips a limit, none lasts longer, heats longer or takes more energy than was told. Fingers are left out: what they grip
may stall a servo that is told to go through it, and no checker knows the object.
"""

import os
from functools import cache

import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from hil_sim.link import open_link
from host.gait.checker import check
from host.gait.compiler import compile_script
from host.gait.script import loads
from host.keeper import Keeper
from host.robot import Robot
from host.run import run
from tests.gait_scripts import profile_of
from tests.gait_strategy import examples, scripts

BODIES = {"circular": "body=still", "sphere-b": "body=still", "press": "indenter=flat"}
LONGEST_MS = 8000
SWITCHED_MS = 1  # within which the chip has heard what a control step ordered, at either end of an order
TESTED_MS = 3  # of the test before arming
ENDS = ("done", "timeout", "guard")


def ran(robot, made):
    """Return how a script ended on the bench, how long it took by the robot's clock, and what the bench saw."""
    link = open_link(f"sim:{robot}?{BODIES[robot]}")
    keeper = Keeper(scenes=False)
    face = Robot(link, keeper)
    face.connect()
    ending = run(face, made.program, lambda stage, done: None)
    link.close()
    begun = next(event.now_ms for event in keeper.recording.events if event.event == "started")
    return ending, ending.event.now_ms - begun, link.bench.observe()


def compiled(robot, text):
    return compile_script(loads(text), profile_of(robot))


@cache
def pulses(robot):
    """Return the most energy of a coil by the pulses with which the robot measures it, most often while it is on."""
    labels = profile_of(robot).coil_labels
    if not labels:
        return 0.0
    weakly = f"fire {labels[0]} at 0.1 % for 2 s\nwait 500 ms\n" * (LONGEST_MS // 2500)
    return ran(robot, compiled(robot, f"gait 1\nrobot {robot}\n{weakly}"))[2]["coil_energy_j"][labels[0]]


def full_w(profile):
    """Return the power of a coil at full duty on the nominal supply, in mJ a ms."""
    coil = profile.coil
    return profile.supply_mv**2 * coil.resistance_mohm / (coil.resistance_mohm + coil.wiring_mohm) ** 2 / 1000


@pytest.mark.parametrize("robot", BODIES)
def test_what_the_checker_passes_keeps_its_worst_case_on_the_bench(robot):
    @settings(
        max_examples=examples(3),
        deadline=None,
        phases=[Phase.generate],
        derandomize="SOFTRIG_EXAMPLES" not in os.environ,
        suppress_health_check=list(HealthCheck),
    )
    @given(st.data())
    def holds(data):
        made = compiled(robot, data.draw(scripts(profile_of(robot))))
        worst = check(made)
        assume(worst.sound and worst.longest_ms < LONGEST_MS)

        ending, took_ms, seen = ran(robot, made)

        assert ending.result in ENDS, ending
        assert took_ms <= worst.longest_ms
        energy_j = pulses(robot)
        for coil in worst.coils:
            assert seen["coil_on_s"][coil.label] * 1000 <= coil.on_ms + SWITCHED_MS * coil.orders + TESTED_MS
            more_mj = 1e-6 + SWITCHED_MS * coil.orders * full_w(made.profile)
            assert (seen["coil_energy_j"][coil.label] - energy_j) * 1000 <= coil.energy_mj + more_mj

    holds()
