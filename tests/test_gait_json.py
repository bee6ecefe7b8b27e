"""The tree of a script as JSON: written, read back, held against the published schema, and refused with a path."""

import copy
import json

import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from host.cli import main
from host.gait.forms.formatting import made
from host.gait.forms.jsonkinds import TreeError
from host.gait.forms.layout import layout, same
from host.gait.forms.treejson import as_json, read, reads, schema
from host.gait.reading.parser import parse_file
from tests.gait_scripts import ROOT
from tests.gait_strategy import examples
from tests.test_gait_fmt import FAIR, GAITS, HEADS, ONE_LINERS

PUBLISHED = json.loads((ROOT / "docs" / "gait.schema.json").read_text(encoding="utf-8"))
VALIDATOR = Draft202012Validator(PUBLISHED)
FIRE = {
    "statement": "fire",
    "coils": ["A", {"reference": "c"}],
    "clauses": [{"word": "at", "value": {"number": "60", "unit": "%"}}],
    "before": ["# Heat.", ""],
    "comment": "# now",
}
ASKED = {"subjects": ["A"], "quantity": "temperature", "compare": ">", "value": {"number": "95", "unit": "C"}}
WHOLE = "\n".join(
    [*ONE_LINERS, *(f"{head}  # head\n    # inside\n    wait 1 s\n    # after" for head in HEADS), "# end\n"]
)
WRONG = [
    ({}, "version: is missing"),
    ([], "the file: [] is no object"),
    ({"version": 2, "statements": []}, "version: 2 is unknown: this softrig reads version 1"),
    ({"version": 1, "statement": []}, "statement: unknown key; known are $schema, version, statements, after"),
    ({"version": 1, "statements": {}}, "statements: {} is no list"),
    ({"version": 1, "statements": [], "after": ["x"]}, 'after[0]: "x" is not a comment like `# text`, or empty'),
    ([{}], "statements[0].statement: is missing"),
    ([{"statement": "fier"}], 'statements[0].statement: "fier" is no statement; did you mean `fire`?'),
    ([{"statement": "fire"}], "statements[0].coils: is missing"),
    ([{**FIRE, "coil": []}], "statements[0].coil: unknown key; did you mean `coils`?"),
    ([{**FIRE, "coils": ["at"]}], 'statements[0].coils[0]: "at" is not a name'),
    ([{**FIRE, "coils": ["A\n"]}], 'statements[0].coils[0]: "A\\n" is not a name'),
    ([{**FIRE, "coils": [3]}], "statements[0].coils[0]: 3 is no object"),
    ([{**FIRE, "comment": "# \ud800"}], 'statements[0].comment: "# \\ud800" is not a comment like `# text`'),
    (
        [{**FIRE, "clauses": [{"word": "att", "value": {"number": "6"}}]}],
        'statements[0].clauses[0].word: "att" is none of at, for, until, overlap, ramp; did you mean `at`?',
    ),
    (
        [{"statement": "wait", "time": {"number": 0.5, "unit": "s"}}],
        'statements[0].time.number: 0.5 is no text: a number like "0.5" is wanted',
    ),
    (
        [{"statement": "wait", "time": {"unit": "s"}}],
        "statements[0].time: one of the keys number, reference, negative, operator is missing",
    ),
    ([{"statement": "repeat", "body": []}], "statements[0].body: the list is empty"),
    (
        [{"statement": "together", "body": [{"statement": "note", "text": 'a"b'}]}],
        'statements[0].body[0].text: "a\\"b" is not a text for one line without quotation marks',
    ),
    (
        [{"statement": "guard", "condition": {**ASKED, "subjects": ["A", "B"]}}],
        "statements[0].condition.quantifier: is missing: any or all of these?",
    ),
    (
        [{"statement": "param", "name": "a", "value": {"number": "1"}, "low": {"number": "0"}}],
        "statements[0].high: is missing",
    ),
]


def tree(text):
    file, found = parse_file(text, "x.gait")
    assert not found
    return as_json(layout(file))


def gait(*arguments, text=None):
    return CliRunner().invoke(main, ["gait", *map(str, arguments)], input=text)


def accepted(value):
    try:
        return read(value) is not None
    except TreeError:
        return False


@pytest.mark.parametrize("path", GAITS, ids=lambda path: path.stem)
def test_every_gait_is_the_same_after_a_journey_through_json(path):
    text = path.read_text(encoding="utf-8")

    value = json.loads(json.dumps(tree(text)))

    VALIDATOR.validate(value)
    assert same(layout(parse_file(text, "x.gait")[0]), read(value))


def test_every_statement_is_the_same_after_a_journey_through_json():
    value = tree(WHOLE)

    VALIDATOR.validate(value)
    assert made(read(value)) == made(layout(parse_file(WHOLE, "x.gait")[0]))
    assert {row["statement"] for row in value["statements"]} | {"gait", "robot"} == set(statements_of(PUBLISHED))


def statements_of(schema):
    return [
        kind["properties"]["statement"]["const"]
        for kind in schema["$defs"].values()
        if "statement" in kind.get("properties", {})
    ]


def test_a_statement_reads_in_json_as_in_the_text():
    assert tree("# Heat.\n\nfire A $c at 60 %  # now")["statements"] == [FIRE]


