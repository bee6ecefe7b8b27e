"""What the robot keeps: faults and settings outlive resets and power cuts, at every instant of their writing."""

import pytest

from host.errors import LinkLost, Refused
from protocol import causes
from tests.hil_rig import HilRig

WRITE_OPERATIONS = 3  # of one record: truncate, write, close


def reconnected(rig):
    """Return the faults and settings that a new host finds after the robot has come back."""
    rig.run_alone(seconds=0.5)
    rig.robot.leave_armed()
    rig.robot = type(rig.robot)(rig.link)
    rig.robot.connect()
    return rig.robot.faults(), rig.robot.settings()


def change_all(rig, coils, mohm):
    """Change the resistance of one coil after the other."""
    for coil in coils:
        rig.robot.change("resistance_mohm", mohm, coil)


def named(faults):
    return [causes.row(fault.code).name for fault in faults]


def test_a_fresh_robot_has_no_faults_and_the_defaults(rig):
    settings = rig.robot.settings()

    assert rig.robot.faults() == []
    assert (settings.source, settings.node, settings.board_offset_decidegc) == ("defaults", 1, 0)
    assert settings.resistance_mohm == dict.fromkeys("ABCDEFGH", 0)
    assert rig.bench.board.flash.operations == 0


def test_a_fault_is_kept_with_its_coil_its_figure_and_its_state(rig):
    rig.fire("A", duty_percent=50, hold_s=0.2)
    rig.bench.board.set_estop(False)
    rig.run_alone(seconds=0.2)

    (fault,) = rig.robot.faults()

    assert (causes.row(fault.code).name, fault.coil, fault.state, fault.start) == ("F02", None, "armed", 1)
    assert fault.cause == "power-on"


def test_faults_survive_a_power_cut(rig):
    rig.fire("A", duty_percent=50, hold_s=0.2)
    rig.bench.board.set_estop(False)
    rig.run_alone(seconds=0.2)
    before = rig.robot.faults()

    rig.bench.world.power_on()

    assert reconnected(rig)[0][-1:] == before


def test_a_reset_in_mid_pulse_is_kept_with_its_cause(rig):
    rig.fire("A", duty_percent=50, hold_s=0.5)
    rig.happens("hang")

    faults, _ = reconnected(rig)

    assert named(faults) == ["F12"]
    assert (faults[0].cause, faults[0].state) == ("reset", "boot")


def test_faults_are_forgotten_when_they_are_cleared(rig):
    rig.bench.board.set_estop(False)
    rig.run_alone(seconds=0.2)
    rig.robot.clear_faults()

    assert rig.robot.faults() == []
    rig.bench.board.set_estop(True)
    rig.bench.world.power_on()
    assert reconnected(rig)[0] == []


def test_the_flash_is_not_written_while_the_robot_is_armed(rig):
    rig.robot.arm()
    for order in (lambda: rig.robot.change("node", 7), rig.robot.clear_faults):
        with pytest.raises(Refused) as refused:
            order()
        assert refused.value.row.name == "R22"

    assert rig.bench.board.flash.operations == 0
    rig.robot.disarm()
    rig.robot.change("node", 7)
    assert rig.robot.settings().node == 7


def test_the_fault_of_an_armed_robot_is_written_down_once_all_is_off(rig):
    rig.fire("A", duty_percent=50, hold_s=2)
    assert rig.bench.board.flash.operations == 0
    rig.bench.board.set_estop(False)
    rig.run_alone(seconds=0.003)
    assert not rig.bench.any_coil_on
    rig.run_alone(seconds=0.1)

    assert rig.bench.board.flash.operations == WRITE_OPERATIONS


def test_an_offset_moves_what_the_board_reads_and_stays(rig):
    before = rig.robot.status().board_degc
    rig.robot.change("board_offset_decidegc", -15)
    rig.run(seconds=1)
    assert rig.robot.status().board_degc == pytest.approx(before - 1.5, abs=0.15)  # one step of the converter

    rig.bench.world.power_on()
    reconnected(rig)
    assert rig.robot.status().board_degc == pytest.approx(before - 1.5, abs=0.15)


def test_settings_that_are_damaged_are_the_defaults_and_told():
    rig = HilRig()
    rig.robot.change("node", 9)
    for path in ("settings.0", "settings.1"):
        rig.bench.board.flash.store(path, b"noise")
    rig.bench.world.power_on()

    faults, settings = reconnected(rig)

    assert (settings.source, settings.node) == ("damaged", 1)
    assert named(faults) == ["F23"]
    rig.robot.arm()  # told, not a trip
    rig.link.close()


