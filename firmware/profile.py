"""The robot's profile as the firmware uses it: labels, wiring and limits, read from JSON in flash.

The text itself is part of the dictionary that the host reads, and its CRC-32 is the robot's mark on every program.
"""

import json
from binascii import crc32

GAIN_MAX_PERMILLE_PER_S = 30_000  # beyond it the loop's integers would not stay small
SPAN_MAX_CENTI = 36_000
SPREAD_MAX = (1 << 30) // 10  # hundredths of a span times microseconds between its pulses: their product stays small
SLEW_MAX_CENTI_PER_S = 1_000_000
HOLD_MAX_MS = 1 << 24
UA_PER_COUNT_MAX = 16_000  # 4095 counts are told as 65535 mA at most
COUNTS_MAX = 4095
UNITS = ("deg", "mm")  # of a joint; its positions are counted in hundredths of it
EDGE_COUNTS = 8  # at either end of the converter's range: what a load cell reads there is no force
FORCE_MAX_MN = 100_000
PRESSURE_MAX_PA = 32_767  # a condition compares no more
CELLS_MAX = 14
INPUTS = 16  # of both converters
PRESS_GAIN_MAX = 10_000  # um/s for a newton: beyond it the loop's integers would not stay small
RESET_MAX = 20_000
SMOOTH_MIN_MS = 20  # no less than a late control step
WAY_MIN_COUNTS = 1000  # of a potentiometer: less would make angles of its noise
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
        self.servo = ServoLimits(data["servo"]) if self.joints else None
        self.camera = CameraLimits(data["camera"]) if "camera" in data else None
        self.orient = OrientLimits(data["orient"]) if "orient" in data else None
        if len(self.joints) < (2 if self.orient else 1 if self.camera else 0):
            raise ValueError("a camera is of a robot with joints, and the loop of one with two joints")
        self.load = LoadLimits(data["load"]) if "load" in data else None
        self.press = PressLimits(data["press"]) if "press" in data else None
        self.cells = [row["input"] for row in data.get("cells", ())]
        self.cell_full_pa = data["cell"]["full_pa"] if self.cells else 0
        self._check_inputs()
        self._check_forces()
        self.supply = Supply(data["supply"], data["supply_mv"])
        self.lease_ms = data["session"]["lease_ms"]
        self.lease_max_ms = data["session"]["lease_max_ms"]
        self.program_bytes_max = data["program"]["bytes_max"]
        self.imu_address = data["imu"]["address"] if "imu" in data else 0  # of the attitude sensor, 0: has none

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
        if not self.joints and (self.load or self.cells):
            raise ValueError("load cell and force cells are of a robot with joints")
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


