"""A robot of the bench listens to other machines only if it has a pairing key."""

import pytest
from click.testing import CliRunner

from hil_sim.address import Address
from hil_sim.assembly import assemble
from hil_sim.command import sim
from hil_sim.link import open_link
from hil_sim.ports import LOOPBACK, Tcp

NEEDS_A_KEY = "others may come there, so the robot needs a key"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--tcp", "0", "--listen", "0.0.0.0"], NEEDS_A_KEY),
        (["--tcp", "0", "--listen", "::"], NEEDS_A_KEY),
        (["--tcp", "0", "--listen", "192.0.2.1"], NEEDS_A_KEY),
        (["--tcp", "0", "--listen", "everywhere"], "write an IP address"),
        (["--listen", "0.0.0.0", "--key", "none.key"], "add --tcp PORT"),
        (["--tcp", "0", "--listen", "0.0.0.0", "--key", "none.key"], "key=none.key: No such file"),
        (["--tcp", "0", "--key", "none.key"], "key=none.key: No such file"),
    ],
)
def test_a_place_that_others_reach_is_refused_without_a_key(arguments, message):
    result = CliRunner().invoke(sim, ["circular", *arguments])

    assert result.exit_code == 2
    assert message in result.output


def test_it_is_the_robot_behind_the_port_that_needs_the_key():
    """A TCP port belongs to the robot with the lowest number, wherever that stands."""
    result = CliRunner().invoke(sim, ["circular@5?key=none.key,circular@2", "--tcp", "0", "--listen", "0.0.0.0"])

    assert result.exit_code == 2
    assert NEEDS_A_KEY in result.output


def test_a_tcp_port_is_this_machines_own_unless_told_otherwise():
    with Tcp(0) as tcp:
        assert tcp._listener.getsockname()[0] == LOOPBACK


def test_the_key_of_an_address_is_on_the_robots_flash_before_it_starts(tmp_path):
    (tmp_path / "robot.key").write_bytes(b"whatever it is")

    bench = assemble(Address("circular", body="still", key=str(tmp_path / "robot.key")))

    assert bench.board.flash.read("/key") == b"whatever it is"
    bench.close()


def test_a_key_file_that_is_not_there_is_told():
    with pytest.raises(ValueError, match=r"key=none\.key: No such file or directory"):
        open_link("sim:circular?key=none.key")
