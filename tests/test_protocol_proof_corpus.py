"""The fuzzer's corpus, replayed: what was once found stays mended. Needs no fuzzer; `make fuzz` looks for more."""

import pytest

from protocol import messages
from tests.fuzz_robot import played
from tests.fuzz_seeds import CORPUS, files
from tests.fuzz_targets import TARGETS


@pytest.mark.parametrize("name", TARGETS)
def test_every_input_of_the_corpus_passes(name):
    inputs = sorted((CORPUS / name).iterdir())

    for path in inputs:
        try:
            TARGETS[name](path.read_bytes())
        except Exception as error:
            raise AssertionError(f"{path}: {error!r}") from error

    assert len(inputs) > 3


def test_the_seeds_of_the_corpus_are_those_that_their_file_makes():
    assert all(path.read_bytes() == data for path, data in files())


@pytest.mark.parametrize(
    ("seed", "reached"),
    [
        ("fired", (messages.ARMED, True)),
        ("played", (messages.RUNNING, True)),
        ("at-sync", (messages.RUNNING, True)),
        ("stopped", (messages.TRIPPED, False)),
        ("keyed", (messages.IDLE, False)),
    ],
)
def test_the_seeds_reach_what_they_are_meant_for(seed, reached):
    """A seed that is refused at the door teaches the fuzzer nothing."""
    assert reached in played((CORPUS / "core" / seed).read_bytes()).reached
