"""`softrig check` on several scripts at once: for a reader, as JSON, as GitHub's workflow commands."""

import json

import pytest

from tests.fake_robot import FakeLine, FakeRobot, plug_in

HEAD = "gait 1\nrobot circular\n"
GOOD = HEAD + "fire A at 20 % for 400 ms\n"
HOT = HEAD + "fire A at 100 % for 9 s\n"
WRONG = HEAD + "fire Q at 200 % for 11 s\nwait until A.temperature > 40 C timeout 3 s else recvoer\nlabel recover\n"


@pytest.fixture
def check(softrig, monkeypatch, tmp_path):
    """Write scripts and check them against one robot."""
    peer = FakeRobot()
    plug_in(FakeLine(peer), monkeypatch)
    monkeypatch.chdir(tmp_path)

    def call(texts, *options):
        names = [f"{number}.gait" for number in range(len(texts))]
        for name, text in zip(names, texts, strict=True):
            (tmp_path / name).write_text(text)
        told = softrig("check", *names, *options)
        told.peer = peer
        return told

    return call


def test_every_script_is_told_and_the_status_is_that_of_the_worst(check):
    told = check([GOOD, HOT, WRONG, GOOD])

    assert told.status == 2
    assert told.out.count("keeps the limits of circular") == 2
    assert "1.gait:3:1: error E306" in told.err
    assert "2.gait:3:6: error E131" in told.err


@pytest.mark.parametrize(("texts", "status"), [([GOOD], 0), ([GOOD, HOT], 4), ([HOT, WRONG], 2), ([WRONG], 2)])
def test_a_limit_exits_with_4_and_a_mistake_anywhere_with_2(check, texts, status):
    assert check(texts, "--json").status == status


def test_json_is_one_object_a_script_also_when_it_is_refused(check):
    told = check([GOOD, HOT, WRONG], "--format", "json")

    rows = [json.loads(line) for line in told.out.splitlines()]
    assert [(row["script"], row["sound"]) for row in rows] == [("0.gait", True), ("1.gait", False), ("2.gait", False)]
    assert [item["code"] for item in rows[2]["diagnostics"]] == ["E131", "E125", "E302", "E172"]
    assert rows[1]["exit_code"] == 4


def test_github_is_told_file_line_column_and_code_of_each_mistake(check):
    told = check([WRONG], "--format", "github")

    assert told.out.splitlines()[-1] == (
        "::error file=0.gait,line=4,col=50,endColumn=57,title=E172::there is no label `recvoer`; "
        "did you mean `recover`?"
    )
    assert told.out.count("::error ") == 4
    assert "200 %25 is outside" in told.out


def test_a_file_that_is_not_there_does_not_keep_others_from_being_checked(check, softrig):
    check([GOOD])

    told = softrig("check", "absent:.gait", "0.gait", "--format", "github")

    assert told.status == 2
    assert told.out.startswith("::error file=absent%3A.gait,line=1,col=1,endColumn=2,title=E115::")
    assert "keeps the limits" in told.out


def test_each_robot_is_asked_once(check):
    told = check([GOOD, GOOD, GOOD])

    assert [name for _, name, _ in told.peer.orders].count("hello") == 1
