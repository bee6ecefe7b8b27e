"""A robot's profile as the robot itself sent it: labels, groups and limits.

The profile is the last part of the dictionary that every robot gives to every host; it is the authority on what may
be asked of the robot. Values keep the units of their names.

    profile = read_profile(text)
    mask = profile.coil_mask(["A", "C"])
"""

from __future__ import annotations

import json
from binascii import crc32
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from host.errors import BadRequest, Mismatch
from host.limits import (
    CameraLimits,
    Cell,
    CellLimits,
    Coil,
    CoilLimits,
    Joint,
    LoadLimits,
    OrientLimits,
    PressLimits,
    ProgramLimits,
    ServoLimits,
    SessionLimits,
    SupplyLimits,
)
from host.sections import channel, optional, section, servo

MASK_BITS = 32


class Parts(NamedTuple):
    """What a robot has, by label: its channels in the order of the masks, those that are coils, those that are joints.

    `cameras` is 1 where a camera sees how the object lies, else 0; so is `loads` where there is a load cell. `cells`
    are the force cells; `unit` is that of the joints' positions, "deg" or "mm".
    """

    channels: tuple[str, ...] = ()
    coils: tuple[str, ...] = ()
    joints: tuple[str, ...] = ()
    cameras: int = 0
    loads: int = 0
    cells: tuple[str, ...] = ()
    unit: str = "deg"

    def kind(self, label: str | None) -> str:
        """Return what is behind a label: `coil` or `joint`."""
        return "joint" if label in self.joints else "coil"


@dataclass(frozen=True)
class Profile:
    """A robot: its channels in the order of the bit masks, its groups and its limits.

    What a robot does not have stands as None; `coil` and `servo` are its limits where it must have them.
    """

    robot: str
    supply_mv: int
    channels: tuple[Coil | Joint, ...]
    groups: dict[str, tuple[str, ...]]
    coil_limits: CoilLimits | None
    servo_limits: ServoLimits | None
    supply: SupplyLimits
    session: SessionLimits
    program: ProgramLimits
    crc: int
    imu: dict[str, int] | None = None  # address of the attitude sensor, where there is one
    camera: CameraLimits | None = None
    orient: OrientLimits | None = None
    load: LoadLimits | None = None
    press: PressLimits | None = None
    cells: tuple[Cell, ...] = ()
    cell: CellLimits | None = None

    @property
    def coil(self) -> CoilLimits:
        """Return the limits of the coils; BadRequest on a robot without coils."""
        if self.coil_limits is None:
            raise BadRequest(f"{self.robot} has no coils")
        return self.coil_limits

    @property
    def servo(self) -> ServoLimits:
        """Return the limits of the joints; BadRequest on a robot without joints."""
        if self.servo_limits is None:
            raise BadRequest(f"{self.robot} has no joints")
        return self.servo_limits

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Return the labels of all channels, in the order of the masks."""
        return tuple(channel.label for channel in self.channels)

    @cached_property
    def coil_labels(self) -> tuple[str, ...]:
        """Return the labels of the coils, in the order of what the robot tells of each coil."""
        return tuple(channel.label for channel in self.channels if isinstance(channel, Coil))

    @cached_property
    def joint_labels(self) -> tuple[str, ...]:
        """Return the labels of the joints, in the order of what the robot tells of each joint."""
        return tuple(channel.label for channel in self.channels if isinstance(channel, Joint))

    @cached_property
    def cell_labels(self) -> tuple[str, ...]:
        """Return the labels of the force cells, in the order of what the robot tells of each."""
        return tuple(cell.label for cell in self.cells)

    @property
    def unit(self) -> str:
        """Return the unit of the joints' positions: `deg`, which a robot without joints has too, or `mm`."""
        return self.servo_limits.unit if self.servo_limits else "deg"

    @cached_property
    def parts(self) -> Parts:
        """Return what the robot has, by label."""
        return Parts(
            self.labels,
            self.coil_labels,
            self.joint_labels,
            cameras=int(self.camera is not None),
            loads=int(self.load is not None),
            cells=self.cell_labels,
            unit=self.unit,
        )

    def mask(self, names: Iterable[str]) -> int:
        """Return the bit mask of these labels or groups; BadRequest lists the known ones."""
        mask = 0
        for name in names:
            for label in self.groups.get(name, (name,)):
                mask |= 1 << self._index(label)
        return mask

    def coil_mask(self, names: Iterable[str]) -> int:
        """Return the bit mask of these coils or groups; BadRequest names one that is a joint."""
        mask = self.mask(names)
        for label in self.named(mask):
            if label in self.joint_labels:
                raise BadRequest(f"{label} is a joint, no coil: `softrig move {label} --to 1{self.unit}` moves it")
        return mask

    def joint_mask(self, names: Iterable[str]) -> int:
        """Return the bit mask of these joints or groups; BadRequest names one that is a coil."""
        mask = self.mask(names)
        for label in self.named(mask):
            if label in self.coil_labels:
                raise BadRequest(f"{label} is a coil, no joint: `softrig fire {label}` heats it")
        return mask

    def cell_mask(self, names: Iterable[str]) -> int:
        """Return the bit mask of these force cells, in their own order; BadRequest lists the known ones."""
        mask = 0
        for name in names:
            if name not in self.cell_labels:
                known = f"it has {' '.join(self.cell_labels)}" if self.cells else "it has none"
                raise BadRequest(f"no force cell {_shown(name)} on {self.robot}: {known}")
            mask |= 1 << self.cell_labels.index(name)
        return mask

    def named(self, mask: int) -> tuple[str, ...]:
        """Return the labels whose bits are set."""
        return tuple(label for i, label in enumerate(self.labels) if mask >> i & 1)

    def label(self, channel: int) -> str | None:
        """Return the label of a channel number, or None when it names no channel."""
        return self.labels[channel] if channel < len(self.channels) else None

    def _index(self, label: str) -> int:
        if label not in self.labels:
            groups = f", groups {' '.join(self.groups)}" if self.groups else ""
            what = "channel" if self.coil_labels and self.joint_labels else "joint" if self.joint_labels else "coil"
            raise BadRequest(f"no {what} {_shown(label)} on {self.robot}: it has {' '.join(self.labels)}{groups}")
        return self.labels.index(label)


