"""The worst case of scripts with several ways through them: labels that waits go on at, and what a fault does.

The robot of these tests draws 200 mA and 380 mW a coil at full duty; its heat budget leaks with 3 s.
"""

from random import Random

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from firmware.player import FINISHED, TIMED_OUT
from protocol.verify import check_code
from tests.gait_scripts import ball_robot, compiled, hand_robot, press_robot, report
from tests.joint_scripts import HOME, moves, orients
from tests.test_gait_moves_on_firmware import READY_MS
from tests.test_gait_moves_on_firmware import Bare as Hand
from tests.test_gait_on_firmware import STEP_MS, Bare

LATER = "wait until A.temperature > 90 C timeout 1 s else"


def coil(made, label):
    return next(row for row in made.coils if row.label == label)


def limits(body, profile=None):
    return [(item.code, item.place.line - 2, item.place.column) for item in report(body, profile).diagnostics]


def test_the_shortest_way_may_be_the_one_that_jumps():
    made = report(f"{LATER} end\nwait 5 s\nlabel end\nwait 1 s")

    assert made.shortest_ms == 2000
    assert made.longest_ms == 1000 + 5000 + 1000 + 2 * STEP_MS


def test_what_is_jumped_over_counts_for_those_who_do_not_jump():
    made = report(f"{LATER} end\nfire A at 50 % for 1 s\nlabel end\nfire B at 50 % for 1 s")

    assert [coil(made, label).on_ms for label in "AB"] == [1000, 1000]


def test_a_jump_leaves_no_time_to_cool_but_that_of_its_wait():
    wait = "wait until A.temperature > 110 C timeout {} else end\nwait 20 s\nlabel end\n"
    body = f"fire A at 80 % for 2 s\n{wait}fire A at 80 % for 1500 ms"

    assert limits(body.format("5 ms")) == [("E306", 5, 1)]
    assert limits(body.format("15 s")) == []


def test_a_coil_that_is_on_when_a_wait_jumps_is_still_on_at_the_label():
    body = f"fire A B C at 10 % for 2 s overlap 2 s\n{LATER} end\nwait 5 s\nlabel end\nfire D E at 10 % for 1 s"

    assert limits(body) == [("E304", 5, 1)]


def test_a_jump_out_of_ten_thousand_turns_counts_all_of_them():
    wait = "wait until B.temperature > 90 C timeout 900 ms else end"
    body = f"repeat 10000:\n    fire A at 5 % for 100 ms\n    {wait}\nlabel end\nwait 1 s\n"

    made = report(body + "fire B at 10 % for 1 s")

    assert (coil(made, "A").orders, coil(made, "A").on_ms) == (10_000, 1_000_000)
    assert coil(made, "B").on_ms == 1000
    assert made.shortest_ms == 100 + 900 + 2000


def test_an_abort_in_the_last_of_ten_thousand_turns_counts_all_of_them():
    wait = "wait until B.temperature > 90 C timeout 900 ms else abort"
    body = f"repeat 5:\n    repeat 2000:\n        fire A at 5 % for 100 ms\n        {wait}\n    wait 1 s\n"

    made = report(body + "on fault:\n    fire A at 10 % for 1 s")

    assert (coil(made, "A").orders, coil(made, "A").on_ms) == (10_001, 1_001_000)


def test_jumps_out_of_nested_loops_count_the_turns_of_both():
    inner = "        fire A at 5 % for 100 ms\n        wait until B.temperature > 90 C timeout 900 ms else end\n"
    body = (
        f"repeat 300:\n    repeat 200:\n{inner}    wait 1 s\nfire C at 1 % for 50 ms\nlabel end\nfire B at 10 % for 1 s"
    )

    made = report(body)

    assert (coil(made, "A").orders, coil(made, "C").orders) == (60_000, 1)


def test_after_an_abort_coils_are_off_and_their_heat_is_what_they_had():
    body = f"fire A B C at 10 % for 4 s overlap 4 s\n{LATER} abort\nwait 10 s\non fault:\n    fire {{}} at 10 % for 1 s"

    assert report(body.format("D E F")).sound
    assert 2000 <= coil(report(body.format("A") + "\n    fire A at 10 % for 3 s"), "A").on_ms <= 5010


def test_what_a_fault_does_is_held_to_the_limits_from_every_wait_that_may_abort():
    wait = "wait until A.temperature > 110 C timeout 10 ms else abort"
    body = f"fire A at 80 % for 2 s\n{{}}\nwait 20 s\n{wait}\non fault:\n    fire A at 80 % for 1500 ms"

    assert limits(body.format("wait 10 ms")) == []
    assert limits(body.format(wait)) == [("E306", 6, 5)]


