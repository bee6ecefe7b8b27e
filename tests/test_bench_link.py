"""The line to a bench in this process: exact wake-ups on virtual time, and addresses that explain themselves."""

import signal

import pytest

from hil_sim.address import AddressError, parse
from hil_sim.link import SimLink, open_link
from hil_sim.worlds.costs import BOOT_US
from tests.bench_fakes import bench_of

ECHO = """
uart = UART(0, baudrate=115200, tx=Pin(0), rx=Pin(1))
while True:
    data = uart.read()
    if data:
        uart.write(data)
    time.sleep_ms(5)
"""
TALKING = """
uart = UART(0, baudrate=115200, tx=Pin(0), rx=Pin(1))
time.sleep_us(977)
uart.write(b"0123456789")
time.sleep_us(90)
uart.write(b"ab")
time.sleep_ms(1000)
"""


@pytest.fixture
def line(tmp_path):
    def open_line(main):
        links.append(SimLink(bench_of(tmp_path, main)))
        return links[-1]

    links: list[SimLink] = []
    yield open_line
    for link in links:
        link.close()


def test_what_is_written_comes_back_from_an_echo(line):
    link = line(ECHO)
    link.read(0.05)

    link.write(b"hello")

    assert link.read(0.1) == b"hello"


def test_a_read_returns_at_the_instant_a_device_write_has_arrived(line):
    link = line(TALKING)

    first = link.read(1.0)
    first_us = link.bench.clock.now_us
    second = link.read(1.0)

    written_us = BOOT_US + 1 + 1 + 3 + 977 + 3  # two pins, the port, the sleep, the write
    assert first == b"0123456789"
    assert first_us == written_us + 869  # 868.06 us
    assert second == b"ab"
    assert link.bench.clock.now_us == written_us + 1042  # queued behind the first: 1041.67 us


def test_a_read_that_times_out_ends_exactly_there_with_what_has_arrived(line):
    link = line(TALKING)

    assert link.read(0.010) == b""
    assert link.now_s() == 0.010
    assert link.read((BOOT_US + 985 + 300) / 1e6) == b"012"

    assert link.bench.clock.now_us == BOOT_US + 985 + 300


def test_a_read_until_now_gives_what_is_there_and_costs_no_time(line):
    link = line(TALKING)
    link.bench.run(0.1)

    assert link.read(0.0) == b"0123456789ab"
    assert link.now_s() == 0.1


def test_the_hosts_own_polling_changes_nothing(line):
    patient, hasty = line(ECHO), line(ECHO)
    got = [b"", b""]
    for index, (link, step_s) in enumerate(((patient, 0.5), (hasty, 0.0003))):
        link.read(0.1)
        link.write(b"hello")
        while link.now_s() < 0.5:
            got[index] += link.read(min(0.5, link.now_s() + step_s))

    assert got == [b"hello"] * 2
    assert patient.bench.trace_sha256() == hasty.bench.trace_sha256()


def test_a_bench_driven_by_hand_is_not_stopped_by_bytes(line):
    link = line(TALKING)
    link.read(0.001)

    link.bench.run(0.5)

    assert link.now_s() == 0.501


def test_ctrl_c_meets_the_host_and_never_the_firmware(line, monkeypatch):
    link = line("while True:\n  try: time.sleep_ms(1)\n  except BaseException: print('caught')")
    link.bench.clock.at(200_000, lambda: signal.raise_signal(signal.SIGINT))

    with pytest.raises(KeyboardInterrupt):
        link.read(10.0)

    assert 0.2 <= link.now_s() < 0.202
    assert link.bench.world.console == []


def test_a_closed_line_says_so_and_may_be_closed_again(line):
    link = line(ECHO)
    link.close()
    link.close()

    with pytest.raises(OSError, match="the bench is closed"):
        link.read(1.0)


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("sim:circlar", "no robot 'circlar'; did you mean circular"),
        ("sim:./none.toml", "no such robot file"),
        ("sim:circular?mu=-1", "ground.friction_ratio"),
        ("sim:circular?set=shell.mas_g:1", "shell.mas_g"),
    ],
)
def test_a_robot_that_cannot_be_built_is_refused_as_a_bad_value(address, message):
    with pytest.raises(ValueError, match=message):
        open_link(address)


def test_the_real_robot_boots_stands_still_and_answers_to_its_seed():
    hashes = []
    for seed in (1, 1, 2):
        link = open_link(f"sim:circular?seed={seed}")
        link.read(0.5)
        hashes.append((link.bench.board.unique_id, link.bench.trace_sha256()))
        assert link.bench.crashes == []
        assert abs(link.observer.observe()["travel_mm"]) < 0.01
        link.close()

    assert hashes[0] == hashes[1]
    assert hashes[0][0] != hashes[2][0]


def test_an_address_sets_numbers_of_the_robot_and_of_the_run():
    address = parse("sim:circular?slope=-10&gravity=0&mu=0.02&supply=1.5&set=shell.mass_g:6&seed=7&baud=57600")

    assert address.robot == "circular"
    assert address.overrides == {
        "ground.slope_deg": "-10",
        "ground.gravity_m_per_s2": "0",
        "ground.friction_ratio": "0.02",
        "wiring.supply_v": "1.5",
        "shell.mass_g": "6",
    }
    assert (address.seed, address.baud, address.world) == (7, 57600, "cpython")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("sim:", "no robot in the address: write sim:circular"),
        ("sim:circular?slop=1", "no option 'slop': known are slope, .*; did you mean slope"),
        ("sim:circular?slope", "option slope has no value"),
        ("sim:circular?slope=up", "slope: 'up' is not a number"),
        ("sim:circular?slope=nan", "slope: 'nan' is not a number"),
        ("sim:circular?seed=-1", "seed=-1: a whole number from 0 to 4294967295"),
        ("sim:circular?baud=1", "baud=1: a whole number from 300"),
        ("sim:circular?world=python", "no world 'python': known are cpython, micropython; did you mean cpython"),
        ("sim:circular?set=shell.mass_g", "write set=section.key_unit:number"),
    ],
)
def test_a_bad_address_is_refused_with_what_is_allowed(text, message):
    with pytest.raises(AddressError, match=message):
        parse(text)
