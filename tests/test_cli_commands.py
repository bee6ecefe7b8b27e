"""The commands, against a fake robot: what they print, and the exit status of every ending."""

import json
import os
import re
import subprocess
import sys

import pytest

from host.definitions import dictionary_of
from protocol import causes, codes, messages
from tests.fake_robot import PROFILE, FakeLine, FakeRobot, plug_in

LIMITS = json.loads(PROFILE)["coil"]
SCRIPT = "gait 1\nrobot circular\nparam duty = 60 % [5 % .. 90 %]\nfire A at $duty for 400 ms\n"


@pytest.fixture
def peer():
    return FakeRobot()


@pytest.fixture
def line(peer, monkeypatch):
    """A line to `peer`, at the address fake:."""
    line = FakeLine(peer)
    plug_in(line, monkeypatch)
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    return line


@pytest.fixture
def script(tmp_path):
    path = tmp_path / "a.gait"
    path.write_text(SCRIPT)
    return str(path)


def names(peer) -> list[str]:
    return [name for _, name, _ in peer.orders]


def test_info_prints_labels_and_limits_as_the_robot_gives_them(softrig, line):
    told = softrig("info")

    assert told.status == 0
    assert "coils       A B C D E F G H" in told.out
    assert f"trips at {LIMITS['trip_degc']} C" in told.out


def test_json_is_one_object_on_one_line(softrig, line):
    told = softrig("info", "--json")

    assert told.out.count("\n") == 1
    assert json.loads(told.out)["limits"]["heat_budget_mj"] == LIMITS["heat_budget_mj"]


def test_status_tells_how_a_robot_lies_that_knows(softrig, line, peer):
    assert "attitude" not in softrig("status").out
    assert json.loads(softrig("status", "--json").out)["down"] is None

    peer.attitude = {"roll_decideg": -15, "pitch_decideg": 452, "down": 3}

    assert "  attitude    D down, pitch 45.2 deg, roll -1.5 deg\n" in softrig("status").out
    assert json.loads(softrig("status", "--json").out)["pitch_deg"] == 45.2


def test_status_asks_the_robot(softrig, line):
    fields = json.loads(softrig("status", "--json").out)

    assert fields["state"] == "idle"
    assert fields["supply_mv"] == 2000
    assert fields["link"]["frames_resent"] == 0


def test_arm_leaves_the_robot_armed(softrig, peer, line):
    told = softrig("arm")

    assert told.out == "armed; disarms itself in 500 ms\n"
    assert "disarm" not in names(peer)


def test_arm_for_a_time_holds_the_lease_and_disarms(softrig, peer, line):
    softrig("arm", "--for", "2s")

    assert names(peer)[-1] == "disarm"
    assert line.now_ms - 1000 >= 2000


def test_disarm_and_clear_tell_the_state(softrig, peer, line):
    assert softrig("disarm").out == "idle\n"
    assert softrig("clear").out == "idle\n"


def test_fire_arms_fires_watches_and_disarms(softrig, peer, line):
    told = softrig("fire", "A", "C", "--duty", "60%", "--hold", "500ms")

    order = next(order for _, name, order in peer.orders if name == "fire")
    assert (order.coils, order.duty_permille, order.hold_ms) == (0b101, 600, 500)
    assert [name for name in names(peer) if name in ("arm", "fire", "disarm")] == ["arm", "fire", "disarm"]
    assert told.out.splitlines()[0] == "A at 60 % for 500 ms: 85.0 C at most, as the robot estimates"


@pytest.mark.parametrize(
    ("text", "hold_ms"), [("500ms", 500), ("0.5s", 500), ("0.5", 500), ("2 s", 2000), (".25 s", 250)]
)
def test_times_are_read_as_an_operator_writes_them(softrig, peer, line, text, hold_ms):
    softrig("fire", "A", "--duty", "10", "--hold", text)

    assert next(order for _, name, order in peer.orders if name == "fire").hold_ms == hold_ms


@pytest.mark.parametrize("text", ["fast", "5 h", "-1s", "", "1e3", "60%", "nan", "\u0663", "9" * 400])
def test_a_time_that_is_none_is_a_mistake_of_usage(softrig, peer, line, text):
    told = softrig("fire", "A", "--duty", "10%", "--hold", text)

    assert told.status == 2
    assert peer.orders == []


@pytest.mark.parametrize(
    ("arguments", "told_as"),
    [
        (("fire", "A", "--duty", "10%", "--hold", "70s"), f"R05 .* 70000 ms, at most {LIMITS['hold_max_ms']}"),
        (("fire", "A", "--duty", "99999999", "--hold", "1s"), "R04 .* 999999990 permille, at most 1000"),
        (("arm", "--lease", "100s"), "R17 .* 100000 ms, at most 5000"),
    ],
)
def test_a_value_that_no_message_can_carry_is_refused_with_the_robots_limit(softrig, line, arguments, told_as):
    told = softrig(*arguments)

    assert told.status == 4
    assert re.search(told_as, told.err)


