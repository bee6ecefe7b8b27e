"""Random scripts: the valid ones compile to what the robot accepts, the rest are refused with their reasons."""

from hypothesis import given, settings
from hypothesis import strategies as st

from host.gait.checker import check
from host.gait.compiler import compile_script
from host.gait.diagnostics import GaitError
from host.gait.plan import Move, Press, Wait, walk
from host.gait.reading.parser import parse_file
from host.gait.reading.syntax import KEYWORDS
from host.gait.script import loads
from protocol import program
from protocol.program import HEADER_BYTES, disassemble, read_header
from protocol.verify import check_code
from tests.gait_scripts import HEAD, hand_robot, press_robot, round_robot
from tests.joint_scripts import bodies as joint_bodies
from tests.press_scripts import bodies as press_bodies

LIMITS = settings(max_examples=150, deadline=None)

coils = st.lists(st.sampled_from("ABCDEFGH"), min_size=1, max_size=4, unique=True).map(" ".join)
duties = st.integers(1, 1000).map(lambda permille: f"{permille / 10} %")
times = st.one_of(
    st.integers(6, 4000).map(lambda ms: f"{ms} ms"),
    st.integers(1, 40).map(lambda tenths: f"{tenths / 10} s"),
    st.integers(10, 400).map(lambda ms: f"2 * ({ms} ms + {ms} ms)"),
)
fires = st.builds("fire {} at {} for {}".format, coils, duties, times)
clauses = st.sampled_from(["", " until 95 C", " ramp 5 ms", " overlap 5 ms", " overlap 1 ms until 80.5 C ramp 3 ms"])
conditions = st.builds(
    "{}{}.temperature {} {} C".format,
    st.sampled_from(["any ", "all "]),
    st.sampled_from(["front", "even", "all", "A"]),
    st.sampled_from("<>"),
    st.integers(20, 110),
)
others = st.sampled_from(["supply.current > 300 mA", "supply.voltage < 1.8 * 1000 mV", "board.temperature > 40 C"])
waits = st.builds(
    "wait until {} timeout {} else {}".format, conditions | others, times, st.sampled_from(["abort", "continue"])
)
static = st.one_of(st.builds("{}{}".format, fires, clauses), times.map("wait {}".format))


def indented(lines):
    return "\n".join("    " + line for line in "\n".join(lines).split("\n"))


def blocks(inner):
    bodies = st.lists(inner, min_size=1, max_size=3).map(indented)
    return st.builds("repeat {}:\n{}".format, st.integers(1, 5), bodies)


statements = st.recursive(st.one_of(static, waits), blocks, max_leaves=8)
scripts = st.lists(statements, min_size=1, max_size=8).map(lambda lines: HEAD + "\n".join(lines) + "\n")
pieces = st.sampled_from(
    [*KEYWORDS, "\n", "\n    ", "\n  ", ":", " ", "A", "$c", "(", ")", ",", "60", "%", "ms", "C", "0.5", "[", "]", "..",
     "=", "#", '"', "<", ">", ".", "temperature", "any", "all", "-", "*", "/", "\t", "\r\n", "é", "\x00", "\x01",
     "R", "deg", "angle", "orientation", "P", "C1", "N", "kPa", "mm", "force", "pressure", "depth"]
)  # fmt: skip


@LIMITS
@given(scripts)
def test_a_random_valid_script_compiles_to_what_the_robot_accepts(text):
    made = compile_script(loads(text), round_robot())

    check_code(made.code, 8, 1 << 20)
    assert read_header(made.program[:HEADER_BYTES]).length == len(made.code)


@LIMITS
@given(scripts)
def test_the_worst_case_of_a_random_script_is_consistent(text):
    made = check(compile_script(loads(text), round_robot()))

    assert made.shortest_ms <= made.longest_ms
    for coil in made.coils:
        assert coil.on_ms <= made.longest_ms + 4 * coil.orders  # each order ends on a control step
        assert coil.energy_mj * 1000 <= 380 * coil.on_ms + 1000
        assert coil.heat_peak_mj <= coil.energy_mj + 2
    assert made.at_once <= sum(coil.orders > 0 for coil in made.coils)