class ServoLimits:
    """What a joint may be told, and how its servo and the converter read."""

    def __init__(self, data: dict) -> None:
        self.unit = data["unit"]
        self.least_centi = data["least_centi"]
        self.most_centi = data["most_centi"]
        self.slew_centi_per_s = data["slew_centi_per_s"]
        self.hold_max_ms = data["hold_max_ms"]
        self.stall_ma = data["stall_ma"]
        self.stall_ms = data["stall_ms"]
        self.astray_centi = data["astray_centi"]
        self.astray_ms = data["astray_ms"]
        self.pulse_hz = data["pulse_hz"]
        self.ua_per_count = data["ua_per_count"]
        self.low_counts = data["low_counts"]
        self.high_counts = data["high_counts"]
        self._low_ns = data["low_us"] * 1000
        self._width_us = data["high_us"] - data["low_us"]
        self._span_centi = data["span_centi"]
        self._check(data)

    def width_ns(self, centi: int, fine: int = 0) -> int:
        """Return the width of the pulse that sends a servo to a position and so many sixteenths of a hundredth beyond.

        Its span lies half on either side of 0.
        """
        from_low = centi + self._span_centi // 2
        beyond_ns = fine * self._width_us * 125 // (2 * self._span_centi)
        return self._low_ns + from_low * self._width_us * 10 // (self._span_centi // 100) + beyond_ns

    def position_centi(self, counts: int) -> int:
        """Return the position at which the potentiometer reads so many counts, to the nearest hundredth."""
        way = self.high_counts - self.low_counts
        return ((counts - self.low_counts) * self._span_centi + way // 2) // way - self._span_centi // 2

    def _check(self, data: dict) -> None:
        """Raise ValueError where a number on the way would be too large for its place, or a pulse no pulse."""
        half_centi = self._span_centi // 2
        for name, fits in (
            ("unit", self.unit in UNITS),
            ("span_centi", 0 < self._span_centi <= SPAN_MAX_CENTI and self._span_centi % 100 == 0),
            ("least_centi", -half_centi <= self.least_centi < self.most_centi),
            ("most_centi", self.most_centi <= half_centi),
            ("slew_centi_per_s", 0 < self.slew_centi_per_s <= SLEW_MAX_CENTI_PER_S),
            ("hold_max_ms", 0 < self.hold_max_ms <= HOLD_MAX_MS),
            ("pulse_hz", self.pulse_hz > 0),
            ("high_us", 0 < data["low_us"] < data["high_us"] and data["high_us"] * self.pulse_hz < 1_000_000),
            ("high_us", self._span_centi * self._width_us < SPREAD_MAX),
            ("ua_per_count", 0 < self.ua_per_count <= UA_PER_COUNT_MAX),
            ("high_counts", 0 <= self.low_counts <= self.high_counts - WAY_MIN_COUNTS <= COUNTS_MAX - WAY_MIN_COUNTS),
        ):
            if not fits:
                raise ValueError(f"servo: {name} does not go with the others")


class CameraLimits:
    """Where the camera is, and how old its word may be."""

    def __init__(self, data: dict) -> None:
        self.address = data["address"]
        self.stale_ms = data["stale_ms"]


class OrientLimits:
    """How the object's angle is regulated."""

    def __init__(self, data: dict) -> None:
        self.gain_permille_per_s = data["gain_permille_per_s"]
        if not 0 < self.gain_permille_per_s <= GAIN_MAX_PERMILLE_PER_S:
            raise ValueError(f"gain {self.gain_permille_per_s} permille/s, 1 to {GAIN_MAX_PERMILLE_PER_S}")
        self.swing_max_centideg = data["swing_max_centideg"]


class LoadLimits:
    """Where the load cell is read, what its counts mean, and what it may bear."""

    def __init__(self, data: dict) -> None:
        self.input = data["input"]
        self.most_mn = data["most_mn"]
        self.trip_mn = data["trip_mn"]
        self._zero_counts = data["zero_counts"]
        self._full_mn = data["full_mn"]
        if not 0 < self._full_mn <= FORCE_MAX_MN or not EDGE_COUNTS < self._zero_counts < COUNTS_MAX - EDGE_COUNTS:
            raise ValueError(f"load: zero_counts or full_mn (at most {FORCE_MAX_MN}) is none of a converter")
        if not 0 < self.most_mn <= self.trip_mn < self.force_mn(COUNTS_MAX - EDGE_COUNTS):
            raise ValueError("load: most_mn, trip_mn and the end of its range come one after the other")

    def force_mn(self, counts: int) -> int:
        """Return the force at which the converter reads so many counts."""
        return (counts - self._zero_counts) * self._full_mn >> 12


class PressLimits:
    """How the force of a press is regulated."""

    def __init__(self, data: dict) -> None:
        self.gain_um_per_s_per_n = data["gain_um_per_s_per_n"]
        self.reset_permille_per_s = data["reset_permille_per_s"]
        self.smooth_ms = data["smooth_ms"]
        self.approach_um_per_s = data["approach_um_per_s"]
        self.touch_mn = data["touch_mn"]
        if not 0 < self.gain_um_per_s_per_n <= PRESS_GAIN_MAX or not 0 <= self.reset_permille_per_s <= RESET_MAX:
            raise ValueError(f"press: a gain of 1 to {PRESS_GAIN_MAX} and a reset of 0 to {RESET_MAX}")
        if not SMOOTH_MIN_MS <= self.smooth_ms <= 1000 or self.approach_um_per_s <= 0:
            raise ValueError(f"press: smoothed over {SMOOTH_MIN_MS} to 1000 ms, and it approaches at some speed")


class Supply:
    """What the supply of coils and joints gives."""

    def __init__(self, data: dict, nominal_mv: int) -> None:
        self.nominal_mv = nominal_mv
        self.current_max_ma = data["current_max_ma"]
        self.at_once_max = data["at_once_max"]
        self.low_mv = data["low_mv"]
        self.high_mv = data["high_mv"]
        self.shunt_mohm = data["shunt_mohm"]
