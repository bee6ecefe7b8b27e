"""The patrol on the core alone: what it measures while armed, what it trips on, and what it must not trip on."""

from itertools import pairwise

import pytest

from firmware.drivers.ina226 import Ina226
from protocol import codes, messages
from tests.firmware_bench import Rig

OPEN, SHORTED = 0, 2_000  # a coil's resistance with its wires [mohm]; shorted so far that the sum allows it
SLOT_MS = 320


@pytest.fixture
def rig():
    made = Rig()
    made.arm()
    return made


def outputs_seen(rig):
    """Return a list that grows by the duties of all coils at each wait of a slot."""
    seen = []
    rig.board.wait_us = lambda time_us: seen.append(tuple(rig.board.chip.duty_permille[:8]))
    return seen


def test_a_coil_is_measured_within_each_sixty_four_steps_and_its_order_goes_on(rig):
    rig.fire(0b1, duty_permille=300, hold_ms=9000)
    rig.board.coil_mohm[0] = 9_500

    rig.run(2 * SLOT_MS)

    assert rig.core.control.resistance.mohm[0] == pytest.approx(9_500 - 520, rel=0.01)
    assert rig.board.chip.duty_permille[:2] == [300, 0]


def test_of_several_coils_each_has_its_turn_and_then_none(rig):
    rig.fire(0b101, duty_permille=300, hold_ms=9000)
    seen = outputs_seen(rig)

    rig.run(7 * SLOT_MS)

    order = [duties for before, duties in pairwise(seen) if duties != before]
    first, second, none = (1000, *[0] * 7), (0, 0, 1000, *[0] * 5), (0,) * 8
    assert order[:4] in ([second, none, first, second], [none, first, second, none], [first, second, none, first])


def test_a_coil_that_is_alone_at_full_duty_is_measured_without_being_touched(rig):
    rig.fire(0b1, duty_permille=1000, hold_ms=9000)
    rig.run(5)
    writes, looks = rig.board.chip.writes, rig.board.supply.looks

    rig.run(SLOT_MS)

    assert rig.board.supply.looks == looks + 1
    assert rig.board.chip.writes == writes


def test_with_no_coil_on_nothing_is_pulsed(rig):
    looks = rig.board.supply.looks

    rig.run(1000)

    assert rig.board.supply.looks == looks


FOUND = [
    ("open", lambda board: board.coil_mohm.__setitem__(0, OPEN), codes.COIL_OPEN, 0),
    ("shorted", lambda board: board.coil_mohm.__setitem__(0, SHORTED), codes.COIL_SHORT, 0),
    ("another MOSFET stuck", lambda board: setattr(board, "stuck_mask", 0b10000), codes.EXCESS_CURRENT, 255),
    ("its own MOSFET stuck", lambda board: setattr(board, "stuck_mask", 0b1), codes.EXCESS_CURRENT, 255),
    ("chip reset", lambda board: (board.coil_mohm.__setitem__(0, OPEN), setattr(board.chip, "lost", True)),
     codes.CHIP, 255),
    ("e-stop in the slot", lambda board: setattr(board, "closed", False), codes.ESTOP, 255),
]  # fmt: skip


@pytest.mark.parametrize(("what", "break_it", "code", "channel"), FOUND, ids=[row[0] for row in FOUND])
@pytest.mark.parametrize("duty_permille", [20, 500, 950])
def test_what_breaks_while_it_is_on_trips_within_two_rounds(rig, what, break_it, code, channel, duty_permille):
    rig.fire(0b1, duty_permille=duty_permille, hold_ms=9000)
    rig.run(50)

    break_it(rig.board)
    rig.run(2 * SLOT_MS + 10)

    assert rig.core.state == messages.TRIPPED
    assert [(event.code, event.channel) for event in rig.events("tripped")] == [(code, channel)]
    assert not rig.board.powered


def test_a_stuck_mosfet_among_six_coils_at_full_duty_is_found_at_once_by_the_sum(rig):
    rig.fire(0b111111, duty_permille=400, hold_ms=9000)
    rig.run(100)

    rig.board.stuck_mask = 0b10000000
    rig.run(150)

    assert rig.core.code == codes.EXCESS_CURRENT


def test_more_mean_current_than_the_orders_explain_is_looked_at_but_is_no_fault_by_itself(rig):
    """As when coils have changed phase since they were measured: nothing flows with every output off."""
    rig.fire(0b111, duty_permille=500, hold_ms=9000)
    rig.run(100)
    looks = rig.board.supply.looks

    rig.board.coil_mohm = [7_500] * 16
    rig.run(150)

    assert rig.board.supply.looks > looks
    assert rig.core.state == messages.ARMED