@LIMITS
@given(joint_bodies)
def test_a_random_script_of_moves_compiles_to_what_the_robot_accepts(body):
    made = compile_script(loads(HEAD + body), hand_robot())

    check_code(made.code, 0, 1 << 20, joints=2)


@LIMITS
@given(joint_bodies)
def test_the_worst_case_of_a_random_script_of_moves_is_consistent(body):
    made = check(compile_script(loads(HEAD + body), hand_robot()))

    assert 1000 <= made.shortest_ms <= made.longest_ms
    for joint in made.joints:
        assert joint.least_centi <= 0 <= joint.most_centi
        assert joint.held_ms <= made.longest_ms - 1000 + 5
        assert joint.fastest_centi_per_s >= 3000
    assert made.coils == ()


@LIMITS
@given(press_bodies)
def test_a_random_script_that_presses_says_in_its_program_what_its_plan_says(body):
    made = compile_script(loads(HEAD + body), press_robot())

    check_code(made.code, 0, 1 << 20, joints=1, cells=6)
    rows = [row[1:] for row in disassemble(made.code)]
    assert b"".join(assembled(*row) for row in rows) == made.code
    presses = [(op.target_mn, op.over_ms, op.time_ms) for op in walk(made.plan) if isinstance(op, Press)]
    assert [row[1:] for row in rows if row[0] == "press"] == presses
    moves = [(op.mask, op.target_centi, op.time_ms) for op in walk(made.plan) if isinstance(op, Move)]
    assert [row[1:] for row in rows if row[0] == "move"] == moves
    waits = [(op.condition, op.timeout_ms, op.otherwise) for op in walk(made.plan) if isinstance(op, Wait)]
    assert [row[1:] for row in rows if row[0] == "wait"] == waits


@LIMITS
@given(press_bodies)
def test_the_worst_case_of_a_random_script_that_presses_is_consistent(body):
    made = check(compile_script(loads(HEAD + body), press_robot()))

    assert 1500 <= made.shortest_ms <= made.longest_ms
    (axis,) = made.joints
    assert axis.least_centi <= -200 <= axis.most_centi
    assert 1500 <= axis.driven_ms <= made.longest_ms
    assert axis.held_ms <= made.longest_ms - 1500 + 5
    assert (made.force_mn > 0) <= ("press to" in body)


@LIMITS
@given(st.text(max_size=300) | st.lists(pieces, max_size=60).map("".join))
def test_random_text_is_read_or_refused_and_nothing_else(text):
    for source in (text, HEAD + text):
        for profile in (round_robot(), hand_robot(), press_robot()):
            refusal = refused(source, profile)

            assert refusal is None or all(item.message for item in refusal.diagnostics)


@LIMITS
@given(st.lists(pieces, max_size=60).map("".join))
def test_a_mistake_always_lies_within_the_text(text):
    file, found = parse_file(text, "x.gait")

    for item in found:
        assert 1 <= item.place.line <= len(file.lines)
        assert 1 <= item.place.column <= len(file.line(item.place.line)) + 1


@LIMITS
@given(scripts | joint_bodies.map(HEAD.__add__) | press_bodies.map(HEAD.__add__), st.data())
def test_a_script_with_a_hole_in_it_is_read_or_refused_and_nothing_else(text, data):
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(start + 20, len(text))))

    profile = press_robot() if "move P" in text else hand_robot() if "move" in text else round_robot()
    refusal = refused(text[:start] + text[end:], profile)

    assert refusal is None or refusal.exit_code in (2, 4)


def assembled(name, *arguments):
    """Return the bytes of an op as `disassemble` names it."""
    return getattr(program, "next_" if name == "next" else name)(*arguments)


def refused(text, profile):
    """Return the reasons why a script is refused, or None; anything else that it raises passes through."""
    try:
        check(compile_script(loads(text), profile))
    except GaitError as error:
        return error
    return None
