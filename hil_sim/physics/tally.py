"""What is counted while a body moves, the same for ring and sphere: places in its array `tally`, and what they mean."""

from hil_sim.physics.compiled import Array

# Time and next step [s], counts; work of coils, ground and tilting, losses [J] and their rates [W];
TIME, STEP, STEPS, REJECTED, ITERATIONS, COIL_WORK, GROUND_WORK, TILT_WORK = range(8)
BEND_LOSS, DRAG_LOSS, BEND_RATE, DRAG_RATE = range(8, 12)
# greatest force [N] and temperature [degC] of a coil, height of centre of mass and of lowest point [m], rotation [rad];
PEAK_FORCE, PEAK_T, APEX, CLEARANCE, TURN = range(12, 17)
# points that touch, elastic energy [J]; that and the loss [W] of the step being solved; steps taken unsolved.
CONTACTS, ELASTIC, ELASTIC_NEXT, LOSS_NEXT, FORCED = range(17, 22)
TALLIES = 22
GIVEN = {"coils_j": COIL_WORK, "tilt_j": TILT_WORK, "ground_j": GROUND_WORK}
LOST = {"bending_loss_j": BEND_LOSS, "air_loss_j": DRAG_LOSS}


def balance(tally: Array, stored: dict[str, float], stored_at_start: float) -> dict[str, float]:
    """Return what the body holds and what went in and out since the start [J]; `numerical_j` closes the balance.

    Coils, tilting and ground give (the ground mostly takes), bending and air lose.
    """
    flows = {name: float(tally[row]) for name, row in (GIVEN | LOST).items()}
    change = sum(stored.values()) - stored_at_start
    gone = sum(flows[name] for name in GIVEN) - sum(flows[name] for name in LOST)
    return {**stored, **flows, "numerical_j": gone - change}


def effort(tally: Array) -> dict[str, int]:
    """Return how many steps, rejected steps and Newton iterations it took so far, and how many were unsolved."""
    counts = {"steps": STEPS, "rejected": REJECTED, "iterations": ITERATIONS, "forced": FORCED}
    return {name: int(tally[row]) for name, row in counts.items()}
