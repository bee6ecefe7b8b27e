"""The page about form, JSON and Python: each of its examples is run."""

import doctest
import json
import re

from host.gait.forms.formatting import formatted, made
from host.gait.forms.treejson import reads
from tests.gait_scripts import ROOT
from tests.test_gait_json import VALIDATOR, tree

PAGE = ROOT / "docs" / "gait-tools.md"
BLOCKS = re.findall(r"```(\w*)\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
TEXTS = [text for kind, text in BLOCKS if not kind and "softrig" not in text]


def test_the_example_of_the_form_gets_the_form_that_is_shown():
    before, after, _ = TEXTS

    assert formatted(before, "page") == after


def test_the_example_in_json_is_the_tree_of_the_example_beside_it():
    (value,) = [json.loads(text) for kind, text in BLOCKS if kind == "json"]

    VALIDATOR.validate(value)
    assert tree(TEXTS[2]) == value
    assert made(reads(json.dumps(value))) == TEXTS[2]


def test_the_examples_in_python_run_as_they_stand():
    failed, tried = doctest.testfile(str(PAGE), module_relative=False)

    assert (failed, tried >= 8) == (0, True)