@pytest.mark.parametrize("operation", range(1, 2 * WRITE_OPERATIONS + 1))
def test_a_power_cut_in_any_write_of_settings_leaves_those_before_or_after(operation):
    rig = HilRig()
    for coil, mohm in (("A", 9100), ("B", 9200)):
        rig.robot.change("resistance_mohm", mohm, coil)
    rig.bench.board.flash.cut_at = operation
    with pytest.raises(LinkLost):
        change_all(rig, "AB", 9900)

    settings = reconnected(rig)[1]

    stages = [(9100, 9200), (9900, 9200), (9900, 9900)]
    whole = (operation - 1) // WRITE_OPERATIONS
    assert (settings.resistance_mohm["A"], settings.resistance_mohm["B"]) in stages[whole : whole + 2]
    assert settings.source == "stored"
    rig.robot.change("node", 3)
    assert rig.robot.settings().node == 3
    rig.link.close()


@pytest.mark.parametrize("operation", range(1, WRITE_OPERATIONS + 1))
def test_a_power_cut_in_any_write_of_faults_loses_at_most_the_newest(operation):
    rig = HilRig()
    rig.bench.board.set_estop(False)
    rig.run_alone(seconds=0.2)
    rig.bench.board.set_estop(True)
    rig.robot.clear()
    first = rig.robot.faults()
    rig.run_alone(seconds=2.5)  # faults are written down at most every 2 s

    rig.bench.board.flash.cut_at = operation
    rig.bench.board.set_estop(False)
    rig.run_alone(seconds=0.3)
    rig.bench.board.set_estop(True)
    faults, _ = reconnected(rig)

    assert faults[-1:] == first
    assert named(faults) in (["F02"], ["F02", "F02"], ["F02", "F02", "F02"])
    assert not rig.bench.any_coil_on
    rig.link.close()


def test_calibration_keeps_what_each_coil_measures_cold(rig):
    true_mohm = dict(zip("ABCDEFGH", 1000 * rig.bench.plant.resistance, strict=True))

    rig.robot.calibrate(without=["C"])

    measured = rig.robot.settings().resistance_mohm
    assert measured.pop("C") == 0
    assert measured == pytest.approx({coil: true_mohm[coil] for coil in measured}, rel=0.01)
    assert rig.robot.status().state == "idle"
    assert not rig.bench.board.powered
    rig.bench.world.power_on()
    assert reconnected(rig)[1].resistance_mohm["A"] == measured["A"]


def test_a_coil_that_is_warm_or_broken_is_not_calibrated(rig):
    rig.fire("A", duty_percent=60, hold_s=0.5)
    rig.run(seconds=0.6)
    assert refused(rig.robot.calibrate) == ("R22", None)
    rig.robot.disarm()
    assert refused(rig.robot.calibrate) == ("R24", "A")
    rig.bench.break_coil("D")
    assert refused(lambda: rig.robot.calibrate(["A"])) == ("F18", "D")

    assert not rig.bench.board.powered
    assert not any(rig.robot.settings().resistance_mohm.values())


def test_what_the_self_test_finds_is_kept_as_well(rig):
    rig.bench.break_coil("D")
    assert refused(rig.robot.arm) == ("F18", "D")
    rig.run_alone(seconds=0.1)
    rig.bench.world.power_on()

    (fault,) = reconnected(rig)[0]

    assert (causes.row(fault.code).name, fault.coil, fault.state) == ("F18", "D", "idle")


@pytest.mark.parametrize("operation", range(1, WRITE_OPERATIONS + 1))
def test_a_power_cut_in_the_writing_of_a_calibration_leaves_all_of_it_or_nothing(operation):
    rig = HilRig()
    rig.bench.board.flash.cut_at = operation
    with pytest.raises(LinkLost):
        rig.robot.calibrate()

    measured = reconnected(rig)[1].resistance_mohm.values()

    assert all(measured) or not any(measured)
    assert not rig.bench.any_coil_on
    rig.link.close()


def refused(order):
    """Return code and coil with which an order is refused."""
    with pytest.raises(Refused) as caught:
        order()
    return caught.value.row.name, caught.value.coil


def test_the_slowest_erase_of_the_sheet_does_not_reset_the_robot(monkeypatch):
    monkeypatch.setattr("hil_sim.devices.flash.ERASE_US", 400_000)
    rig = HilRig("sim:circular?body=still")
    rig.happens("estop-open")
    rig.run_alone(seconds=1)
    assert rig.bench.world.resets == 0
    assert named(rig.robot.faults()) == ["F02"]

    rig.happens("hang")
    rig.run_alone(seconds=0.25)

    assert rig.bench.world.resets == 1  # the watchdog has its short period again
    rig.link.close()
