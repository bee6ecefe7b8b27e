"""The fuzzer's corpus, replayed: what was once found stays mended. Needs no fuzzer; `make fuzz` looks for more."""

import pytest

from firmware.core import Core
from firmware.load import Load
from firmware.orient import Orient
from firmware.press import Press
from protocol import messages
from tests.fuzz_robot import BOTH, FINGER, PUSHER, ROUND, played
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
    ("kind", "seed", "reached"),
    [
        (ROUND, "core/fired", (messages.ARMED, True)),
        (ROUND, "core/played", (messages.RUNNING, True)),
        (ROUND, "core/at-sync", (messages.RUNNING, True)),
        (ROUND, "core/stopped", (messages.TRIPPED, False)),
        (ROUND, "core/keyed", (messages.IDLE, False)),
        (FINGER, "hand/gripped", (messages.ARMED, True)),
        (FINGER, "hand/strained", (messages.TRIPPED, False)),
        (FINGER, "hand/played", (messages.RUNNING, True)),
        (BOTH, "hand/mixed-gripped", (messages.ARMED, True)),
        (BOTH, "hand/mixed-played", (messages.RUNNING, True)),
        (PUSHER, "press/pressed", (messages.ARMED, True)),
        (PUSHER, "press/overloaded", (messages.TRIPPED, False)),
        (PUSHER, "press/torn", (messages.TRIPPED, False)),
        (PUSHER, "press/played", (messages.RUNNING, True)),
        (PUSHER, "press/guarded", (messages.TRIPPED, False)),
    ],
)
def test_the_seeds_reach_what_they_are_meant_for(kind, seed, reached):
    """A seed that is refused at the door teaches the fuzzer nothing."""
    assert reached in played((CORPUS / seed).read_bytes(), kind).reached


@pytest.mark.parametrize(("seed", "event"), [("turned", ""), ("blind", "lost")])
def test_the_loop_runs_in_the_seeds_that_are_meant_for_it(seed, event, monkeypatch):
    turns, seen = [], []
    monkeypatch.setattr(Orient, "_integrate", lambda self, now_ms: turns.append(now_ms))
    monkeypatch.setattr(Core, "_lose_object", lambda self: seen.append("lost"))

    played((CORPUS / "hand" / seed).read_bytes(), FINGER)

    assert len(turns) > 3
    assert seen == ([event] if event else [])


@pytest.mark.parametrize("seed", ["pressed", "played", "raised"])
def test_the_loop_of_a_press_runs_in_the_seeds_that_are_meant_for_it(seed, monkeypatch):
    forces = []
    monkeypatch.setattr(Press, "_rate", lambda self, wanted_mn, passed_ms: forces.append(wanted_mn) or 0)

    played((CORPUS / "press" / seed).read_bytes(), PUSHER)

    assert len(forces) > 100
    assert max(forces) >= 2000


def test_a_press_that_does_not_trip_is_found(monkeypatch):
    monkeypatch.setattr(Load, "check", lambda self: 0)

    with pytest.raises(AssertionError):
        played((CORPUS / "press/overloaded").read_bytes(), PUSHER)
