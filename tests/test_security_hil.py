"""A paired robot on the bench, every layer real: the command line with its key, without one, and with another."""

import json

import pytest

from hil_sim.link import open_link
from host import keys
from host.errors import NotPaired
from host.robot import Robot
from tests.slot_bench import said

STILL = "sim:circular?body=still"


@pytest.fixture
def key(tmp_path):
    """The path of a key file."""
    keys.make(tmp_path / "robot.key")
    return str(tmp_path / "robot.key")


@pytest.fixture
def paired(key):
    """The address of a robot that has that key."""
    return f"{STILL}&key={key}"


@pytest.mark.parametrize("world", ["cpython", "micropython"])
def test_a_host_with_the_key_fires_a_coil(softrig, paired, key, world):
    fired = softrig(
        "fire", "A", "--duty", "50%", "--hold", "200ms", "--robot", f"{paired}&world={world}", "--key", key, "--json"
    )

    assert fired.status == 0, fired.err
    assert json.loads(fired.out)["peak_estimated_degc"]["A"] > 26


def test_the_key_can_come_from_the_environment(softrig, paired, key, monkeypatch):
    monkeypatch.setenv("SOFTRIG_KEY", key)

    asked = softrig("status", "--robot", paired, "--json")

    told = json.loads(asked.out)
    assert asked.status == 0
    assert (told["state"], told["forged"], told["repeated"], told["link"]["frames_forged"]) == ("idle", 0, 0, 0)
    assert told["overruns"] == 0  # though the number of the start was written down


def test_a_script_runs_on_a_paired_robot(softrig, paired, key, tmp_path):
    script = tmp_path / "warm.gait"
    script.write_text("gait 1\nrobot circular\nfire A at 50 % for 300 ms\n")

    ran = softrig("run", str(script), "--robot", paired, "--key", key, "--json")

    assert ran.status == 0, ran.err
    assert json.loads(ran.out)["result"] == "done"


@pytest.mark.parametrize("command", [["status"], ["arm"], ["disarm"], ["clear"], ["settings"], ["faults"]])
def test_an_order_without_the_key_is_refused_and_told(softrig, paired, command):
    refused = softrig(*command, "--robot", paired)

    assert refused.status == 4
    assert "takes orders only with its pairing key: --key FILE or SOFTRIG_KEY" in refused.err


def test_who_the_robot_is_everybody_may_ask(softrig, paired):
    asked, told = (softrig("info", "--robot", paired, *form) for form in (["--json"], []))

    assert (asked.status, told.status) == (0, 0)
    assert (json.loads(asked.out)["paired"], json.loads(asked.out)["may_arm"]) == (True, False)
    assert "takes orders only with its pairing key" in told.out


def test_a_wrong_key_is_told_as_such(softrig, paired, tmp_path):
    keys.make(tmp_path / "other.key")

    refused = softrig("status", "--robot", paired, "--key", str(tmp_path / "other.key"), "--json")

    told = json.loads(refused.out)
    assert refused.status == 4
    assert (told["error"], told["exit_code"]) == ("NotPaired", 4)
    assert told["message"].startswith("wrong key: this robot was paired with another")


def test_a_robot_without_a_key_is_refused_by_a_host_that_was_given_one(softrig, key):
    refused = softrig("status", "--robot", STILL, "--key", key)

    assert refused.status == 4
    assert "this robot has no pairing key, but a key was given" in refused.err


def test_a_damaged_key_on_the_robot_is_told_with_its_code(softrig, tmp_path):
    (tmp_path / "damaged.key").write_bytes(bytes(36))

    refused = softrig("status", "--robot", f"{STILL}&key={tmp_path / 'damaged.key'}")

    assert refused.status == 4
    assert "F24" in refused.err


def test_stop_needs_no_key_even_if_one_is_named_that_is_not_there(softrig, paired, monkeypatch):
    monkeypatch.setenv("SOFTRIG_KEY", "/nowhere/robot.key")

    stopped = softrig("stop", "--robot", paired)

    assert stopped.status == 0
    assert "stopped" in stopped.out


def test_a_key_that_is_not_there_is_told_before_the_robot_is_greeted(softrig, paired):
    refused = softrig("status", "--robot", paired, "--key", "none.key")

    assert refused.status == 2
    assert "key file none.key: No such file or directory" in refused.err


def test_a_paired_robot_opens_its_console_when_it_is_ordered_to(paired, key):
    link = open_link(paired)
    with Robot(link, key=keys.read(key)) as robot:
        robot.connect()
        robot.service()
        link.bench.run(1)

        assert said(link.bench) == ["softrig: service"]


def test_a_paired_robot_on_a_can_bus_takes_orders_with_the_key_only(softrig, key):
    robot = ("--robot", f"can:softrig:circular@1?body=still&key={key}")

    with_key, without = softrig("arm", *robot, "--key", key), softrig("arm", *robot)

    assert (with_key.status, without.status) == (0, 4)


def test_a_second_host_with_the_key_waits_for_the_first_ones_lease(paired, key):
    link = open_link(paired)
    first = Robot(link, key=keys.read(key))
    first.connect()
    first.arm(lease_ms=500)
    first.leave_armed()

    second = Robot(link, key=keys.read(key))
    second.connect()
    second.arm()

    assert second.status().state == "armed"
    link.close()


def test_a_run_on_a_paired_robot_is_the_same_to_the_byte_again_and_in_both_worlds(paired, key):
    def trace(world):
        link = open_link(f"{paired}&world={world}")
        with Robot(link, key=keys.read(key)) as robot:
            robot.connect()
            robot.arm()
            robot.disarm()
            return link.bench.trace_sha256()

    assert trace("cpython") == trace("cpython") == trace("micropython")


def test_a_host_without_the_key_may_watch_but_not_order(paired):
    with Robot(open_link(paired)) as robot:
        robot.connect(watch_only=True)

        with pytest.raises(NotPaired, match="arm refused"):
            robot.arm()
