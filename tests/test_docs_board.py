"""The board on paper is the board that the firmware drives and the bench simulates."""

import json
import re
from pathlib import Path

import pytest

from docs import board, hardwarepage, schematic
from hil_sim import board as bench
from hil_sim.devices.mcp3208 import REFERENCE_V, STEPS

ROOT = Path(__file__).parents[1]
PICO = board.constants()
NETS = {number: net for number, net, _ in board.PINS}


@pytest.mark.parametrize(
    "name", ["PWR_EN", "HEARTBEAT", "SDA", "SCL", "ESTOP_SENSE", "ALERT", "SERVOS", "MISO", "CAN_SELECT", "SCK", "MOSI",
    "CAN_INTERRUPT", "MONITOR", "WARM", "ADC_MISO", "ADC_SELECTS", "ADC_SCK", "ADC_MOSI"],
)  # fmt: skip
def test_the_bench_is_wired_to_the_pins_that_the_firmware_uses(name):
    assert getattr(bench, name) == PICO[name]


def test_the_thermistor_hangs_on_the_analogue_input_of_its_pin():
    assert PICO["THERMISTOR"] - 26 == bench.THERMISTOR_CHANNEL


def test_boot_and_main_repeat_the_pins_and_addresses_of_the_board():
    boot = (ROOT / "firmware/boot.py").read_text(encoding="utf-8")
    start = (ROOT / "firmware/start.py").read_text(encoding="utf-8")

    off, bus = (
        re.findall(r"Pin\((\d+), Pin.OUT, value=0\)", boot),
        re.search(r"scl=Pin\((\d+)\), sda=Pin\((\d+)\)", boot),
    )
    assert [int(pin) for pin in off] == [PICO["PWR_EN"], PICO["HEARTBEAT"]]
    assert bus is not None
    assert (int(bus[1]), int(bus[2])) == (PICO["SCL"], PICO["SDA"])
    assert f"({', '.join(f'0x{chip:02x}' for chip in bench.PWM_CHIPS)})" in boot
    assert f"STRAP = {PICO['STRAP']}" in start


def test_no_pin_is_wired_twice_and_every_pin_of_the_firmware_is():
    pins = [number for number, _, _ in board.PINS]
    named = {"TX", "RX", "STRAP", "THERMISTOR", "PWR_EN", "HEARTBEAT", "SDA", "SCL", "ESTOP_SENSE", "ALERT", "MISO"}
    named |= {"CAN_SELECT", "SCK", "MOSI", "CAN_INTERRUPT", "WARM", "ADC_MISO", "ADC_SCK", "ADC_MOSI"}

    assert len(set(pins)) == len(pins)
    assert set(pins) == {PICO[name] for name in named} | set(PICO["SERVOS"]) | set(PICO["ADC_SELECTS"])


def test_every_net_of_the_processor_is_drawn_at_another_end_too():
    drawn = re.findall(r"<tspan[^>]*>([^<]*)</tspan>", schematic.svg())

    away = {"TX", "RX", "SERVO2"}  # on connectors
    lonely = [net for net in NETS.values() if net not in away and drawn.count(net) < 2]
    assert lonely == []


def test_the_drawing_is_the_same_each_time():
    assert schematic.svg() == schematic.svg()


@pytest.mark.parametrize("name", ["circular", "sphere-a", "sphere-b"])
def test_each_coil_of_a_robot_has_a_gate_of_its_own(name):
    profile = json.loads((ROOT / f"firmware/robots/{name}.json").read_text(encoding="utf-8"))

    gates = re.findall(r" G(\d+)", hardwarepage.wiring(profile))

    assert len(set(gates)) == len(profile["channels"]) <= 22


def test_a_robot_below_the_mosfets_voltage_gets_a_relay():
    profile = json.loads((ROOT / "firmware/robots/circular.json").read_text(encoding="utf-8"))

    row = hardwarepage.power(profile)

    assert row == ("circular", "2", "199", "6", "1194", "1500", "2.4", "30", "1.6", "K1")


@pytest.mark.parametrize("name", ["fingers", "fingers-experiment"])
def test_each_joint_of_a_robot_is_wired_as_the_board_is(name):
    profile = json.loads((ROOT / f"firmware/robots/{name}.json").read_text(encoding="utf-8"))

    assert hardwarepage.wiring(profile) == "R SERVO0, current CH0, position CH2, L SERVO1, current CH1, position CH3"
    assert profile["camera"]["address"] == bench.CAMERA
    assert {channel["pin"] for channel in profile["channels"]} <= set(bench.SERVOS)


def test_the_supply_of_servos_is_laid_out_for_their_stall():
    profile = json.loads((ROOT / "firmware/robots/fingers.json").read_text(encoding="utf-8"))

    row = hardwarepage.power(profile)

    assert row == ("fingers", "6", "2400", "2", "4800", "6000", "28.8", "60", "6.3", "K1")


def test_a_count_of_the_converter_is_the_current_that_the_amplifier_makes_it():
    profile = json.loads((ROOT / "firmware/robots/fingers.json").read_text(encoding="utf-8"))
    shunt_ohm, gain = 0.010, 50  # as drawn

    ua = REFERENCE_V / STEPS / (shunt_ohm * gain) * 1e6

    assert profile["servo"]["ua_per_count"] == round(ua)


PRESS = {
    "channels": [{"label": "P", "kind": "servo", "pin": 8, "current": 0, "position": 1}],
    "load": {"input": 8},
    "cells": [{"label": "C1", "input": 2}, {"label": "C2", "input": 3}],
}


def test_load_cell_and_force_cells_are_wired_to_inputs_of_the_converters():
    assert hardwarepage.wiring(PRESS) == "P SERVO0, current CH0, position CH1, load cell CH8, C1 CH2, C2 CH3"
