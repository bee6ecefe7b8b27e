"""What a robot is told once and keeps: its number on a shared bus, and what was measured on this very specimen.

The profile describes a kind of robot; these describe one. Each has a range and a default; whatever cannot be read is
its default. A change is written down before it counts.

    settings = Settings(Store(board.open, "settings", VERSION), profile)
    settings.change(messages.NODE, 0, 7)
"""

import struct
from array import array

from firmware.channels import Refused
from protocol import codes, messages

VERSION = 1
NODE_MAX = 126
OFFSET_MAX_DECIDEGC = 100
_HEAD = "<Bh"
_HEAD_BYTES = struct.calcsize(_HEAD)


class Settings:
    """The settings of one robot; `source` says where they come from, see SETTING_SOURCES."""

    def __init__(self, store, profile) -> None:
        self.node = 1
        self.board_offset_decidegc = 0  # added to what the thermistor reads
        self.measured_mohm = array("H", [0] * len(profile.coils))  # of each cold coil, 0: never measured
        self._store = store
        self._nominal_mohm = profile.coil.resistance_mohm
        record = store.read()
        if record is None and not store.damaged():
            self.source = messages.DEFAULTS
        else:
            self.source = messages.STORED if self._take(record) else messages.DAMAGED

    def change(self, setting: int, channel: int, value: int) -> None:
        """Set one and write all down, or raise Refused; a resistance of 0 is the profile's again."""
        low, high = self._range(setting, channel, value)
        if not low <= value <= high:
            raise Refused(codes.SETTING_LIMIT, channel, value, low if value < low else high)
        before = self.packed()
        self._set(setting, channel, value)
        self._write(before)

    def calibrate(self, measured_mohm) -> None:
        """Take a measured resistance for each coil, 0 where there is none, or raise Refused."""
        before = self.packed()
        for channel in range(len(self.measured_mohm)):
            self.measured_mohm[channel] = measured_mohm[channel] or self.measured_mohm[channel]
        self._write(before)

    def resistances(self) -> bytes:
        """Return the measured resistances as they go over the wire, two bytes each."""
        return b"".join([mohm.to_bytes(2, "little") for mohm in self.measured_mohm])

    def packed(self) -> bytes:
        """Return the settings as the store keeps them."""
        return struct.pack(_HEAD, self.node, self.board_offset_decidegc) + self.resistances()

    def _range(self, setting: int, channel: int, value: int) -> tuple:
        if setting == messages.NODE:
            return 1, NODE_MAX
        if setting == messages.BOARD_OFFSET:
            return -OFFSET_MAX_DECIDEGC, OFFSET_MAX_DECIDEGC
        if setting != messages.RESISTANCE:
            raise Refused(codes.SETTING_LIMIT, 255, setting, messages.RESISTANCE)
        if channel >= len(self.measured_mohm):
            raise Refused(codes.UNKNOWN_CHANNEL, 255, channel, len(self.measured_mohm) - 1)
        return (0, 0) if value == 0 else (self._nominal_mohm // 2, min(0xFFFF, self._nominal_mohm * 2))

    def _set(self, setting: int, channel: int, value: int) -> None:
        if setting == messages.NODE:
            self.node = value
        elif setting == messages.BOARD_OFFSET:
            self.board_offset_decidegc = value
        else:
            self.measured_mohm[channel] = value

    def _write(self, before: bytes) -> None:
        if not self._store.write(self.packed()):
            self._take(before)
            raise Refused(codes.FLASH_FAILED)
        self.source = messages.STORED

    def _take(self, record: bytes | None) -> bool:
        """Take what the store kept; False when that is none of ours, or could not have been set."""
        count = len(self.measured_mohm)
        if record is None or len(record) != _HEAD_BYTES + 2 * count:
            return False
        node, offset_decidegc, *measured_mohm = struct.unpack(_HEAD + "H" * count, record)
        kept = [(messages.NODE, 0, node), (messages.BOARD_OFFSET, 0, offset_decidegc)]
        kept += [(messages.RESISTANCE, channel, measured_mohm[channel]) for channel in range(count)]
        for setting, channel, value in kept:
            low, high = self._range(setting, channel, value)
            if not low <= value <= high:
                return False
        for setting, channel, value in kept:
            self._set(setting, channel, value)
        return True
