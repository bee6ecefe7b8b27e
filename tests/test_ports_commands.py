"""The bench's commands: what they print and how they refuse."""

import json

import pytest
from click.testing import CliRunner

from hil_sim.command import robots, sim
from host.cli import main

AS_ONE = main.context_settings  # a command keeps the help option that it had first


def test_robots_lists_the_address_of_each():
    result = CliRunner().invoke(robots, ["--json"], **AS_ONE)

    rows = {row["address"]: row for row in map(json.loads, result.output.splitlines())}
    kinds = {"circular": "ring", "fingers": "fingers", "fingers-experiment": "fingers"}
    kinds |= {"press": "press", "sphere-a": "sphere", "sphere-b": "sphere"}
    assert {address: row["kind"] for address, row in rows.items()} == {f"sim:{name}": kinds[name] for name in kinds}
    assert rows["sim:circular"]["coils"] == list("ABCDEFGH")
    assert (rows["sim:fingers"]["coils"], rows["sim:fingers"]["joints"]) == ([], ["R", "L"])


def test_robots_fits_a_terminal_and_names_every_coil():
    lines = CliRunner().invoke(robots, **AS_ONE).output.splitlines()

    assert max(map(len, lines)) <= 120
    assert lines[0].startswith("sim:circular            8 coils   Eight BMX100 coils in a rubber ring")
    assert lines[2].startswith("sim:fingers             2 joints  Two one-joint fingers with soft tips")
    assert " B10m1 B01m1 Bm10m1 B0m1m1" in " ".join(lines)
    assert sum(line.startswith("sim:") for line in lines) == 6


@pytest.mark.parametrize(
    ("arguments", "exit_code", "message"),
    [
        (["circlar"], 3, "no robot 'circlar'; did you mean circular?"),
        (["circular?slop=1"], 2, "no option 'slop'"),
        (["circular", "--slope", "61"], 2, "ground.slope_deg"),
        (["circular", "--speed", "0"], 2, "--speed"),
        (["circular", "--speed", "nan"], 2, "'nan' is not a number"),
        (["circular", "--link", "/proc/robot"], 3, "link /proc/robot: No such file or directory"),
        (["./none.toml"], 3, "no such robot file"),
        (["circular", "--faults", "none.toml"], 2, "none.toml: No such file or directory"),
        (["circular", "--can", "lin"], 2, "--can lin: write slcan, slcan=LINK, socketcand or socketcand=PORT"),
        (["circular", "--can", "slcan="], 2, "--can slcan=: write slcan"),
        (["circular", "--can", "socketcand=x"], 2, "--can socketcand=x: a TCP port is a number up to 65535"),
        (["circular", "--can", "slcan=/proc/can"], 3, "link /proc/can: No such file or directory"),
        (["circular@1,circular@1"], 2, "two robots have the number 1"),
        (["circular,sphere-b", "--faults", "none.toml"], 2, "--faults is for one robot"),
        (["circular?faults=tests/none.toml"], 2, "tests/none.toml: No such file or directory"),
    ],
)
def test_what_cannot_be_built_is_refused(arguments, exit_code, message):
    result = CliRunner().invoke(sim, arguments, **AS_ONE)

    assert result.exit_code == exit_code
    assert message in result.output
