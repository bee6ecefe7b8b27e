"""The press as a plant: what the block does under it, for every indenter, material, plane and mesh.

A block whose parts have one Poisson ratio follows the law of one dimension under a bonded punch, whatever the servo
does: force and dent are compared with that law along the way that the axis went.
"""

import math

import numpy as np
import pytest

from hil_sim.physics.block.law import recovery
from hil_sim.physics.block.material import BlockError
from hil_sim.soundness import OutOfModel
from tests.pressed_plants import STIFF_SERVO, drive, driven, plant_of, push_hold_lift

E, C1, C2 = 60e3, 300e3, 6e3


def law(depths, dt):
    """Return S(t) [Pa m], equation (B4), at the end of each step to these depths [m], and the dashpot's length then."""
    q, before, rows = 0.0, 0.0, []
    for depth in depths:
        rate, before = (depth - before) / dt, depth
        q = q * math.exp(-E / C1 * dt) + C1 * rate * -math.expm1(-E / C1 * dt)
        rows.append((q + C2 * rate, depth - q / E))
    return rows


def test_a_bonded_punch_presses_by_the_law_of_one_dimension_and_its_dent_stays_by_it():
    """Row R3 of the facts, whose punch is let go at once: 2.226 mm. Here it is lifted until it tears off."""
    plant = plant_of("indenter.pull_off_n:0", options="indenter=bonded")
    rows = [(t, plant.state.depth, plant.load_n) for t in drive(plant, 7.0, push_hold_lift)]
    torn = next(number for number, (t, _, force) in enumerate(rows) if t > 5.0 and force == 0.0)
    pressed = [row for row in rows[1:torn:2] if row[2] > 0.0]  # after each step of the block
    depths, forces = (np.array([row[index] for row in pressed]) for index in (1, 2))

    told = law(depths, 0.01)

    assert forces == pytest.approx(plant.shape_m * np.array([modulus for modulus, _ in told]), rel=1e-9)
    freed = (C2 * depths[-1] + C1 * told[-1][1]) / (C2 + C1)
    assert plant.observe()["dent_mm"] == pytest.approx(1e3 * freed, rel=0.01)  # it tore off within one step
    assert plant.observe()["dent_mm"] == pytest.approx(2.226, rel=0.02)


def test_the_glue_takes_when_the_punch_first_touches():
    plant = driven(plant_of("indenter.pull_off_n:50", options="indenter=bonded"), 0.5, -2.0)
    lifted = plant.load_n, plant.touching, plant.observe()["dent_mm"]

    pressed = driven(plant, 1.0, 1.0)
    pulled = driven(pressed, 0.3, -0.3).load_n

    assert lifted == (0.0, False, 0.0)
    assert pressed.touching
    assert pressed.state.glue is not None
    assert pulled < 0.0


def test_a_glued_punch_pulls_until_it_tears_off_and_then_presses_without_glue():
    plant = plant_of("indenter.pull_off_n:2", options="indenter=bonded")

    forces = [plant.load_n for _ in drive(plant, 6.0, push_hold_lift)]
    torn, lost_s = plant.load_n, plant.lost_contact_s
    driven(plant, 1.0, 4.0)

    assert -2.0 <= min(forces) < -1.8
    assert (torn, plant.state.glue) == (0.0, None)
    assert 5.2 < lost_s < 5.4
    assert plant.load_n > 1.0


@pytest.mark.parametrize("indenter", ["cylinder", "flat", "bonded", "polygon"])
def test_every_indenter_dents_the_block_and_leaves_it(indenter):
    plant = plant_of(options=f"indenter={indenter}")

    force = driven(plant, 2.0, push_hold_lift).load_n
    driven(plant, 5.0, lambda t: push_hold_lift(t + 2.0))

    seen = plant.observe()
    assert force > 2.0
    assert (seen["force_n"], seen["touching"], seen["model"]["indenter"]) == (0.0, False, indenter)
    assert 1.5 < seen["dent_mm"] < 3.0
    assert 5.0 < seen["lost_contact_s"] < 5.5