def test_a_coil_that_a_fault_fires_again_has_been_on_before():
    before = "fire A at 5 % for 3 s\nfire A at 5 % for 3 s overlap 3 s"
    body = f"{before}\n{LATER} abort\nwait 9 s\non fault:\n    fire A at 5 % for 3 s"

    assert limits(body) == [("E303", 6, 5)]


def test_what_a_fault_does_counts_into_the_longest_time_and_not_into_the_shortest():
    made = report(f"{LATER} abort\non fault:\n    fire A at 5 % for 3 s")

    assert (made.shortest_ms, made.longest_ms) == (0, 1000 + 3000 + 2 * STEP_MS)


def test_a_joint_stands_after_an_abort_where_it_was_on_its_way():
    body = "move all to 0 deg over 1 s\nmove R to 20 deg over 2 s overlap 2 s\n" + LATER.replace(
        "A.temperature > 90 C", "R.angle > 25 deg"
    )

    body += " abort\non fault:\n    wait 2 s\n    move R to 0 deg over {} ms"

    assert limits(body.format(110), hand_robot()) == []
    assert limits(body.format(90), hand_robot()) == [("E318", 6, 26)]


def test_the_camera_may_be_lost_while_a_joint_stands_anywhere():
    body = "move all to 0 deg over 1 s\norient 5 deg for 1 s\non fault:\n    move R to 0 deg over {} ms"

    assert limits(body.format(300), hand_robot()) == []
    assert limits(body.format(299), hand_robot()) == [("E318", 4, 26)]


def test_a_press_is_brought_home_after_an_abort():
    body = "move P to -2 mm over 3 s\npress to 5 N over 1 s for 4 s\nwait until force > 4 N timeout 1 s else abort\n"

    assert limits(body + "on fault:\n    move P to -2 mm over 3 s", press_robot()) == []
    assert [item[0] for item in limits(body + "on fault:\n    move P to -2 mm over 1 s", press_robot())] == ["E318"]


def test_a_let_that_is_jumped_over_must_be_chosen_again_as_the_robot_demands_too():
    head = "circle roll = A100 A001\nwait until any.temperature > 90 C timeout 1 s else end\n"
    made = compiled(
        head + "let x = roll[down]\nlabel end\nlet x = roll[down]\nfire $x at 5 % for 1 s", profile=ball_robot()
    )

    check_code(made.code, 8, 1024)


def test_an_order_before_a_wait_may_still_be_on_when_the_wait_ends_and_counts_as_on_all_the_time():
    body = f"fire A at 9 % for 4 s overlap 4 s\n{LATER} continue\nfire A at 9 % for {{}} s"

    assert limits(body.format(2)) == []
    assert limits(body.format(3)) == [("E303", 3, 1)]


def test_more_ways_than_can_be_followed_are_refused(monkeypatch):
    monkeypatch.setattr("host.gait.trial.trial.EVENTS_MAX", 3000)
    turns = "\n".join(
        f"repeat 65535:\n    fire {label} at 1 % for 7 ms\n    {LATER} end\n    wait 3 ms" for label in "ABCDEFGH" * 9
    )

    assert "E311" in [code for code, *_ in limits(turns + "\nlabel end\nwait 1 s")]


coils = st.lists(st.sampled_from("ABCD"), min_size=1, max_size=3, unique=True).map(" ".join)
fires = st.one_of(
    st.builds("fire {} at {} % for {} ms{}".format, coils, st.integers(1, 70), st.integers(20, 1500),
              st.sampled_from(["", " overlap 20 ms", " overlap 13 ms", " until 80 C", " ramp 17 ms"])),
    st.builds("hold {} at {} C with {} % for {} ms".format, coils, st.integers(25, 90), st.integers(1, 60),
              st.integers(20, 900)),
)  # fmt: skip
waits = st.one_of(
    st.integers(1, 900).map("wait {} ms".format),
    st.builds("wait until {} timeout {} ms else {}".format,
              st.sampled_from(["A.temperature > 40 C", "any.heat > 90 mJ", "time > 700 ms", "all.temperature > 99 C"]),
              st.integers(1, 500), st.sampled_from(["abort", "abort", "one", "two", "continue"])),
)  # fmt: skip


def blocks(inner):
    bodies = st.lists(inner, min_size=1, max_size=3).map(lambda lines: "\n".join(lines).replace("\n", "\n    "))
    heads = st.sampled_from(["repeat 2", "repeat 5", "for x in 1 %, 2 %", "sym 90 deg"])
    return st.builds("{}:\n    {}\n    wait 1 ms".format, heads, bodies)


