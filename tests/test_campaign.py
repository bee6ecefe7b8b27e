"""A tenth of the fault campaign, and the campaign itself: `make campaign` runs the whole of it."""

import io
import json

import pytest
from rich.console import Console

from hil_sim.faults.table import TABLE
from tests import campaign, deaths, trials
from tests.sabotage import sabotage

EACH = 5  # a worker takes so many at a time


@pytest.mark.parametrize("first", range(0, 100, EACH))
def test_whatever_fails_whenever_no_coil_cooks_and_the_robot_comes_back(first):
    rows = [trials.row_of(number) for number in range(first, first + EACH)]

    assert [row for row in rows if row["wrong"]] == []


@pytest.mark.parametrize("first", range(0, 100, EACH))
def test_a_host_killed_at_any_instant_leaves_no_coil_on_beyond_the_lease(first):
    rows = [deaths.row_of(number) for number in range(first, first + EACH)]

    assert [row for row in rows if row["wrong"]] == []
    assert any(row["on"] for row in rows)


def test_a_trial_is_the_same_whenever_it_is_run():
    assert trials.row_of(2) == trials.row_of(2)


def test_every_fault_comes_up_in_the_campaign():
    drawn = {trials.trial_of(number).fault.partition(":")[0] for number in range(1000)}

    assert drawn == {fault.name for fault in TABLE}


def test_firmware_without_a_lease_is_found_by_killing_its_host(monkeypatch):
    lease_left = "def lease_left_ms(self) -> int:"
    sabotage(monkeypatch, "core.py", lease_left, lease_left + " return self.lease_ms\n    def _(self):")

    told = [text for number in range(10) for text in deaths.row_of(number)["wrong"]]

    assert any("beyond the lease" in text for text in told)


@pytest.fixture
def results(tmp_path):
    """Return a file with two results of this tree and a torn third."""
    rows = [
        {"kind": "trial", "number": n, "fault": "hang", "wrong": wrong, "told": "tripped 112", "off_ms": 50.0 + n}
        for n, wrong in enumerate(([], ["coil A was on for ever"]))
    ]
    path = tmp_path / "campaign.jsonl"
    lines = [json.dumps({"tree": campaign.tree_sha256()}), *map(json.dumps, rows)]
    path.write_text("\n".join(lines) + '\n{"kind": "tri')
    return path


def test_an_interrupted_campaign_goes_on_where_it_was(results):
    assert set(campaign.kept(results)) == {("trial", 0), ("trial", 1)}
    assert results.read_text().endswith("}\n")


def test_results_of_another_tree_are_dropped(results, monkeypatch):
    monkeypatch.setattr(campaign, "tree_sha256", lambda: "another")

    assert campaign.kept(results) == {}
    assert results.read_text() == '{"tree": "another"}\n'


def test_a_violation_is_told_with_the_command_that_shows_it_again(results):
    page = io.StringIO()

    status = campaign.told(list(campaign.kept(results).values()), Console(file=page, width=120))

    assert status == 1
    assert "hang: coil A was on for ever\n    python -m tests.campaign --only trial:1\n" in page.getvalue()
    assert "2 runs, 1 with a violation" in page.getvalue()


def test_a_campaign_runs_what_is_missing_and_no_more(results, monkeypatch):
    monkeypatch.setattr(
        campaign, "KINDS", {"trial": lambda n: {"fault": "reset", "wrong": [], "told": "", "off_ms": None}}
    )

    status = campaign.main(["--trials", "4", "--deaths", "0", "--jobs", "1", "--out", str(results)])

    done = campaign.kept(results)
    assert status == 1
    assert {number: row["fault"] for (_, number), row in done.items()} == {0: "hang", 1: "hang", 2: "reset", 3: "reset"}
