"""The worst case of a script: numbers worked out by hand, and every limit with the line that breaks it.

The robot of these tests draws 200 mA and 380 mW a coil at full duty; its heat budget leaks with 3 s.
"""

import json

import pytest

from host.gait.checker import check
from host.gait.diagnostics import Problems
from host.gait.trial.trial import Trial
from tests.gait_scripts import compiled, report, round_robot

STEP_MS = 5
FULL_MW = 380


def coil(made, label):
    return next(row for row in made.coils if row.label == label)


def limits(body, profile=None):
    return [(item.code, item.place.line - 2, item.place.column) for item in report(body, profile).diagnostics]


def heat_mj(power_mw, time_ms, start_mj=0.0):
    """Return the heat of a coil by the firmware's own rule, one control step after another."""
    heat = start_mj
    for _ in range(time_ms // STEP_MS):
        heat += power_mw * STEP_MS / 1000 - heat * STEP_MS / 3000
    return heat


def test_time_is_the_sum_of_what_comes_one_after_another():
    made = report("fire A at 50 % for 1 s\nwait 500 ms\nrepeat 3:\n    fire B at 50 % for 200 ms overlap 50 ms")

    assert made.shortest_ms == 1000 + 500 + 3 * 150 + 50
    assert made.longest_ms == made.shortest_ms + STEP_MS


def test_a_wait_counts_in_full_for_the_longest_time_and_not_at_all_for_the_shortest():
    made = report("repeat 2:\n    wait until any.temperature > 60 C timeout 4 s else continue\nwait 1 s")

    assert (made.shortest_ms, made.longest_ms) == (1000, 2 * (4000 + STEP_MS) + 1000 + STEP_MS)


def test_coils_that_outlast_the_last_statement_count_into_the_time():
    assert report("fire A at 50 % for 2 s overlap 2 s\nwait 300 ms").shortest_ms == 2000


def test_on_time_energy_and_orders_add_up_for_each_coil():
    made = report("repeat 4:\n    fire A B at 50 % for 250 ms\n    wait 10 s\nfire A at 25 % for 1 s")

    assert coil(made, "A").on_ms == 2000
    assert coil(made, "A").orders == 5
    assert coil(made, "A").energy_mj == FULL_MW // 2 + FULL_MW // 4
    assert coil(made, "B").energy_mj == FULL_MW // 2
    assert coil(made, "C").on_ms == coil(made, "C").energy_mj == 0


def test_an_order_that_takes_the_place_of_another_ends_it():
    made = report("fire A at 50 % for 2 s overlap 1 s\nfire A at 10 % for 1 s")

    assert coil(made, "A").on_ms == 2000
    assert coil(made, "A").energy_mj == FULL_MW // 2 + FULL_MW // 10


def test_an_order_before_a_wait_is_taken_to_run_its_course():
    made = report(
        "fire A at 50 % for 2 s overlap 2 s\n"
        "wait until A.temperature > 60 C timeout 4 s else continue\n"
        "fire A at 10 % for 1 s"
    )

    assert coil(made, "A").on_ms == 3000


def test_the_current_is_the_mean_over_the_pwm_period_of_all_coils_on_at_once():
    made = report("together:\n    fire A B at 50 % for 1 s\n    fire C at 30 % for 1 s\nfire D at 90 % for 1 s")

    assert made.current_ma == 100 + 100 + 60
    assert made.at_once == 3


def test_coils_that_follow_each_other_are_not_on_at_once():
    assert report("repeat 9:\n    fire A at 50 % for 100 ms\n    fire B at 50 % for 100 ms").at_once == 1


def test_heat_is_what_the_firmware_would_count_rounded_against_the_script():
    made = report("fire A at 80 % for 1 s\nwait 2 s\nfire A at 80 % for 1 s")

    expected = heat_mj(0.8 * FULL_MW, 1000, heat_mj(0, 2000, heat_mj(0.8 * FULL_MW, 1000)))
    assert expected < coil(made, "A").heat_peak_mj < expected + 2


def test_heat_covers_the_firmwares_rounding_to_microjoules():
    profile = round_robot()
    trial = Trial(profile, Problems(()))
    heat_uj = peak_uj = 0

    trial.play(compiled("repeat 40:\n    fire A at 7 % for 500 ms\n    wait 100 ms").plan)
    for turn_ms in range(0, 40 * 600, STEP_MS):
        power_uw = 26_600 if turn_ms % 600 < 500 else 0
        heat_uj += power_uw * STEP_MS // 1000 - heat_uj * STEP_MS // 3000
        peak_uj = max(peak_uj, heat_uj)

    assert peak_uj <= trial.coils[0].heat_peak_uj < peak_uj + 1000


def test_a_loop_of_ten_thousand_turns_is_worked_out_as_exactly_as_one_of_few():
    body = "repeat {}:\n    fire A at 30 % for 500 ms\n    wait 500 ms\n"

    few, many = report(body.format(60)), report(body.format(10_000))

    assert coil(many, "A").heat_peak_mj == coil(few, "A").heat_peak_mj
    assert coil(many, "A").on_ms == 5_000_000
    assert coil(many, "A").energy_mj == 10_000 * 57
    assert many.shortest_ms == 10_000_000


def test_nested_loops_are_worked_out_too():
    made = report(
        "repeat 300:\n    repeat 200:\n        fire A at 10 % for 100 ms\n    wait 1 s\n    fire B at 10 % for 1 s"
    )

    assert coil(made, "A").on_ms == 300 * 200 * 100
    assert coil(made, "A").orders == 60_000
    assert made.shortest_ms == 300 * (200 * 100 + 1000 + 1000)


def test_a_wait_gives_a_coil_no_time_to_cool_in_the_worst_case():
    hot = report("repeat 3:\n    fire A at 60 % for 1 s\n    wait until A.temperature < 45 C timeout 20 s else abort")
    cooled = report("repeat 3:\n    fire A at 60 % for 1 s\n    wait 20 s")

    assert coil(hot, "A").heat_peak_mj > 2 * coil(cooled, "A").heat_peak_mj


@pytest.mark.parametrize(
    ("body", "code", "line", "column"),
    [
        ("fire A at 90 % for 1 s\nfire A at 91 % for 1 s", "E301", 2, 11),
        ("fire A at 10 % for 4 s\nwait 6 s\nfire A at 10 % for 4001 ms", "E302", 3, 20),
        ("repeat 3:\n    fire A at 10 % for 2001 ms", "E303", 2, 5),
        ("fire A B C D at 10 % for 1 s overlap 1 ms\nfire E at 10 % for 1 s", "E304", 2, 1),
        ("fire A B at 90 % for 1 s overlap 1 ms\nfire C at 21 % for 1 s", "E305", 2, 1),
        ("fire A at 80 % for 2 s\nfire A at 80 % for 2 s", "E306", 2, 1),
        ("repeat 100:\n    fire A at 80 % for 500 ms\n    wait 200 ms", "E306", 2, 5),
        ("guard any.temperature > 119 C\nguard any.temperature > 120 C", "E310", 2, 25),
        ("fire A at 80 % for 1 s until 120 C", "E310", 1, 30),
        ("fire A at 9 % for 3 s\nfire A at 9 % for 3 s\nwait 2 s\nfire A at 9 % for 1 s", "E312", 4, 1),
    ],
)
def test_a_limit_is_reported_at_the_line_that_breaks_it(body, code, line, column):
    assert limits(body) == [(code, line, column)]


@pytest.mark.parametrize(
    "body",
    [
        "fire A at 90 % for 1 s",
        "fire A at 10 % for 4 s",
        "fire A at 10 % for 4 s\nfire A at 10 % for 1995 ms",
        "fire A B C D at 10 % for 1 s\nfire E F G H at 10 % for 1 s",
        "fire A B at 90 % for 1 s overlap 1 ms\nfire C at 20 % for 1 s",
        "fire A at 9 % for 3 s\nfire A at 9 % for 3 s\nwait 2005 ms\nfire A at 9 % for 1 s",
        "guard any.temperature > 119.9 C",
    ],
)
def test_a_script_that_goes_up_to_the_limit_is_sound(body):
    made = report(body)

    assert made.sound
    assert made.exit_code == 0


def test_coils_on_within_one_control_step_of_each_other_count_as_never_off():
    assert limits("fire A at 9 % for 4 s\nwait 4 ms\nfire A at 9 % for 2 s") == [("E303", 3, 1)]


def test_every_broken_limit_is_told_at_once():
    assert [code for code, _, _ in limits("fire all at 95 % for 5 s")] == ["E304", "E305", "E306", "E301", "E302"]


def test_a_limit_names_value_and_limit():
    (found,) = report("fire A B C D E at 10 % for 1 s").diagnostics

    assert found.message == "5 coils would be on at once, at most 4"
    assert found.exit_code == 4


def test_nesting_is_held_against_what_the_robot_can_count():
    def nested(depth):
        heads = "".join("    " * level + "repeat 2:\n" for level in range(depth))
        return heads + "    " * depth + "wait 1 ms"

    assert report(nested(8)).depth == 8
    assert report(nested(8)).sound
    assert [code for code, _, _ in limits(nested(9))] == ["E308"]


def test_more_guards_than_the_robot_watches_are_refused():
    guards = [f"guard any.temperature > {90 + number} C" for number in range(9)]

    assert report("\n".join(guards[:8])).guards == 8
    assert limits("\n".join(guards)) == [("E309", 9, 1)]


def test_a_program_larger_than_the_robots_memory_is_refused():
    body = "\n".join(["fire A at 1 % for 5 ms"] * 60)

    made = report(body)

    assert made.program_bytes == 60 * (3 + 11 + 5) + 1
    assert [item.code for item in made.diagnostics] == ["E307"]


def test_a_script_whose_worst_case_cannot_be_worked_out_is_refused_rather_than_trusted():
    loop = "repeat 65535:\n    fire {} at 1 % for 7 ms\n    wait 13 ms"

    assert report(loop.format("A")).sound
    assert "E311" in [code for code, *_ in limits("\n".join(loop.format(label) for label in "ABCDEFGH" * 9))]


def test_the_report_gives_its_numbers_for_json_with_their_limits():
    data = report("fire A B at 50 % for 1 s").as_dict()

    assert json.loads(json.dumps(data)) == data
    assert data["sound"] is True
    assert data["at_once"] == {"most": 2, "limit": 4}
    assert data["supply_current_ma"] == {"most": 200, "limit": 400}
    assert data["coils"]["A"]["energy_mj"] == 190
    assert set(data["coils"]) == set("ABCDEFGH")


def test_the_report_reads_as_a_table_of_the_coils_that_are_fired():
    text = "\n".join(report("fire A B at 50 % for 1 s").lines())

    assert text.startswith("script.gait keeps the limits of round\n")
    assert "2 of 4 coils" in text
    assert "A          1    1.00 s    190 mJ" in text
    assert "\n  C " not in text


def test_overrides_are_checked_as_they_would_run():
    made = check(compiled("param duty = 50 %\nfire A at $duty for 1 s", "duty=95%", profile=round_robot()))

    assert [(item.code, item.place.line) for item in made.diagnostics] == [("E301", 4)]


def test_a_coil_that_stays_on_while_its_heat_is_waited_for_heats_all_that_time():
    made = report(
        "fire A at 90 % for 1 s\nhold A at 90 C with 50 % for 2 s overlap 2 s\n"
        "wait until A.heat < 20 mJ timeout 2 s else abort"
    )

    assert made.coils[0].heat_peak_mj > 400


def test_the_shortest_time_does_not_wait_for_an_order_that_its_cut_off_may_end():
    assert report("fire A at 50 % for 1 s overlap 1 s until 80 C\nwait 100 ms").shortest_ms == 100
    assert report("hold A at 80 C with 50 % for 1 s overlap 1 s\nwait 100 ms").shortest_ms == 1000