def test_the_force_of_a_punch_on_an_elastic_block_is_told_where_the_contact_does_not_grow():
    shapes = {indenter: plant_of(options=f"indenter={indenter}").shape_m for indenter in ("flat", "bonded", "cylinder")}

    assert 0.03 < shapes["flat"] < shapes["bonded"] < 0.05
    assert shapes["cylinder"] is None
    assert plant_of("material.damping_poisson_ratio:0.2", options="indenter=flat").shape_m is None


def test_a_thin_block_is_softer_than_a_deep_one():
    deep, thin = (driven(plant_of(options=f"plane={plane}"), 1.0, 2.0).load_n for plane in ("strain", "stress"))

    assert 0.7 * deep < thin < 0.95 * deep


SECOND = ("material.youngs_modulus_2_kpa:20", "material.viscosity_2_kpa_s:8")
SPRING, PULLED = ("material.parallel_modulus_kpa:5",), ("material.unloading_viscosity_kpa_s:80",)


def test_a_second_branch_resists_the_push_and_is_gone_after_a_while():
    three, five = plant_of(), plant_of(*SECOND)
    pushed = [driven(plant, 2.0, lambda t: 2.0 * t).load_n for plant in (three, five)]
    held = [driven(plant, 3.0, 4.0).load_n for plant in (three, five)]

    assert pushed[1] > 1.05 * pushed[0]
    assert held[1] == pytest.approx(held[0], rel=0.01)


def test_with_a_spring_beside_it_the_dent_creeps_back():
    plants = [driven(plant_of(*rows), 7.0, push_hold_lift) for rows in ((), SPRING)]
    early = [plant.observe()["dent_mm"] for plant in plants]

    late = [driven(plant, 5.0, -3.0).observe()["dent_mm"] for plant in plants]

    assert late[0] == pytest.approx(early[0], rel=1e-3)
    assert late[1] < 0.95 * early[1]


def test_other_viscosities_while_it_is_unloaded_change_the_way_back_only():
    one, dual = plant_of(), plant_of(*PULLED)
    loading = [[plant.load_n for _ in drive(plant, 2.0, push_hold_lift)] for plant in (one, dual)]

    dents = [driven(plant, 5.0, lambda t: push_hold_lift(t + 2.0)).observe()["dent_mm"] for plant in (one, dual)]

    told = [4.0 * float(recovery(plant.numbers.material, 1.9, 2.0, 3.0)) for plant in (one, dual)]
    assert loading[0] == loading[1]
    assert dents == pytest.approx(told, rel=0.03)  # it is not let go at once
    assert dents[1] > 1.03 * dents[0]


def test_parts_with_one_poisson_ratio_leave_no_stress_behind_and_others_do():
    one, mixed = (
        driven(plant_of(*rows), 7.0, push_hold_lift) for rows in ((), ("material.poisson_2_ratio:0.2", *SECOND))
    )

    assert (one.observe()["poisson_one"], mixed.observe()["poisson_one"]) == (True, False)
    assert one.fields()["von_mises_kpa"].max() < 1e-9
    assert mixed.fields()["von_mises_kpa"].max() > 1e-3


def test_the_fields_are_the_mesh_and_what_happened_to_it():
    plant = driven(plant_of(), 2.0, lambda t: 2.0 * t)
    fields, nodes, triangles = plant.fields(), 17 * 9, 2 * 16 * 8

    shapes = {name: values.shape for name, values in fields.items()}
    assert shapes == {
        "points_mm": (nodes, 2), "triangles": (triangles, 3), "displacement_mm": (nodes, 2),
        "stress_kpa": (triangles, 4), "von_mises_kpa": (triangles,), "strain": (triangles, 3),
    }  # fmt: skip
    assert (fields["points_mm"].max(), fields["triangles"].max()) == (80.0, nodes - 1)
    assert fields["displacement_mm"][:, 1].min() == pytest.approx(-plant.observe()["dent_mm"])
    assert fields["von_mises_kpa"].max() == pytest.approx(plant.observe()["von_mises_peak_kpa"], rel=0.05)


