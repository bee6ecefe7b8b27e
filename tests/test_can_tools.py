"""Tools that know nothing of softrig read its CAN bus: python-can through slcan, cantools through the DBC."""

import fcntl
import json
import os
import pty
import re
import select
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path

import can
import pytest

from docs import dbc

FILE = Path(__file__).parents[1] / "docs" / "softrig.dbc"
SOFTRIG = str(Path(sys.executable).with_name("softrig"))
CANTOOLS = [sys.executable, "-m", "cantools"]
MASK = ["--frame-id-mask", hex(dbc.MASK)]
PATIENCE_S = 90  # cantools imports all of matplotlib: on a busy machine that alone takes ten seconds
SCREEN = struct.pack("HHHH", 60, 160, 0, 0)  # rows, columns


@pytest.fixture(scope="module")
def adapter():
    """Return the path of an slcan adapter on a bus with two robots, in real time."""
    command = [SOFTRIG, "sim", "circular@3?body=still,circular@5?body=still", "--can", "slcan", "--json"]
    bench = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        yield json.loads(bench.stdout.readline())["can"][0].split(":")[2].split("@")[0]
    finally:
        bench.kill()
        bench.wait()


@pytest.fixture(scope="module")
def lines(adapter, tmp_path_factory):
    """Return what `cantools decode` makes of some frames, which python-can heard and wrote as candump does."""
    log = tmp_path_factory.mktemp("can") / "heard.log"
    with can.Bus(interface="slcan", channel=adapter, bitrate=500_000) as bus, can.CanutilsLogWriter(log) as writer:
        for _ in range(40):
            message = bus.recv(PATIENCE_S)
            assert message is not None
            writer.on_message_received(message)
    command = [*CANTOOLS, "decode", "--single-line", *MASK, str(FILE)]
    done = subprocess.run(
        command, input=log.read_text(), capture_output=True, text=True, check=True, timeout=PATIENCE_S
    )
    return done.stdout.splitlines()


def test_every_frame_that_the_robots_send_unasked_is_decoded(lines):
    assert len(lines) == 40
    assert all(re.search(r":: beacon(_coils)?\(", line) for line in lines), lines


def test_what_is_decoded_is_in_words_and_units(lines):
    told = [line for line in lines if ":: beacon(" in line]

    assert any(
        re.search(r"state: idle, code: 0, step: 0, supply_mv: \d+ mV, current_ma: 0 mA", line) for line in told
    ), told


@pytest.mark.parametrize(("name", "shown"), [("beacon", r"beacon\(state: idle"), ("beacon_coils", r"coils\(group: ")])
def test_cantools_monitor_shows_the_robots(adapter, name, shown):
    """One message alone: of several, the terminal is sent only what differs from line to line."""
    bus = ["--interface", "slcan", "--channel", adapter, "--bitrate", "500000"]
    only = ["--single-line", "--filter-regex", f"^{name}$"]
    with Terminal([*CANTOOLS, "monitor", *only, *bus, *MASK, str(FILE)]) as terminal:
        terminal.wait_for(shown)
        terminal.press("q")

        assert terminal.ended() == 0


def test_softrig_runs_a_script_over_the_adapter(adapter, tmp_path):
    script = tmp_path / "two.gait"
    script.write_text("gait 1\nrobot circular\nfire A at 40 % for 300 ms\nfire C at 30 % for 200 ms\n")
    command = [SOFTRIG, "run", str(script), "--robot", f"can:slcan:{adapter}@3", "--json"]

    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE_S)

    assert done.returncode == 0, done.stdout + done.stderr
    report = json.loads(done.stdout.splitlines()[-1])
    assert report["result"] == "done"
    assert {label: coil["on_s"] for label, coil in report["coils"].items() if coil["on_s"]} == {
        "A": pytest.approx(0.3, abs=0.06),  # a record of telemetry
        "C": pytest.approx(0.2, abs=0.06),
    }


class Terminal:
    """A program on a terminal of its own."""

    def __init__(self, command):
        self._screen, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, SCREEN)
        environment = {**os.environ, "TERM": "xterm", "LINES": "60", "COLUMNS": "160"}
        self._process = subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs, env=environment)
        os.close(theirs)
        self._shown = ""

    def __enter__(self):
        return self

    def __exit__(self, *raised):
        self._process.kill()
        self._process.wait()
        os.close(self._screen)

    def wait_for(self, pattern):
        """Wait until that has been shown."""
        until_s = time.monotonic() + PATIENCE_S
        while not re.search(pattern, self._shown):
            assert time.monotonic() < until_s, self._shown[-2000:]
            self._read()

    def press(self, key):
        os.write(self._screen, key.encode())

    def ended(self):
        """Return how the program ended; what it still shows must be read, or it waits."""
        until_s = time.monotonic() + PATIENCE_S
        while self._process.poll() is None and time.monotonic() < until_s:
            self._read()
        return self._process.poll()

    def _read(self):
        ready, _, _ = select.select([self._screen], [], [], 0.2)
        if ready:
            try:
                self._shown += os.read(self._screen, 65_536).decode(errors="replace")
            except OSError:
                return
