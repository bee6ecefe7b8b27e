"""Random valid scripts of every robot: their text, tree, JSON and code are turned into each other without loss."""

import json
from typing import get_args

from hypothesis import given, settings
from hypothesis import strategies as st

from host.gait import tree
from host.gait.compiler import compile_script
from host.gait.forms.formatting import formatted, made
from host.gait.forms.layout import layout, same
from host.gait.forms.treejson import as_json, reads
from host.gait.reading.parser import parse_file
from host.gait.script import loads, walk
from protocol.program import disassemble
from protocol.verify import check_code
from tests.gait_scripts import profile_of
from tests.gait_strategy import examples, robots, scripts, scruffy
from tests.test_gait_random import assembled

sound = robots.flatmap(lambda profile: st.tuples(st.just(profile), scripts(profile)))
hurried = robots.flatmap(scripts).flatmap(lambda text: st.tuples(st.just(text), scruffy(text)))


def sheet(text):
    file, found = parse_file(text, "x.gait")
    assert not found, (text, str(found[0]))
    return layout(file)


@settings(max_examples=examples(25))
@given(hurried)
def test_a_script_written_in_a_hurry_gets_one_form_and_keeps_its_comments(pair):
    text, hurry = pair

    once = formatted(hurry, "x.gait")

    assert formatted(once, "x.gait") == once
    assert same(sheet(once), sheet(hurry))
    assert comments(once) == comments(hurry)
    assert same(parse_file(once, "x.gait")[0].statements, parse_file(text, "x.gait")[0].statements)


def comments(text):
    return [comment.text.rstrip() for comment in parse_file(text, "x.gait")[0].comments]


@settings(max_examples=examples(25))
@given(hurried)
def test_a_script_is_the_same_after_a_journey_through_json(pair):
    text = formatted(pair[1], "x.gait")

    value = json.dumps(as_json(sheet(text)))

    assert made(reads(value)) == text


@settings(max_examples=examples(40))
@given(sound)
def test_a_program_is_the_same_after_it_was_taken_apart(pair):
    profile, text = pair
    code = compile_script(loads(text), profile).code

    rows = disassemble(code)

    assert b"".join(assembled(*row[1:]) for row in rows) == code
    check_code(code, len(profile.coil_labels), 1 << 20, len(profile.joint_labels), len(profile.cells))


@settings(max_examples=examples(20))
@given(sound, st.data())
def test_a_script_in_its_form_makes_the_program_that_it_made_before(pair, data):
    profile, text = pair

    hurry = data.draw(scruffy(text))

    before, after = (compile_script(loads(each), profile).code for each in (hurry, formatted(hurry, "x.gait")))
    assert before == after


def test_the_random_scripts_use_every_statement_of_the_language():
    seen = set()
    some = st.sampled_from(["sphere-a", "sphere-a", "fingers", "press"]).map(profile_of)

    @settings(max_examples=examples(60))
    @given(some.flatmap(scripts))
    def look(text):
        seen.update(type(node) for node in walk(parse_file(text, "x.gait")[0].statements))

    look()
    assert set(get_args(tree.Statement)) - seen == {tree.Include, tree.Broken}
