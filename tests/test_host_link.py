"""Real ports: ptys and sockets opened, held by others, and gone. The only host tests that go by the wall clock."""

import errno
import fcntl
import os
import pty
import socket
import struct
import subprocess
import sys
import termios
import tty
from contextlib import suppress

import pytest

from host.errors import BadRequest, LinkLost, NoRobot, PortAbsent, PortBusy, PortForbidden
from host.holder import holder_of
from host.link import open_link, open_socket

HOLD = """
import fcntl, sys
port = open(sys.argv[1], "rb+", buffering=0)
fcntl.flock(port, fcntl.LOCK_EX)
print(flush=True)
sys.stdin.read()
"""


@pytest.fixture
def terminal():
    """A pty: (master, path of the slave)."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    yield master, os.ttyname(slave)
    for descriptor in (master, slave):
        with suppress(OSError):
            os.close(descriptor)


@pytest.fixture
def server():
    with socket.create_server(("127.0.0.1", 0)) as listening:
        yield listening


def test_bytes_pass_both_ways_through_a_port(terminal):
    master, path = terminal
    link = open_link(path)

    link.write(b"out\x00")
    os.write(master, b"in\x00")

    assert os.read(master, 10) == b"out\x00"
    assert link.read(link.now_s() + 5) == b"in\x00"
    link.close()


@pytest.mark.parametrize(("rate", "speed"), [("", termios.B115200), ("@921600", termios.B921600)])
def test_an_address_may_name_the_rate(terminal, rate, speed):
    link = open_link(f"{terminal[1]}{rate}")

    assert termios.tcgetattr(terminal[0])[5] == speed

    again = link.reopen()
    assert termios.tcgetattr(terminal[0])[5] == speed
    again.close()


def test_a_path_that_has_an_at_in_it_is_opened_all_the_same(terminal, tmp_path):
    port = tmp_path / "robot@3"
    port.symlink_to(terminal[1])

    for address in (str(port), f"serial:{port}@230400"):
        open_link(address).close()

    assert termios.tcgetattr(terminal[0])[5] == termios.B230400


@pytest.mark.parametrize("rate", ["fast", "0", "-9600", "1e6", "5000000"])
def test_what_is_no_rate_is_told(terminal, rate):
    with pytest.raises(BadRequest, match=r"is no rate; write .*@921600"):
        open_link(f"{terminal[1]}@{rate}")


def test_reading_returns_nothing_at_its_deadline(terminal):
    link = open_link(f"serial:{terminal[1]}")
    until_s = link.now_s() + 0.05

    assert link.read(until_s) == b""
    assert link.now_s() >= until_s
    link.close()


def test_an_absent_port_says_how_to_find_the_others():
    with pytest.raises(PortAbsent, match="no port /dev/no-such-port: `softrig ports`") as caught:
        open_link("/dev/no-such-port")

    assert caught.value.exit_code == 3


def test_a_file_that_is_no_port_is_said_to_be_none(tmp_path):
    (tmp_path / "notes").write_text("")

    with pytest.raises(PortAbsent, match="is no serial port"):
        open_link(str(tmp_path / "notes"))


def test_a_busy_port_names_the_program_that_holds_it(terminal):
    holder = subprocess.Popen([sys.executable, "-c", HOLD, terminal[1]], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    holder.stdout.readline()

    with pytest.raises(PortBusy, match=rf"held by python\S* \(process {holder.pid}\)") as caught:
        open_link(terminal[1])

    assert caught.value.exit_code == 3
    holder.communicate()


def test_a_second_opener_is_kept_out(terminal):
    first = open_link(terminal[1])

    with pytest.raises(PortBusy):
        open_link(terminal[1])

    first.close()
    open_link(terminal[1]).close()


def test_a_forbidden_port_names_its_group(monkeypatch, terminal):
    def forbidden(*args, **extra):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("serial.Serial", forbidden)

    with pytest.raises(PortForbidden, match=r"no permission for .*it belongs to the group \w+; `sudo usermod"):
        open_link(terminal[1])


def test_a_port_that_goes_away_is_a_lost_link(terminal):
    link = open_link(terminal[1])
    os.close(terminal[0])

    with pytest.raises(LinkLost, match="the line broke") as caught:
        link.read(link.now_s() + 5)

    assert caught.value.exit_code == 7
    with pytest.raises(LinkLost):
        link.write(b"x" * 100)


def test_a_port_that_takes_nothing_is_a_lost_link(terminal, monkeypatch):
    monkeypatch.setattr("host.link.WRITE_S", 0.1)
    link = open_link(terminal[1])

    with pytest.raises(LinkLost, match="Write timeout"):
        link.write(bytes(1 << 20))


@pytest.mark.parametrize("error", [OSError(5, "EIO"), TypeError("fileno"), ValueError("filedescriptor out of range")])
def test_whatever_waiting_for_a_port_raises_is_a_lost_link(terminal, monkeypatch, error):
    def gone(*_):
        raise error

    link = open_link(terminal[1])
    monkeypatch.setattr("select.select", gone)

    with pytest.raises(LinkLost):
        link.read(link.now_s() + 5)


def test_a_port_that_was_closed_is_a_lost_link_and_closes_twice(terminal):
    link = open_link(terminal[1])
    link.close()
    link.close()

    with pytest.raises(LinkLost):
        link.read(link.now_s() + 5)
    with pytest.raises(LinkLost):
        link.write(b"x")


@pytest.mark.parametrize("number", [errno.EIO, errno.ENODEV, errno.ENXIO])
def test_a_port_that_goes_away_while_it_is_opened_is_absent(terminal, monkeypatch, number):
    def gone(*_):
        raise termios.error(number, os.strerror(number))

    monkeypatch.setattr("termios.tcflush", gone)

    with pytest.raises(PortAbsent, match=f"no port {terminal[1]}"):
        open_link(terminal[1])


def test_a_port_is_opened_again_once_it_is_back(tmp_path):
    first, second = pty.openpty(), pty.openpty()
    port = tmp_path / "port"
    port.symlink_to(os.ttyname(first[1]))
    link = open_link(str(port))
    os.close(first[0])
    with pytest.raises(LinkLost):
        link.read(link.now_s() + 5)

    port.unlink()
    with pytest.raises(PortAbsent):
        link.reopen()
    port.symlink_to(os.ttyname(second[1]))
    again = link.reopen()

    again.write(b"x")
    assert os.read(second[0], 1) == b"x"
    for descriptor in (first[1], *second):
        os.close(descriptor)


def test_the_clock_of_a_broken_port_goes_on(terminal):
    link = open_link(terminal[1])
    link.close()
    until_s = link.now_s() + 0.02

    link.pause(until_s)

    assert link.now_s() >= until_s


def test_a_connection_that_is_reset_is_a_lost_link_and_can_be_made_again(server):
    address = f"socket://127.0.0.1:{server.getsockname()[1]}"
    link = open_link(address)
    other, _ = server.accept()
    other.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # closed with RST
    other.close()

    with pytest.raises(LinkLost):
        link.read(link.now_s() + 5)
    again = link.reopen()
    other, _ = server.accept()
    again.write(b"x")

    assert other.recv(1) == b"x"
    link.close()
    again.close()
    other.close()


def test_bytes_pass_both_ways_through_a_socket(server):
    link = open_link(f"socket://127.0.0.1:{server.getsockname()[1]}")
    other, _ = server.accept()

    link.write(b"out")
    other.sendall(b"in")

    assert other.recv(10) == b"out"
    assert link.read(link.now_s() + 5) == b"in"
    other.close()
    with pytest.raises(LinkLost):
        link.read(link.now_s() + 5)


def test_a_socket_that_nobody_serves_says_how_to_start_a_bench(server):
    port = server.getsockname()[1]
    server.close()

    with pytest.raises(PortAbsent, match=f"softrig sim NAME --tcp {port}"):
        open_link(f"socket://127.0.0.1:{port}")


@pytest.mark.parametrize("address", ["socket:", "socket://nowhere", "socket://127.0.0.1:seven"])
def test_a_socket_without_host_and_port_is_a_mistake_of_the_caller(address):
    with pytest.raises(BadRequest, match=r"write it as socket://127\.0\.0\.1:7000"):
        open_socket(address)


def test_an_unknown_scheme_lists_the_known_ones():
    with pytest.raises(BadRequest, match="no line warp: known are can:, serial:, sim:, socket:"):
        open_link("warp:9")


def test_a_bench_that_does_not_exist_says_which_do():
    with pytest.raises((NoRobot, BadRequest), match="circular"):
        open_link("sim:squared")


def test_a_holder_that_cannot_be_seen_is_another_program(tmp_path):
    assert holder_of(str(tmp_path / "port"), proc=tmp_path) == "another program"


def test_our_own_lock_is_told_apart(terminal):
    with open(terminal[1], "rb+", buffering=0) as port:
        fcntl.flock(port, fcntl.LOCK_EX)

        assert holder_of(terminal[1]) == "this very program"
