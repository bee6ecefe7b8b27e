"""A pairing key comes onto a board through its console, and shuts it; an order with the key opens it again."""

import json
import os

import pytest

from hil_sim.link import SimLink
from host import keys
from host.deploy.pairing import Keys, ask_for_console, chosen
from host.errors import BadRequest, NotOurs, NotPaired, PortAbsent
from tests.fake_pico import FakePico
from tests.slot_bench import said
from tests.test_deploy_board import deploy, image  # noqa: F401  (a fixture that every test here needs)


@pytest.fixture
def key(tmp_path):
    """The path of a key file."""
    keys.make(tmp_path / "robot.key")
    return str(tmp_path / "robot.key")


@pytest.fixture
def flash(tmp_path):
    """The folder that is a board's flash."""
    (tmp_path / "flash").mkdir()
    return tmp_path / "flash"


@pytest.fixture
def consoles(monkeypatch):
    """Return what the robots of the bench have said on their consoles, a second after their lines were closed."""
    lines, close = [], SimLink.close

    def close_late(link):
        link.bench.run(1)
        lines.extend(said(link.bench))
        close(link)

    monkeypatch.setattr(SimLink, "close", close_late)
    return lambda: lines


def test_a_key_is_put_on_the_board_with_its_program(flash, key):
    with FakePico(flash) as pico:
        told = json.loads(deploy(pico, "--key", key, "--json"))

    assert told["pairing"] == "it takes orders only with the pairing key now"
    assert keys.packed(keys.read(key)) == (flash / "key").read_bytes()
    assert not (flash / "key.new").exists()


def test_a_board_with_a_key_does_not_open_its_console_to_everybody(flash, key, monkeypatch):
    monkeypatch.setattr("host.deploy.console.OPEN_S", 3.0)
    with FakePico(flash) as pico:
        deploy(pico, "--key", key)

        with pytest.raises(NotOurs, match="a robot with a pairing key opens it only by --robot ADDRESS"):
            deploy(pico)


def test_a_board_that_was_ordered_to_opens_its_console_and_is_given_another_key(flash, key, tmp_path):
    keys.make(tmp_path / "new.key")
    (flash / "starts.0").write_bytes(b"so many")
    with FakePico(flash) as pico:
        deploy(pico, "--key", key)
        pico.ordered.set()

        told = deploy(pico, "--key", str(tmp_path / "new.key"))

    assert "it takes orders only with the pairing key now" in told
    assert (flash / "key").read_bytes() == (tmp_path / "new.key").read_bytes()
    assert not (flash / "starts.0").exists()


def test_the_key_that_is_there_already_stays_with_its_number_of_starts(flash, key):
    with FakePico(flash) as pico:
        deploy(pico, "--key", key)
        (flash / "starts.0").write_bytes(b"so many")
        pico.ordered.set()

        told = deploy(pico, "--key", key)

    assert "it has its pairing key already" in told
    assert (flash / "starts.0").exists()


def test_a_key_can_be_taken_away(flash, key):
    with FakePico(flash) as pico:
        deploy(pico, "--key", key)
        pico.ordered.set()

        told = deploy(pico, "--unpair", "--json")

    assert json.loads(told)["pairing"] == "its pairing key was taken away"
    assert not (flash / "key").exists()


def test_a_deployment_without_a_key_leaves_the_one_that_is_there(flash, key):
    with FakePico(flash) as pico:
        deploy(pico, "--key", key)
        pico.ordered.set()

        told = json.loads(deploy(pico, "--json"))

    assert told["pairing"] is None
    assert (flash / "key").exists()


def test_a_key_is_given_or_taken_away_not_both(key):
    with pytest.raises(BadRequest, match="choose one"):
        chosen(key, None, True)


@pytest.fixture
def paired(key):
    """The address of a robot of the bench that has that key."""
    return f"sim:circular?body=still&key={key}"


def test_a_robot_is_ordered_to_open_its_console_with_the_key_it_has(paired, key, consoles):
    ask_for_console(paired, chosen(key, None, False))
    ask_for_console(paired, chosen(None, key, True))

    assert consoles() == ["softrig: service"] * 2


def test_a_robot_without_a_key_is_ordered_to_before_it_is_given_one(key, consoles):
    ask_for_console("sim:circular?body=still", chosen(key, None, False))

    assert consoles() == ["softrig: service"]


def test_a_robot_whose_key_is_not_known_is_not_ordered_to(paired, tmp_path):
    with pytest.raises(NotPaired, match="only with its pairing key"):
        ask_for_console(paired, Keys(os.urandom(32), b"", False))

    with pytest.raises(NotPaired, match="wrong key"):
        ask_for_console(paired, Keys(b"", os.urandom(32), False))


def test_a_robot_that_does_not_answer_is_left_to_its_console(monkeypatch):
    asked = []
    monkeypatch.setattr("host.deploy.pairing.open_link", lambda address: asked.append(address) or absent(address))

    ask_for_console("/dev/nothing", Keys(os.urandom(32), b"", False))

    assert asked == ["/dev/nothing"]  # and not again with another key


def absent(address):
    """Say what a port that is not there says."""
    raise PortAbsent(f"no port {address}")
