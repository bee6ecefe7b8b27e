"""What is unrolled on the host: `for` over coils, values and numbers, `sym` over spheres and rings, notes and holds."""

import pytest

from host.gait.compiler import compile_script
from host.gait.plan import Fire, walk
from host.gait.script import loads
from protocol import program
from tests.gait_scripts import CIRCLE, ball_robot, compiled, hand_robot, ops, press_robot, profile_of

AT = "at 5 % for 100 ms overlap 100 ms"


def fired(body, robot=None):
    """Return the labels that each order of a script is for."""
    profile = robot or ball_robot()
    plan = compiled(body, profile=profile).plan
    return [" ".join(profile.named(op.mask)) for op in walk(plan) if isinstance(op, Fire)]


def on(robot, body):
    """Return the same for a robot of the bench."""
    profile = profile_of(robot)
    plan = compile_script(loads(f"gait 1\nrobot {robot}\n{body}\n"), profile).plan
    return [" ".join(profile.named(op.mask)) for op in walk(plan) if isinstance(op, Fire)]


@pytest.mark.parametrize(
    ("items", "masks"),
    [
        ("C A B", [4, 1, 2]),
        ("front C", [1, 2, 4]),
        ("G front", [64, 1, 2]),
        ("A C, B D", [5, 10]),
        ("front, even, H", [3, 0b1010101, 128]),
        ("all", [1 << channel for channel in range(8)]),
    ],
)
def test_a_for_takes_coils_one_by_one_and_lists_with_commas_whole(items, masks):
    assert [row[1] for row in ops(f"for c in {items}:\n    fire $c {AT}")] == masks


def test_a_for_takes_values_and_whole_numbers_up_to_the_last():
    assert [row[2] for row in ops("for d in 20 %, 2 * 20 %:\n    fire A at $d for 1 s overlap 1 s")] == [200, 400]
    assert [row[1] for row in ops("for k in 0 .. 3:\n    wait $k * 1 s + 1 ms")] == [1, 1001, 2001, 3001]


def test_a_for_goes_through_what_a_def_was_given():
    inner = "        for k in 1 .. $most:\n            fire $c at $k * 1 % for 5 ms\n"
    body = f"def each(list, most):\n    for c in $list:\n{inner}each(front, 2)"

    rows = [row for row in ops(body) if row[0] == "fire"]

    assert [(row[1], row[2]) for row in rows] == [(1, 10), (1, 20), (2, 10), (2, 20)]


def test_a_for_takes_joints_and_force_cells_too():
    moves = ops("move all to 0 deg over 1 s\nfor j in L R:\n    move $j to 4 deg over 1 s", profile=hand_robot())
    waits = ops("for c in C3 C1:\n    wait until $c.pressure > 1 kPa timeout 1 s else abort", profile=press_robot())

    assert [row[1] for row in moves if row[0] == "move"] == [3, 2, 1]
    assert [row[1].mask for row in waits] == [4, 1]


def test_a_for_within_a_together_is_one_of_the_things_that_start_at_once():
    body = "together:\n    fire H at 5 % for 30 ms\n    for c in A B:\n        fire $c at 5 % for 10 ms"

    assert [row[:2] for row in ops(body)] == [
        ("fire", 128), ("fire", 1), ("delay", 10), ("fire", 2), ("delay", 20),
    ]  # fmt: skip


def test_a_turn_of_the_body_brings_another_coil_to_each_place():
    assert on("sphere-a", f"sym z 90 deg:\n    fire A100 {AT}") == ["A0m10"]
    assert on("sphere-a", f"sym x 90 deg:\n    fire A010 {AT}") == ["A00m1"]
    assert on("sphere-a", f"sym y 90 deg:\n    fire A001 {AT}") == ["Am100"]


def test_turns_come_one_after_another_as_they_are_written_or_nested():
    line = "fire A110 A001 at 5 % for 100 ms"

    assert on("sphere-a", f"sym z 90 deg, x 180 deg:\n    {line}") == ["A00m1 Am1m10"]
    assert on("sphere-a", f"sym z 90 deg:\n    sym x 180 deg:\n        {line}") == ["A00m1 Am1m10"]
    assert on("sphere-a", f"sym x 180 deg, z 90 deg:\n    {line}") != ["A00m1 Am1m10"]


def test_a_sphere_has_twenty_four_orientations():
    turns = [f"sym {axis} {angle} deg, z {spin} deg:\n    fire A100 {AT}\n    fire A010 {AT}"
             for axis, angle in (("x", 0), ("x", 90), ("x", 180), ("x", 270), ("y", 90), ("y", -90))
             for spin in (0, 90, 180, 270)]  # fmt: skip

    assert len({tuple(on("sphere-a", turn)) for turn in turns}) == 24