def test_stop_needs_no_hello(softrig, peer, line):
    peer.duty[2] = 600

    told = softrig("stop")

    assert told.status == 0
    assert told.out == "stopped; channel 2 on before, none now\n"
    assert names(peer) == []


def test_run_prints_the_report_and_exits_0(softrig, line, script):
    told = softrig("run", script)

    assert told.status == 0
    assert told.out.splitlines()[0] == f"{script} on fake:: done"


def test_run_in_a_pipe_shows_no_progress(softrig, line, script):
    assert softrig("run", script).err == ""


def test_parameters_are_given_on_the_command_line(softrig, peer, line, script):
    fields = json.loads(softrig("run", script, "-p", "duty=75%", "--json").out)

    assert fields["parameters"] == {"duty": "75 %"}


def test_a_dry_run_uploads_and_does_not_arm(softrig, peer, line, script):
    told = softrig("run", script, "--dry-run", "--json")

    assert json.loads(told.out)["result"] == "dry run"
    assert "code" in names(peer)
    assert not {"arm", "start"} & set(names(peer))


def test_check_uploads_nothing(softrig, peer, line, script):
    told = softrig("check", script)

    assert told.status == 0
    assert "keeps the limits of circular" in told.out
    assert set(names(peer)) == {"hello", "dictionary"}


def test_a_script_over_the_limits_is_refused_before_anything_is_uploaded(softrig, peer, line, tmp_path):
    path = tmp_path / "hot.gait"
    path.write_text("gait 1\nrobot circular\nfire A at 100 % for 9 s\n")

    told = softrig("run", str(path), "--json")

    assert told.status == 4
    assert f"{path}:3:" in told.err
    assert json.loads(told.out)["diagnostics"][0]["code"] == "E306"
    assert "program" not in names(peer)


def test_a_script_for_another_robot_is_refused(softrig, line, tmp_path):
    path = tmp_path / "other.gait"
    path.write_text("gait 1\nrobot sphere\nfire A at 10 % for 100 ms\n")

    told = softrig("check", str(path))

    assert told.status == 4
    assert "E300" in told.err


def test_a_guard_that_holds_ends_in_1_with_the_report(softrig, peer, line, script):
    peer.ending = (messages.TRIP, codes.GUARD, 0, 1100)

    told = softrig("run", script, "--json")

    assert told.status == 1
    assert json.loads(told.out.splitlines()[0])["faults"][0]["code"] == "F10"
    assert told.err.startswith("softrig: the script ended early: F10")


def test_an_absent_port_exits_3(softrig):
    told = softrig("status", "--robot", "/dev/no-such-port")

    assert told.status == 3
    assert told.err == "softrig: no port /dev/no-such-port: `softrig ports` lists those there are\n"


def test_a_silent_port_exits_3(softrig, peer, line):
    peer.deaf = True

    assert softrig("info").status == 3


def test_a_refusal_exits_4_and_tells_its_code(softrig, peer, line):
    peer.refuse["arm"] = (codes.TRIPPED, 255, 105, 0)

    told = softrig("arm", "--json")

    assert told.status == 4
    assert json.loads(told.out)["code"] == "R02"


def test_another_dictionary_exits_5(softrig, peer, monkeypatch, line):
    line.robot = FakeRobot(dictionary=dictionary_of(PROFILE).replace(b"fire ", b"heat "))

    told = softrig("info")

    assert told.status == 5
    assert "- 20 fire" in told.err


def test_a_fault_during_fire_exits_6(softrig, peer, line):
    line.at[1300] = lambda: peer.tell(messages.TRIP, codes.OVER_CURRENT, 255, 1600, line.now_ms)

    told = softrig("fire", "A", "--duty", "60%", "--hold", "500ms")

    assert told.status == 6
    assert "F06 The supply current is above its limit. 1600 mA." in told.err


def test_a_cut_cable_exits_7_with_the_report(softrig, line, script):
    line.at[1200] = lambda: setattr(line, "cut", True)

    told = softrig("run", script, "--json")

    assert told.status == 7
    assert json.loads(told.out.splitlines()[0])["result"] == "link lost"


def test_ctrl_c_stops_the_robot_says_so_and_exits_130(softrig, peer, line, script):
    def interrupt() -> None:
        raise KeyboardInterrupt

    line.at[1300] = interrupt

    told = softrig("run", script)

    assert told.status == 130
    assert "stop acknowledged" in told.err
    assert peer.stops >= 1