parts = st.lists(fires | waits | blocks(fires | waits), min_size=1, max_size=3).map("\n".join)
scripts = st.builds(
    "{}\nlabel one\n{}\nlabel two\n{}\non fault:\n    {}".format,
    parts,
    parts.map(lambda text: text.replace("else one", "else two")),
    parts.map(lambda text: text.replace("else one", "else abort").replace("else two", "else continue")),
    st.lists(fires, min_size=1, max_size=2).map("\n    ".join),
)


def run(code, seed):
    """Return the table top after a program whose conditions hold by chance, which may have been aborted."""
    bare, random = Bare(code), Random(seed)
    chance, holds = random.choice([0, 0, 0.001, 0.01]), bare.player._holds
    bare.player._holds = lambda place: holds(place) or random.random() < chance
    outcome = bare.run()
    if outcome == TIMED_OUT:
        assert bare.player.catch(5, bare.now_ms - STEP_MS)
        bare.channels.all_off(bare.now_ms - STEP_MS)
        outcome = bare.run()
    assert outcome == FINISHED
    return bare


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
@given(scripts, st.integers(0, 0xFFFF))
def test_whichever_way_a_script_goes_the_robot_stays_within_its_worst_case(body, seed):
    worst = report(body)
    assume(worst.sound and worst.longest_ms < 30_000)

    bare = run(compiled(body).code, seed)

    assert bare.too_long == -1
    assert bare.now_ms - STEP_MS <= worst.longest_ms + STEP_MS  # the table top takes a step more for an abort
    assert bare.player.failed or bare.now_ms - STEP_MS >= worst.shortest_ms
    assert bare.at_once <= worst.at_once
    for channel, row in enumerate(worst.coils):
        assert bare.on_ms[channel] <= row.on_ms
        assert bare.heat_uj[channel] <= row.heat_peak_mj * 1000


@pytest.mark.parametrize("turns", [3, 2000])
def test_a_jump_from_a_long_loop_is_as_hot_as_the_robot_then_is(turns):
    body = (
        f"repeat {turns}:\n    fire A at 20 % for 200 ms\n    {LATER.replace('1 s', '20 ms')} end\n    wait 100 ms\n"
        "label end\nfire A at 10 % for 100 ms\nfire B at 5 % for 100 ms"
    )
    worst = report(body)
    bare, left = Bare(compiled(body).code), [min(turns, 60)]

    def holds(place):
        left[0] -= 1
        return left[0] > 0

    bare.player._holds = holds
    assert bare.run() == FINISHED
    assert bare.heat_uj[0] <= worst.coils[0].heat_peak_mj * 1000
    assert bare.on_ms[0] <= worst.coils[0].on_ms


joint_waits = st.builds(
    "wait until {} > 29 deg timeout {} ms else {}".format,
    st.sampled_from(["R.angle", "any both.angle"]),
    st.integers(1, 700),
    st.sampled_from(["abort", "abort", "end", "continue"]),
)
joint_parts = st.lists(st.one_of(moves, orients, joint_waits), min_size=1, max_size=5).map("\n".join)
joint_scripts = st.builds(
    "{}\n{}\nlabel end\n{}\nwait 100 ms\non fault:\n    {}".format,
    st.just(HOME),
    joint_parts,
    joint_parts.map(lambda text: text.replace("else end", "else abort")),
    st.lists(moves, min_size=1, max_size=2).map("\n    ".join),
)


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
@given(joint_scripts, st.integers(0, 0xFFFF))
def test_whichever_way_a_script_goes_joints_stay_within_its_worst_case(body, seed):
    worst = report(body, hand_robot())
    assume(worst.sound)
    hand, random = Hand(compiled(body, profile=hand_robot()).code), Random(seed)
    chance, holds = random.choice([0, 0.01]), hand.player._holds
    hand.player._holds = lambda place: holds(place) or random.random() < chance

    if hand.run() == TIMED_OUT:
        hand.now_ms += READY_MS
        assert hand.player.catch(5, hand.now_ms)
        hand.limbs.stand()
        hand.now_ms += STEP_MS
        assert hand.run() == FINISHED

    fastest = max(joint.fastest_centi_per_s for joint in worst.joints)
    assert hand.fastest_centi_per_s <= fastest + 2 * 1000 // STEP_MS  # whole hundredths in each step
    for joint, told in zip(worst.joints, hand.told, strict=True):
        assert joint.least_centi <= min(told) + 1
        assert max(told) - 1 <= joint.most_centi
