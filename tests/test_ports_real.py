"""Real ports in real time: only that things arrive, with generous time-outs, never how fast."""

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from pathlib import Path

import pytest
import serial

from hil_sim.announcement import Announcement, announcements
from hil_sim.ports import Pace, PortError, Pty, SerialEnd, Tcp, serve
from tests.bench_fakes import bench_of

PATIENCE_S = 30
ECHO = """
uart = UART(0, baudrate=115200, tx=Pin(0), rx=Pin(1))
while True:
    data = uart.read()
    if data:
        uart.write(data)
    time.sleep_ms(1)
"""
EVERY_BYTE = bytes(range(256))


@pytest.fixture
def served(tmp_path):
    """Serve an echo that has booted on the given ports in a thread, as long as the context lasts."""

    @contextmanager
    def serving(*ports):
        booted, ended = threading.Event(), threading.Event()

        def work():
            bench = bench_of(tmp_path, ECHO)
            bench.run(0.1)
            booted.set()
            serve(bench.clock, [SerialEnd(bench, ports)], Pace(1.0), ended.is_set)
            bench.close()

        thread = threading.Thread(target=work)
        thread.start()
        assert booted.wait(PATIENCE_S)
        try:
            yield
        finally:
            ended.set()
            thread.join(PATIENCE_S)

    return serving


def test_every_byte_value_comes_back_through_the_terminal(served):
    with Pty() as pty, served(pty), serial.Serial(pty.path, timeout=PATIENCE_S) as port:
        port.write(EVERY_BYTE[:128])
        first = port.read(128)
        port.write(EVERY_BYTE[128:])
        second = port.read(128)

    assert first + second == EVERY_BYTE


def test_a_host_may_close_the_terminal_and_another_open_it(served):
    with Pty() as pty, served(pty):
        got = []
        for word in (b"one", b"two", b"three"):
            with serial.Serial(pty.path, timeout=PATIENCE_S) as port:
                port.write(word)
                got.append(port.read(len(word)))

    assert got == [b"one", b"two", b"three"]


def test_bytes_take_the_time_of_the_line(served):
    """A bare pseudo-terminal is instantaneous; this one takes at least 86.8 us a byte each way."""
    with Pty() as pty, served(pty), serial.Serial(pty.path, timeout=PATIENCE_S) as port:
        started_s = time.monotonic()
        port.write(bytes(250))
        port.read(250)
        taken_s = time.monotonic() - started_s

    assert taken_s >= 250 * 86.8e-6


def test_a_host_that_never_reads_stops_nobody(served):
    with Pty() as pty, Tcp(0) as tcp, served(pty, tcp):
        line = socket.create_connection(("127.0.0.1", tcp.port), timeout=PATIENCE_S)
        for _ in range(100):  # more than a terminal keeps
            line.sendall(bytes(100))
            assert receive(line, 100) == bytes(100)
        line.close()


def test_the_link_points_at_the_terminal_as_long_as_it_lives(tmp_path):
    link = tmp_path / "robot"

    with Pty(link) as pty:
        assert os.readlink(link) == pty.path
    assert not link.is_symlink()


def test_a_stale_link_is_replaced_and_anything_else_is_left_alone(tmp_path):
    stale, precious = tmp_path / "stale", tmp_path / "precious"
    stale.symlink_to("/nowhere")
    precious.write_text("data")

    with Pty(stale) as pty:
        assert os.readlink(stale) == pty.path
    with pytest.raises(PortError, match="something that is not a symbolic link is there already"):
        Pty(precious)

    assert precious.read_text() == "data"


def test_a_link_in_no_folder_is_refused(tmp_path):
    with pytest.raises(PortError, match="there is no folder"):
        Pty(tmp_path / "none" / "robot")


def test_bytes_come_back_over_tcp_and_a_second_host_is_refused(served):
    with Tcp(0) as tcp, served(tcp):
        with socket.create_connection(("127.0.0.1", tcp.port), timeout=PATIENCE_S) as first:
            first.sendall(b"first")
            assert receive(first, 5) == b"first"
            with socket.create_connection(("127.0.0.1", tcp.port), timeout=PATIENCE_S) as second:
                assert second.recv(1) == b""
        with socket.create_connection(("127.0.0.1", tcp.port), timeout=PATIENCE_S) as third:
            third.sendall(b"third")
            assert receive(third, 5) == b"third"


def test_a_taken_tcp_port_is_refused_with_its_number():
    with Tcp(0) as tcp, pytest.raises(PortError, match=f"TCP port {tcp.port}: Address already in use"):
        Tcp(tcp.port)


def test_a_running_bench_announces_itself_and_dead_ones_are_swept(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    announcements().mkdir()
    dead = announcements() / "999999999.json"
    dead.write_text("{}")

    with Announcement({"robot": "circular", "pty": "/dev/pts/9"}):
        file = announcements() / f"{os.getpid()}.json"
        assert json.loads(file.read_text()) == {"pid": os.getpid(), "robot": "circular", "pty": "/dev/pts/9"}
        assert not dead.exists()

    assert not file.exists()


def receive(line: socket.socket, count: int) -> bytes:
    """Return `count` bytes, or fewer when the other end hangs up."""
    data = b""
    while len(data) < count:
        more = line.recv(count - len(data))
        if not more:
            break
        data += more
    return data


@pytest.fixture
def sim(tmp_path):
    """Start `softrig sim` and return the process and what it said it listens on."""
    started = []

    def start(*options, name="circular"):
        command = [sys.executable, "-c", "from host.cli import main; main()", "sim", name, "--json", *options]
        process = subprocess.Popen(
            command, stdout=subprocess.PIPE, text=True, env={**os.environ, "XDG_RUNTIME_DIR": str(tmp_path)}
        )
        started.append(process)
        return process, json.loads(process.stdout.readline())

    yield start
    for process in started:
        process.kill()
        process.wait(PATIENCE_S)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_command_listens_until_a_signal_and_then_says_what_it_saw(sim, tmp_path, number):
    link = tmp_path / "robot"
    process, listening = sim("--link", str(link), "--tcp", "0")
    assert listening["event"] == "listening"
    assert Path(listening["pty"]) == link.resolve()
    assert listening["tcp"].startswith("socket://127.0.0.1:")
    assert (tmp_path / "softrig" / f"{process.pid}.json").exists()

    process.send_signal(number)
    observed = json.loads(process.communicate(timeout=PATIENCE_S)[0])

    assert process.returncode == 0
    assert observed["event"] == "observed"
    assert abs(observed["travel_mm"]) < 0.1
    assert not link.is_symlink()
    assert not (tmp_path / "softrig" / f"{process.pid}.json").exists()


def test_the_command_prints_the_address_of_each_robot_on_each_port_of_the_bus(sim, tmp_path):
    link = tmp_path / "slcan"

    _, listening = sim(
        "--can", f"slcan={link}", "--can", "socketcand=0", name="circular@3?body=still,circular?body=still"
    )

    *_, port = listening["can"][2].split(":")
    assert listening["can"] == [
        f"can:slcan:{link}@1",
        f"can:slcan:{link}@3",
        f"can:socketcand:127.0.0.1:{port.split('@')[0]}@1",
        f"can:socketcand:127.0.0.1:{port.split('@')[0]}@3",
    ]
    assert sorted(listening["ptys"]) == ["1", "3"]
    assert Path(os.readlink(link)).exists()