def test_a_turn_back_undoes_a_turn():
    assert on("sphere-b", f"sym y 90 deg:\n    sym y -90 deg:\n        fire diagonals B10m1 {AT}") == on(
        "sphere-b", f"fire diagonals B10m1 {AT}"
    )


def test_a_ring_turns_by_places_in_the_order_of_the_profile():
    body = f"for k in 0 .. 7:\n    sym $k * 45 deg:\n        fire A {AT}"

    assert on("circular", body) == list("ABCDEFGH")
    assert on("circular", f"sym -45 deg:\n    fire A B {AT}") == ["A H"]


def test_a_turn_reaches_through_calls_and_into_conditions_and_lets():
    body = (
        "circle roll = A100 A010 Am100 A0m10\ndef push(c):\n    fire $c at 5 % for 1 s\n"
        "    wait until $c.heat < 9 mJ timeout 1 s else continue\n    wait until down is $c timeout 1 s else continue\n"
        "    let next = roll[down + 1]\n    fire $next at 5 % for 1 s\nsym z 90 deg:\n    push(A100)"
    )
    profile = profile_of("sphere-a")
    code = compile_script(loads(f"gait 1\nrobot sphere-a\n{body}\n"), profile).code

    rows = {row[1]: row[2:] for row in program.disassemble(code) if row[1] in ("fire", "aim")}
    waits = [row[2].mask for row in program.disassemble(code) if row[1] == "wait"]

    there = profile.mask(["A0m10"])
    assert (rows["fire"][0], waits) == (there, [there, there])
    assert [profile.labels[channel] for channel in rows["aim"][2]] == ["A0m10", "A100", "A010", "Am100"]


def test_joints_and_any_coil_at_all_are_not_turned():
    assert ops("sym 45 deg:\n    wait until any.heat < 5 mJ timeout 1 s else abort") == ops(
        "wait until any.heat < 5 mJ timeout 1 s else abort"
    )


def test_a_hold_keeps_its_temperature_in_the_cut_off_with_a_mark():
    assert ops("hold A C at 80 C with 40 % for 2 s overlap 500 ms") == [
        ("fire", 5, 400, 2000, program.KEEP | 800), ("delay", 1500),
    ]  # fmt: skip


def test_a_chosen_coil_can_be_held():
    body = CIRCLE + "let next = roll[down]\nhold $next at 60 C with 30 % for 1 s"

    assert ("aimed", 0, 300, 1000, program.KEEP | 600, 0) in ops(body, profile=ball_robot())


def test_a_note_is_told_with_what_params_and_arguments_stand_for():
    body = 'param duty = 60 %\ndef push(c):\n    note "push $c at $duty, $5 or 100%"\npush(front)\n'

    made = compiled(body + 'for k in 1 .. 2:\n    note "turn $k"', "duty=7.5%")

    notes = [row for row in program.disassemble(made.code) if row[1] == "note"]
    assert [made.step(row[2]).note for row in notes] == ["push A B at 7.5 %, $5 or 100%", "turn 1", "turn 2"]


def test_a_note_within_a_sym_tells_the_coil_that_is_meant_there():
    made = compiled('def f(c):\n    note "push $c"\nsym 45 deg:\n    f(A)')

    assert made.steps[0].note == "push B"


def test_a_note_in_a_together_is_told_in_its_time():
    body = 'together:\n    fire A at 5 % for 30 ms\n    repeat 2:\n        wait 10 ms\n        note "on"'

    assert [row[0] for row in ops(body)] == ["fire", "delay", "note", "delay", "note", "delay"]


def test_words_that_came_later_may_still_name_params_and_arguments():
    body = (
        "param hold = 15 %\ndef f(label, on):\n    fire $label at $hold for $on\nfor note in A B:\n    f($note, 5 ms)"
    )

    assert [row[1] for row in ops(body) if row[0] == "fire"] == [1, 2]


def test_the_sources_of_conditions_that_came_later_are_in_their_own_units():
    made = ops(
        "guard A.resistance > 4.2 ohm\nguard all.martensite < 20 %\nwait until time > 90 s timeout 1 s else continue"
    )

    assert [row[1][:4] for row in made] == [
        (program.RESISTANCE, program.ANY, program.ABOVE, 420), (program.MARTENSITE, program.ALL, program.BELOW, 200),
        (program.TIME, program.ANY, program.ABOVE, 0),
    ]  # fmt: skip
    assert made[2][1].mask == 90_000


def test_every_turn_of_a_for_is_a_step_of_its_own_with_the_line_it_came_from():
    made = compiled("for c in A B C:\n    fire $c at 5 % for 5 ms")

    assert [step.place.line for step in made.steps] == [4, 4, 4]
