"""The robot's profile as the firmware uses it: labels, wiring and limits, read from JSON in flash.

The text itself is part of the dictionary that the host reads, and its CRC-32 is the robot's mark on every program.
"""

import json
from binascii import crc32


class Channel:
    """One coil: its label and the chip and output that drive it."""

    def __init__(self, label: str, chip: int, output: int) -> None:
        self.label = label
        self.chip = chip
        self.output = output


class Profile:
    """Limits and numbers of one robot; ValueError or KeyError when the text is not a profile of format 1."""

    def __init__(self, text: bytes) -> None:
        data = json.loads(text)
        if data["format"] != 1:
            raise ValueError(f"profile format {data['format']}, this firmware reads 1")
        self.crc = crc32(text)
        self.robot = data["robot"]
        self.channels = [Channel(row["label"], row["chip"], row["output"]) for row in data["channels"]]
        self.coil = Coil(data["coil"])
        self.supply = Supply(data["supply"], data["supply_mv"])
        self.lease_ms = data["session"]["lease_ms"]
        self.lease_max_ms = data["session"]["lease_max_ms"]
        self.program_bytes_max = data["program"]["bytes_max"]
        self.imu_address = data["imu"]["address"] if "imu" in data else 0  # of the attitude sensor, 0: has none


class Coil:
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
    """What the coil supply gives."""

    def __init__(self, data: dict, nominal_mv: int) -> None:
        self.nominal_mv = nominal_mv
        self.current_max_ma = data["current_max_ma"]
        self.at_once_max = data["at_once_max"]
        self.low_mv = data["low_mv"]
        self.high_mv = data["high_mv"]
        self.shunt_mohm = data["shunt_mohm"]
