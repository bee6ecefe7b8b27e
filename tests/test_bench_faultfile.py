"""Fault files: what they plan, what they draw, and how mistakes in them are told."""

import json

import pytest

from hil_sim.address import parse
from hil_sim.assembly import assemble
from hil_sim.faults.file import FaultFileError, load
from host.cli import main
from tests.fault_table import EXAMPLE

TWO = """seed = 7

[[fault]]
name = "line-flip:5"
at_ms = [1000, 5000]
for_ms = [10, 20]

[[fault]]  # the second
name = "coil-open:A"
at_ms = 2000.5
"""


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "x.toml"
        path.write_text(text)
        return path

    return write


def test_times_are_read_and_drawn_within_their_range(written):
    flip, broken = load(written(TWO))

    assert 1_000_000 <= flip.at_us <= 5_000_000
    assert 10_000 <= flip.for_us <= 20_000
    assert (broken.name, broken.at_us, broken.for_us) == ("coil-open:A", 2_000_500, None)


def test_the_seed_decides_what_is_drawn_and_nothing_else_does(written):
    first, again = load(written(TWO)), load(written(TWO))
    other = load(written(TWO.replace("seed = 7", "seed = 8")))

    assert first == again
    assert first[0].at_us != other[0].at_us


def test_a_fault_more_at_the_end_changes_none_before_it(written):
    longer = load(written(TWO + '\n[[fault]]\nname = "hang"\nat_ms = [1, 9000]\n'))

    assert longer[:2] == load(written(TWO))


def test_the_example_of_the_page_is_a_fault_file(written):
    assert [one.name for one in load(written(EXAMPLE))] == ["coil-open:A", "line-lose:20"]


def test_a_file_without_faults_plans_nothing(written):
    assert load(written("")) == []


MISTAKES = [
    ("sed = 1\n", "x.toml:1: unknown key sed: known are seed, fault; did you mean seed?"),
    ("seed = -1\n", "x.toml:1: seed is -1, it must be a whole number up to 4294967295"),
    ('seed = "1"\n', "x.toml:1: seed is '1', it must be a whole number"),
    ("fault = 3\n", "x.toml:1: fault: write each under [[fault]]"),
    ('[[fault]]\nname = "hang"\n', "x.toml:1: a fault lacks at_ms: write at_ms = 1000, or a range"),
    ("[[fault]]\nat_ms = 1\n", 'x.toml:1: a fault lacks its name: write name = "coil-open:A"'),
    ('[[fault]]\nname = "hung"\nat_ms = 1\n', "x.toml:2: no fault 'hung': known are "),
    ('[[fault]]\nname = "hang"\nat_ms = -1\n', "x.toml:3: at_ms is -1, it must be a time or two, up to 86400000 ms"),
    ('[[fault]]\nname = "hang"\nat_ms = true\n', "x.toml:3: at_ms is True"),
    ('[[fault]]\nname = "hang"\nat_ms = nan\n', "x.toml:3: at_ms is nan"),
    ('[[fault]]\nname = "hang"\nat_ms = [1, 2, 3]\n', "x.toml:3: at_ms is [1, 2, 3]"),
    ('[[fault]]\nname = "hang"\nat_ms = [5, 2]\n', "x.toml:3: at_ms is [5, 2]: the earlier time comes first"),
    ('[[fault]]\nname = "hang"\nat_ms = 1\nfor_ms = 5\n', "x.toml:4: for_ms: fault hang does not last"),
    ('[[fault]]\nname = "hang"\nat_ms = 1\nuntil = 5\n', "x.toml:4: unknown key until: known are name, at_ms, for_ms"),
    ("[[fault]]\nname = \n", "x.toml: not TOML: "),
    ('[[fault]]\nname = "hang"\nat_ms = 1\n[fault2]\n', "x.toml:4: unknown key fault2"),
]


@pytest.mark.parametrize(("text", "told"), MISTAKES)
def test_a_mistake_is_told_with_its_line_and_what_is_allowed(written, text, told):
    with pytest.raises(FaultFileError) as refused:
        load(written(text))

    assert told in str(refused.value)


def test_all_mistakes_are_told_at_once(written):
    with pytest.raises(FaultFileError) as refused:
        load(written('seed = 1.5\n[[fault]]\nnam = "hang"\nat_ms = "now"\n'))

    assert [line.rpartition("x.toml:")[2][0] for line in str(refused.value).splitlines()] == ["1", "3", "4", "2"]


def test_a_coil_that_the_robot_has_not_is_told_with_its_line(written):
    path = written('[[fault]]\nname = "coil-open:Z9"\nat_ms = 5\n')

    with pytest.raises(FaultFileError, match=r"x.toml:2: fault coil-open:Z9: name a coil of this robot"):
        assemble(parse(f"sim:circular?faults={path}"))


def test_an_address_plans_the_faults_of_its_file(written):
    path = written('[[fault]]\nname = "cable-cut"\nat_ms = 100\nfor_ms = 50\n')
    bench = assemble(parse(f"sim:circular?body=still&faults={path}"))

    bench.run(0.12)
    assert not bench.board.uart.connected
    bench.run(0.1)

    assert bench.board.uart.connected
    bench.close()


def test_a_run_with_a_fault_file_says_what_happened_and_is_the_same_each_time(written, tmp_path, capsys):
    """The whole path: address, bench, firmware, host, exit status; the second time, too."""
    faults = written('seed = 2\n[[fault]]\nname = "i2c-stuck"\nat_ms = [600, 700]\n')
    (tmp_path / "a.gait").write_text("gait 1\nrobot circular\nfire A at 50 % for 2 s\n")
    told = []
    for _ in range(2):
        with pytest.raises(SystemExit) as ended:
            main(["run", str(tmp_path / "a.gait"), "--robot", f"sim:circular?faults={faults}", "--json"])
        told.append(json.loads(capsys.readouterr().out.splitlines()[0]))
        assert ended.value.code == 6

    assert told[0]["faults"][0]["code"] == "F08"
    assert [fields.pop("wall") is not None for fields in told] == [True, True]
    assert told[0] == told[1]


def test_a_fault_stands_in_the_journal_of_every_run_that_had_it(written):
    path = written('[[fault]]\nname = "cable-cut"\nat_ms = 100\n')
    hashes = set()
    for faults in ("", f"&faults={path}"):
        bench = assemble(parse(f"sim:circular?body=still{faults}"))
        bench.run(0.2)
        hashes.add(bench.trace_sha256())
        bench.close()

    assert len(hashes) == 2