def test_numbers_stay_exact():
    value = tree("wait 0.1000000000000000000000000000001 s")

    assert value["statements"][0]["time"]["number"] == "0.1000000000000000000000000000001"
    assert made(read(value)) == "wait 0.1000000000000000000000000000001 s\n"


def test_blank_lines_that_no_form_has_are_dropped():
    block = {
        "statement": "repeat",
        "body": [{"statement": "wait", "before": ["", "# a"]}],
        "after": ["", "", "# b", ""],
    }

    text = made(read({"version": 1, "statements": [block, {"statement": "wait", "before": [""]}], "after": [""]}))

    assert text == "repeat:\n    # a\n    wait\n\n    # b\n\nwait\n"


def test_the_published_schema_is_that_of_the_reader_and_sound():
    Draft202012Validator.check_schema(PUBLISHED)

    assert schema() == PUBLISHED


@pytest.mark.parametrize(("value", "told"), WRONG, ids=[told.split(":")[0] for _, told in WRONG])
def test_what_is_wrong_is_told_with_its_path_and_refused_by_the_schema_too(value, told):
    whole = {"version": 1, "statements": value} if isinstance(value, list) and value else value

    with pytest.raises(TreeError) as caught:
        read(whole)

    assert str(caught.value) == told
    assert not VALIDATOR.is_valid(whole) or "\\ud800" in told


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('{"version": 1,', "the file: line 1, column 15: Expecting property name enclosed in double quotes"),
        ("[" * 100_000, "the file: it is nested too deeply"),
        ('{"version": 1, "version": 1}', 'the file: the key "version" is given twice in one object'),
        ("1" * 5000, "the file: Exceeds the limit (4300 digits) for integer string conversion: value has 5000 digits"),
    ],
    ids=["cut off", "too deep", "twice", "too long"],
)
def test_a_text_that_is_no_json_is_told_in_one_line(text, told):
    with pytest.raises(TreeError) as caught:
        reads(text)

    assert str(caught.value) == told


def paths(value, path=()):
    yield path
    pairs = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in pairs:
        yield from paths(each, (*path, key))


SOUND = [{"version": 1, "statements": [row]} for row in tree(WHOLE)["statements"]]
PLACES = [(value, path) for value in SOUND for path in paths(value)]
JUNK = st.sampled_from(
    [None, True, 1, 0.5, "", "A", "at", "$c", "60", "-1", "% ", "# x", "#\n", [], [[]], ["A"], {}, {"number": "1"},
     {"reference": "c"}, {"coils": ["A", "B"]},
     [{"coils": ["A"]}], ["A", {"reference": "c"}], [{"reference": "c"}, "A"],
     {"first": {"number": "1"}, "last": {"number": "2"}}, FIRE, ASKED]
)  # fmt: skip


@settings(max_examples=examples(250))
@given(st.sampled_from(PLACES), JUNK, st.sampled_from(["put", "drop", "add"]))
def test_reader_and_schema_take_and_refuse_the_same_and_all_that_is_taken_can_be_written(place, junk, how):
    sound, path = place
    value = {"": copy.deepcopy(sound)}
    holder, key = value, ""
    for step in path:
        holder, key = holder[key], step
    if how == "drop":
        del holder[key]
    elif how == "put" or not isinstance(holder[key], dict):
        holder[key] = junk
    else:
        holder[key]["coils"] = junk

    changed = value.get("")

    assert accepted(changed) == VALIDATOR.is_valid(changed)
    if accepted(changed):
        assert same(read(changed), layout(parse_file(made(read(changed)), "x.gait")[0]))


def test_export_and_import_are_each_other_on_the_command_line(tmp_path):
    script, file = tmp_path / "a.gait", tmp_path / "a.json"
    script.write_text(FAIR)

    assert gait("export", script, "-o", file).exit_code == 0
    assert gait("import", file).output == FAIR
    assert json.loads(gait("export", "-", "--json", text=FAIR).output) == json.loads(file.read_text())
    assert json.loads(gait("import", file, "--json").output) == {"script": None, "text": FAIR}
    assert json.loads(gait("schema").output) == PUBLISHED


def test_import_says_what_is_wrong_with_file_and_path_and_writes_nothing(tmp_path):
    file, script = tmp_path / "a.json", tmp_path / "a.gait"
    file.write_text('{"version": 1, "statements": [{"statement": "wait", "time": {"number": "x"}}]}')

    done = gait("import", file, "-o", script)

    assert (done.exit_code, script.exists()) == (2, False)
    assert done.output == f'softrig: {file}: statements[0].time.number: "x" is not a number like "0.5"\n'


def test_export_of_a_script_that_cannot_be_read_tells_where():
    done = gait("export", "-", text="wait 1 s\nfire A sometimes 5 %\n")

    assert (done.exit_code, "-:2:18: error E101" in done.output) == (2, True)


def test_a_tree_too_deep_for_a_script_is_refused():
    value = {"statement": "wait"}
    for _ in range(40):
        value = {"statement": "together", "body": [value]}

    done = gait("import", "-", text=json.dumps({"version": 1, "statements": [value]}))

    assert (done.exit_code, "E114: as it would be written: blocks are nested too deeply" in done.output) == (2, True)