def test_a_log_is_written_read_and_exported(softrig, line, script, tmp_path):
    log, table = str(tmp_path / "run.mcap"), tmp_path / "run.csv"
    softrig("run", script, "--log", log)

    info = json.loads(softrig("log", "info", log, "--json").out)
    exported = softrig("log", "export", log, "-o", str(table))

    assert info["complete"]
    assert info["versions"]["robot"] == "circular"
    assert {"dictionary.txt", "versions.json", "report.json", script} == set(info["attachments"])
    assert exported.status == 0
    assert table.read_text().startswith("host_ms,now_ms,state,step,supply_mv")


def test_a_lost_link_leaves_a_complete_log(softrig, line, script, tmp_path):
    log = str(tmp_path / "run.mcap")
    line.at[1200] = lambda: setattr(line, "cut", True)

    softrig("run", script, "--log", log)

    assert json.loads(softrig("log", "info", log, "--json").out)["complete"]


def test_every_code_of_both_tables_is_explained(softrig):
    listed = softrig("explain").out

    assert all(f"\n{row.name}  " in listed for row in causes.CODES)
    assert softrig("explain", "f05").out.splitlines()[1] == (
        "  cause      A coil's estimated temperature is above its limit."
    )
    assert json.loads(softrig("explain", "E141", "--json").out)["code"] == "E141"


def test_an_unknown_code_is_a_mistake_of_usage(softrig):
    assert softrig("explain", "F99").status == 2


def test_an_unknown_command_is_answered_with_the_nearest(softrig):
    told = softrig("statsu")

    assert told.status == 2
    assert "did you mean 'status'?" in told.err


def test_a_command_that_needs_a_robot_says_how_to_name_it(softrig, monkeypatch):
    monkeypatch.delenv("SOFTRIG_ROBOT", raising=False)

    told = softrig("status")

    assert told.status == 2
    assert "SOFTRIG_ROBOT" in told.err


@pytest.mark.parametrize("command", ["status", "stop", "run", "check"])
@pytest.mark.parametrize("address", ["", " "])
def test_an_empty_address_names_no_robot(softrig, script, command, address):
    told = softrig(command, *([script] if command in ("run", "check") else []), "--robot", address)

    assert told.status == 2
    assert told.err == "softrig: no robot was named: write sim:circular, the path of a port, or socket://HOST:PORT\n"


@pytest.mark.parametrize("address", ["/dev/no\nport", "socket://no\nhost:7", "socket://[\n:7", "sim:no\nrobot"])
def test_an_address_that_cannot_be_printed_is_refused_in_one_line(softrig, address):
    told = softrig("status", "--robot", address)

    assert told.status in (2, 3)
    assert told.err.count("\n") == 1


def test_a_figure_is_not_drawn_from_an_empty_address(softrig, tmp_path):
    assert softrig("figure", "3", "-o", str(tmp_path / "3.svg"), "--robot", "").status == 2


def test_a_script_that_is_not_there_is_said_so(softrig):
    told = softrig("check", "no-such.gait")

    assert told.status == 2
    assert "no-such.gait" in told.err


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a full disk")
def test_a_disk_that_fills_during_a_run_ends_in_one_line_with_every_coil_off(
    softrig, peer, line, tmp_path, monkeypatch
):
    monkeypatch.setattr("host.log.LogWriter.attach", lambda *_: None)  # what fills first is a chunk of the run
    script = tmp_path / "long.gait"
    script.write_text(SCRIPT + "wait 60 s\n")
    peer.program_ms = 60_000

    told = softrig("run", str(script), "--log", "/dev/full")

    assert told.status == 2
    assert told.err == "softrig: cannot write the log /dev/full: No space left on device\n"
    assert names(peer)[-2:] == ["start", "disarm"]


@pytest.mark.skipif(not os.path.isdir("/proc"), reason="needs a folder where nothing can be made")
def test_a_picture_that_cannot_be_written_is_said_in_one_line(softrig, line, script):
    told = softrig("run", script, "--plot", "/proc/x.svg")

    assert told.status == 2
    assert told.err == "softrig: cannot write /proc/x.svg: No such file or directory\n"


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a full disk")
def test_an_output_that_cannot_be_written_is_said_in_one_line():
    with open("/dev/full", "wb") as full:
        ended = subprocess.run(
            [sys.executable, "-c", "from host.cli import main; main(['explain'])"],
            stdout=full, stderr=subprocess.PIPE, text=True, check=False,
        )  # fmt: skip

    assert ended.stderr == "softrig: the output cannot be written: No space left on device\n"
    assert ended.returncode == 1


def test_info_prints_what_the_messages_mean_as_the_robot_says_it(softrig, line):
    told = softrig("info", "--dictionary")

    assert "20 fire coils:I duty_permille:H[0..1000] hold_ms:H\n    fire: Heat coils for a limited time.\n" in told.out
    assert "    hold_ms: Off again after this long.\n" in told.out
    assert "STATES boot idle armed running tripped\n" in told.out
    assert "definitions" in json.loads(softrig("info", "--dictionary", "--json").out)