def _shown(label: str) -> str:
    """Return a label as it can be printed."""
    return label if label.isprintable() and label.strip() else repr(label)


def read_profile(text: bytes) -> Profile:
    """Return the profile that stands in `text`; Mismatch when a value that this version needs is not there."""
    try:
        data = json.loads(text)
        channels = tuple(channel(entry) for entry in data["channels"])
        cells = tuple(section(Cell, entry) for entry in data.get("cells", ()))
        _check_masks(channels, cells)
        return Profile(
            robot=str(data["robot"]),
            supply_mv=int(data["supply_mv"]),
            channels=channels,
            groups={name: tuple(labels.split()) for name, labels in data["groups"]},
            coil_limits=optional(CoilLimits, data, "coil", any(isinstance(each, Coil) for each in channels)),
            servo_limits=servo(data, any(isinstance(each, Joint) for each in channels)),
            supply=section(SupplyLimits, data["supply"]),
            session=section(SessionLimits, data["session"]),
            program=section(ProgramLimits, data["program"]),
            crc=crc32(text),
            imu=data.get("imu"),
            camera=optional(CameraLimits, data, "camera"),
            orient=optional(OrientLimits, data, "orient"),
            load=optional(LoadLimits, data, "load", "press" in data),
            press=optional(PressLimits, data, "press"),
            cells=cells,
            cell=optional(CellLimits, data, "cell", bool(cells)),
        )
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError, RecursionError) as error:
        raise Mismatch(f"the robot's profile cannot be read ({error}): its firmware is of another version") from error


def _check_masks(channels: tuple[Coil | Joint, ...], cells: tuple[Cell, ...]) -> None:
    """Raise ValueError for more than a mask of the wire can hold, and for a label that stands for two."""
    if max(len(channels), len(cells)) > MASK_BITS:
        raise ValueError(f"{len(channels)} channels, {len(cells)} cells, at most {MASK_BITS}")
    labels = [each.label for each in (*channels, *cells)]
    twice = next((label for label in labels if labels.count(label) > 1), None)
    if twice is not None:
        raise ValueError(f"two are called {twice!r}")
