"""Finding robots: serial ports with a device, benches whose process lives, and nothing else."""

import json
import os
from types import SimpleNamespace

import pytest

from host.ports import benches, places, runtime_folder, serial_ports

ENDED = 2**22 + 1  # beyond the largest process number


def announce(folder, pid: int, **fields) -> None:
    (folder / f"{pid}.json").write_text(json.dumps({"pid": pid, **fields}))


@pytest.fixture
def listed(monkeypatch):
    """Ports as the system would list them."""
    ports = [
        SimpleNamespace(device="/dev/ttyACM0", hwid="USB", vid=0x2E8A, serial_number="E660", description="Pico"),
        SimpleNamespace(device="/dev/ttyS0", hwid="n/a", vid=None, serial_number=None, description="ttyS0"),
    ]
    monkeypatch.setattr("serial.tools.list_ports.comports", lambda: ports)
    monkeypatch.setattr("host.ports.sorted", lambda ports: ports, raising=False)


def test_a_port_is_listed_with_what_is_known_of_its_device(listed):
    (place,) = serial_ports()

    assert place.address == "/dev/ttyACM0"
    assert place.about == "Pico, Raspberry Pi, serial number E660"


def test_a_running_bench_is_listed_with_each_of_its_addresses(tmp_path):
    announce(tmp_path, os.getpid(), robot="circular", pty="/dev/pts/7", link="/home/a/L", tcp="socket://127.0.0.1:7000")

    found = list(benches(tmp_path))

    assert [place.address for place in found] == ["/home/a/L", "socket://127.0.0.1:7000"]
    assert found[0].about == f"circular, process {os.getpid()}"


def test_a_bench_of_several_robots_is_listed_with_all_their_lines(tmp_path):
    ptys, on_can = {"1": "/dev/pts/7", "2": "/dev/pts/8"}, ["can:slcan:/dev/pts/9@1", "can:slcan:/dev/pts/9@2"]
    announce(tmp_path, os.getpid(), robot="circular@1,sphere-b@2", pty="/dev/pts/7", ptys=ptys, can=on_can)

    found = [place.address for place in benches(tmp_path)]

    assert found == ["/dev/pts/7", "/dev/pts/8", *on_can]


def test_a_bench_without_a_link_is_listed_by_its_port(tmp_path):
    announce(tmp_path, os.getpid(), robot="circular", pty="/dev/pts/7", link=None)

    assert [place.address for place in benches(tmp_path)] == ["/dev/pts/7"]


def test_a_bench_that_has_ended_is_passed_over(tmp_path):
    announce(tmp_path, ENDED, robot="circular", pty="/dev/pts/7")

    assert list(benches(tmp_path)) == []


@pytest.mark.parametrize("text", ["", "{", "[]", '{"pid": "x"}', '{"robot": "circular"}'])
def test_an_announcement_that_cannot_be_read_is_passed_over(tmp_path, text):
    (tmp_path / "1.json").write_text(text)

    assert list(benches(tmp_path)) == []


def test_no_folder_means_no_bench(monkeypatch, tmp_path, listed):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))

    assert [place.kind for place in places()] == ["serial"]
    assert runtime_folder() == tmp_path / "softrig"