def test_a_snapshot_has_the_indenter_on_the_surface_that_it_dents():
    plant = driven(plant_of(), 1.0, 3.0)
    seen = plant.snapshot()

    lowest = min(y for _, y in seen["indenter"]["outline_mm"])
    assert lowest == pytest.approx(40.0 - seen["depth_mm"])
    assert min(y for _, y in seen["surface_mm"]) == pytest.approx(lowest)
    assert seen["block"] == {"width_mm": 80.0, "height_mm": 40.0, "thickness_mm": 40.0, "corner_mm": [0.0, 0.0]}
    assert (seen["limp"], seen["commanded_mm"], seen["touching"]) == (False, 3.0, True)
    assert list(seen["cells"]) == ["C1", "C2", "C3", "C4", "C5", "C6"]
    assert seen["cells"]["C1"]["pressure_kpa"] > 2.0 > seen["cells"]["C2"]["pressure_kpa"]


def test_a_press_beside_the_middle_presses_the_cells_on_its_side():
    cells = driven(plant_of("indenter.at_mm:20"), 1.0, 3.0).observe()["cell_kpa"]

    assert cells["C2"] > 2.0 > cells["C1"] > cells["C3"]


def test_a_press_through_the_block_ends_the_run_with_one_line():
    plant = plant_of("block.height_mm:5", "cells.side_mm:1", "axis.stall_force_n:100000")

    with pytest.raises(
        OutOfModel, match=r"the press left what its model is valid for at .* s, .* stands on at 0.005 m"
    ):
        driven(plant, 1.0, 6.0)


def test_cells_go_with_the_size_of_the_block():
    plant = plant_of("block.width_mm:40", "block.height_mm:20", "cells.side_mm:2")

    cells = plant.snapshot()["cells"]

    assert cells["C2"]["centre_mm"] == pytest.approx([10.0, 15.0])
    assert driven(plant, 1.0, 1.0).observe()["cell_kpa"]["C1"] > 1.0


def test_the_same_commands_do_the_same_however_time_is_cut():
    whole, cut = plant_of(), plant_of()
    for _ in range(100):
        whole.command([2.0])
        cut.command([2.0])
        whole.advance(5_000, np.zeros(0))
        for part in (1_300, 700, 3_000):
            cut.advance(part, np.zeros(0))

    assert cut.load_n == pytest.approx(whole.load_n, rel=1e-9)


@pytest.mark.parametrize("indenter", ["flat", "bonded"])
def test_a_punch_is_as_wide_as_it_is_said_to_be_whatever_the_cells(indenter):
    """Force per modulus and depth grows evenly with the width, though the nodes below it are in steps."""
    shapes = [plant_of(f"indenter.width_mm:{w}", options=f"indenter={indenter}").shape_m for w in range(16, 27, 2)]

    steps = np.diff(shapes)

    assert steps.min() > 0.5 * steps.mean()
    assert steps.max() < 1.5 * steps.mean()


def test_a_wedge_touches_with_its_corner_wherever_it_stands():
    forces = [
        driven(plant_of(f"indenter.at_mm:{at}", options="indenter=polygon"), 1.0, 2.0).load_n
        for at in (39.0, 40.0, 41.5, 42.0)
    ]

    assert forces == pytest.approx([forces[1]] * 4, rel=0.05)


def test_a_punch_narrower_than_a_cell_is_refused():
    with pytest.raises(BlockError, match="columns = 16, too few"):
        plant_of("indenter.width_mm:1", options="indenter=flat")


def test_a_block_of_half_the_thickness_presses_back_with_half_the_force():
    whole, half = (driven(plant_of(f"block.thickness_mm:{mm}", *STIFF_SERVO), 1.0, 1.0) for mm in (40, 20))

    assert half.load_n == pytest.approx(0.5 * whole.load_n, rel=1e-9)
    assert half.cell_pa == pytest.approx(whole.cell_pa, rel=1e-6)


@pytest.mark.parametrize("indenter", ["cylinder", "flat", "bonded", "polygon"])
def test_a_block_that_is_held_is_not_unloaded_however_long_it_takes(indenter):
    """Once the servo stands nothing moves but by rounding, which is no work of the block."""
    one, dual = (
        plant_of(*more, options=f"indenter={indenter}") for more in ((), ("material.unloading_viscosity_kpa_s:3000",))
    )

    for plant in (one, dual):
        driven(plant, 8.0, lambda t: min(2.0 * t, 3.0))

    assert dual.load_n == pytest.approx(one.load_n, rel=1e-9)