@pytest.mark.parametrize("mohm", [7_200, 12_800])
@pytest.mark.parametrize("duty_permille", [10, 333, 1000])
def test_no_coil_within_thirty_percent_trips(rig, mohm, duty_permille):
    rig.fire(0b1011, duty_permille=duty_permille, hold_ms=500)

    rig.board.coil_mohm = [mohm] * 16
    rig.run(1200)

    assert rig.core.state == messages.ARMED


def test_a_supply_that_is_gone_is_told_as_that_and_not_as_an_open_coil(rig):
    rig.fire(0b1, duty_permille=300, hold_ms=9000)

    rig.board.supply.mv = 100
    rig.run(600)

    assert rig.core.code == codes.SUPPLY_LOW


def test_one_transfer_that_fails_in_a_slot_leaves_orders_and_averages_as_they_were(rig):
    rig.fire(0b1, duty_permille=300, hold_ms=9000)
    board, averaged = rig.board, []
    board.supply.average = lambda: averaged.append(rig.now_ms)
    look = board.supply.look

    def fails():
        board.supply.look = look
        raise OSError(5, "EIO")

    board.supply.look = fails
    rig.run(SLOT_MS + 10)

    assert rig.core.state == messages.ARMED
    assert averaged
    assert board.chip.duty_permille[0] == 300


def press(board):
    """Open the emergency-stop loop: no output drives a coil any more."""
    board.closed = False
    board.coil_mohm = [OPEN] * 16


def test_an_emergency_stop_in_the_middle_of_a_slot_is_told_as_that_and_not_as_an_open_coil(rig):
    rig.fire(0b1, duty_permille=300, hold_ms=9000)

    rig.board.wait_us = lambda time_us: press(rig.board)
    rig.run(2 * SLOT_MS)

    assert rig.core.code == codes.ESTOP


@pytest.mark.parametrize("figure", ["seen_mohm", "seen_ma"])
def test_one_wrong_measurement_trips_nothing(rig, figure):
    rig.fire(0b1, duty_permille=300, hold_ms=9000)
    supply = rig.board.supply
    right = getattr(supply, figure)

    def wrong():
        setattr(supply, figure, right)
        return 0x3FFFFFFF

    setattr(supply, figure, wrong)
    rig.run(3 * SLOT_MS)

    assert getattr(supply, figure) == right  # it was asked
    assert rig.core.state == messages.ARMED


def test_current_is_not_read_before_the_averages_are_whole_again(rig):
    rig.fire(0b1, duty_permille=300, hold_ms=9000)
    read = []
    rig.board.supply.current_ma = lambda: read.append(rig.now_ms) or 60
    rig.board.supply.hasten = lambda: read.append("slot")

    rig.run(2 * SLOT_MS)

    slot = read.index("slot")
    assert read[slot + 1] - read[slot - 1] >= 20


class Registers:
    """An I2C bus with one chip that keeps what is written to it."""

    def __init__(self):
        self.words = {}

    def writeto_mem(self, address, register, data):
        self.words[register] = data[0] << 8 | data[1]

    def readfrom_mem_into(self, address, register, data):
        data[:] = self.words.get(register, 0).to_bytes(2, "big")


def test_the_monitor_gives_the_resistance_that_its_registers_mean():
    bus = Registers()
    chip = Ina226(bus, 0x40, 20, 1700)
    bus.words[1], bus.words[2] = 1600, 1600  # 4 mV across 20 mohm, 2 V

    chip.look()

    assert (chip.seen_ma(), chip.seen_mv(), chip.seen_mohm()) == (200, 2000, 10_000)


def test_the_monitor_s_alert_is_set_latched_at_its_current_and_read_back():
    bus = Registers()
    chip = Ina226(bus, 0x40, 20, 1700)
    chip.begin()

    assert bus.words[7] * 2.5e-6 / 0.02 == pytest.approx(1.7, rel=1e-3)
    assert bus.words[6] == 0x8001
    assert chip.configured()
    bus.words[7] = 0
    assert not chip.configured()


def test_a_backward_or_no_current_is_an_open_coil():
    bus = Registers()
    chip = Ina226(bus, 0x40, 20, 1700)
    bus.words[1], bus.words[2] = 0xFFF0, 1600

    chip.look()

    assert chip.seen_mohm() > 1_000_000
