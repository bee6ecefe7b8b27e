"""The robot's profile as the firmware uses it: labels, wiring and limits, read from JSON in flash.

The text itself is part of the dictionary that the host reads, and its CRC-32 is the robot's mark on every program.
"""

import json
from binascii import crc32

PRESSURE_MAX_PA = 32_767  # a condition compares no more
CELLS_MAX = 14
INPUTS = 16  # of both converters
# What stands for the coil of a robot that has none: no order reaches it.
NO_COIL = {
    "duty_max_permille": 0, "hold_max_ms": 0, "on_max_ms": 0, "rest_ms": 0, "heat_budget_mj": 1, "heat_leak_ms": 1,
    "trip_degc": 0, "resistance_mohm": 1000, "wiring_mohm": 0, "heat_capacity_uj_per_k": 1, "loss_uw_per_k": 0,
    "latent_uj": 0, "as_degc": 60, "af_degc": 70, "ms_degc": 50, "mf_degc": 40,
}  # fmt: skip


class Coil:
    """One coil: its label and the chip and output that drive it."""

    def __init__(self, row: dict) -> None:
        self.label = row["label"]
        self.chip = row["chip"]
        self.output = row["output"]


class Joint:
    """One joint: its label, the pin of its servo's pulses, and the converter's inputs for its current and position."""

    def __init__(self, row: dict) -> None:
        self.label = row["label"]
        self.pin = row["pin"]
        self.current = row["current"]
        self.position = row["position"]


class Profile:
    """Limits and numbers of one robot; ValueError or KeyError when the text is not a profile of format 1.

    Channels are numbered as they stand in the profile, the coils before the joints.
    """

    def __init__(self, text: bytes) -> None:
        data = json.loads(text)
        if data["format"] != 1:
            raise ValueError(f"profile format {data['format']}, this firmware reads 1")
        self.crc = crc32(text)
        self.robot = data["robot"]
        rows = data["channels"]
        self.coils = [Coil(row) for row in rows if row["kind"] == "sma"]
        self.joints = [Joint(row) for row in rows if row["kind"] == "servo"]
        if [row["kind"] for row in rows] != ["sma"] * len(self.coils) + ["servo"] * len(self.joints):
            raise ValueError("channels: coils first, then joints, and no other kind")
        self.coil = CoilLimits(data["coil"] if self.coils else NO_COIL)
        self.servo = self.camera = self.orient = self.load = self.press = None
        self.cells, self.cell_full_pa = [], 0
        if self.joints:
            self._read_joints(data)
        elif "camera" in data or "orient" in data or "load" in data or "press" in data or "cells" in data:
            raise ValueError("camera, load cell and force cells are of a robot with joints")
        self.supply = Supply(data["supply"], data["supply_mv"])
        self.lease_ms = data["session"]["lease_ms"]
        self.lease_max_ms = data["session"]["lease_max_ms"]
        self.program_bytes_max = data["program"]["bytes_max"]
        self.imu_address = data["imu"]["address"] if "imu" in data else 0  # of the attitude sensor, 0: has none

    def _read_joints(self, data: dict) -> None:
        """Read what only a robot with joints has; loaded only here, as others do without."""
        from firmware.jointlimits import CameraLimits, LoadLimits, OrientLimits, PressLimits, ServoLimits  # noqa: PLC0415

        self.servo = ServoLimits(data["servo"])
        self.camera = CameraLimits(data["camera"]) if "camera" in data else None
        self.orient = OrientLimits(data["orient"]) if "orient" in data else None
        if self.orient and len(self.joints) < 2:
            raise ValueError("the loop of a camera is of a robot with two joints")
        self.load = LoadLimits(data["load"]) if "load" in data else None
        self.press = PressLimits(data["press"]) if "press" in data else None
        self.cells = [row["input"] for row in data.get("cells", ())]
        self.cell_full_pa = data["cell"]["full_pa"] if self.cells else 0
        self._check_inputs()
        self._check_forces()

    def _check_inputs(self) -> None:
        """Raise ValueError for an input that no converter has, or that two things are read at."""
        inputs = self.cells + ([self.load.input] if self.load else [])
        for joint in self.joints:
            inputs += [joint.current, joint.position]
        for number in inputs:
            if not 0 <= number < INPUTS or inputs.count(number) > 1:
                raise ValueError(f"input {number}: one of 0 to {INPUTS - 1} for each thing that is read")

    def _check_forces(self) -> None:
        """Raise ValueError for cells that cannot be read, or a press that is none."""
        if self.press and not (self.load and len(self.joints) == 1 and self.servo.unit == "mm"):
            raise ValueError("a press has a load cell and one joint, in mm")
        if self.press and not 0 < self.press.touch_mn < self.load.most_mn:
            raise ValueError("press: touch_mn is more than no force and less than the most that may be asked for")
        if not 0 <= self.cell_full_pa <= PRESSURE_MAX_PA or len(self.cells) > CELLS_MAX:
            raise ValueError(f"at most {CELLS_MAX} cells of {PRESSURE_MAX_PA} Pa")


class CoilLimits:
    """What a coil bears, and the numbers of its thermal estimate."""

    def __init__(self, data: dict) -> None:
        self.duty_max_permille = data["duty_max_permille"]
        self.hold_max_ms = data["hold_max_ms"]
        self.on_max_ms = data["on_max_ms"]
        self.rest_ms = data["rest_ms"]
        self.heat_budget_mj = data["heat_budget_mj"]
        self.heat_leak_ms = data["heat_leak_ms"]
        self.trip_decidegc = data["trip_degc"] * 10
        self.resistance_mohm = data["resistance_mohm"]
        self.wiring_mohm = data["wiring_mohm"]
        self.heat_capacity_uj_per_k = data["heat_capacity_uj_per_k"]
        self.loss_uw_per_k = data["loss_uw_per_k"]
        self.latent_uj = data["latent_uj"]
        self.as_millidegc = data["as_degc"] * 1000
        self.af_millidegc = data["af_degc"] * 1000
        self.ms_millidegc = data["ms_degc"] * 1000
        self.mf_millidegc = data["mf_degc"] * 1000
        # of austenite against martensite: 0.92 measured on BMX150 (scientific.net/MSF.978.421)
        self.austenite_permille = data.get("austenite_permille", 920)


class Supply:
    """What the supply of coils and joints gives."""

    def __init__(self, data: dict, nominal_mv: int) -> None:
        self.nominal_mv = nominal_mv
        self.current_max_ma = data["current_max_ma"]
        self.at_once_max = data["at_once_max"]
        self.low_mv = data["low_mv"]
        self.high_mv = data["high_mv"]
        self.shunt_mohm = data["shunt_mohm"]
