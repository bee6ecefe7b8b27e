"""What each variable of protocol/variables.py is at this moment, for the records of telemetry.

readings = Readings(core)
values = []
readings.readers[variables.number("supply_mv")](values)
"""

import struct

USUAL_SCALARS = "<BHHHhhhB"


class Readings:
    """The variables of one core; `readers`, in the order of the table, each add the value or values of theirs."""

    def __init__(self, core) -> None:
        self.readers = (
            self._state, self._code, self._step, self._coils_on, self._without, self._lease_left, self._supply,
            self._current, self._board, self._roll, self._pitch, self._down, self._dropped, self._resent,
            self._overruns, self._duties, self._temperatures, self._heats, self._resistances, self._martensites,
            self._least, self._most, self._can_state, self._can_overflows, self._can_refused, self._can_bus_offs,
            self._joint_positions, self._commanded, self._joint_currents, self._object, self._load, self._cells,
            self._program_at,
        )  # fmt: skip
        self._core = core
        self._channels, self._sense, self._attitude = core.channels, core.sense, core.attitude
        self._resistance = core.control.resistance
        self._budget_mj = core.profile.coil.heat_budget_mj
        self._degrees = f"<{core.channels.count}h"
        self._limbs = core.limbs

    def usual(self) -> bytes:
        """Return the usual variables, packed: they are sent so often that all are read at once.

        The duties go as they stand in memory: every board that this runs on is little endian, as the line is.
        """
        core, sense, attitude = self._core, self._sense, self._attitude
        scalars = struct.pack(
            USUAL_SCALARS, core.state, core.player.step, sense.supply_mv, sense.current_ma, sense.board_decidegc,
            attitude.roll_decideg(), attitude.pitch_decideg(), attitude.down_channel(),
        )  # fmt: skip
        if self._channels.count:
            degrees = struct.pack(self._degrees, *[millidegc // 100 for millidegc in sense.temperature_millidegc])
            scalars += bytes(self._channels.duty_permille) + degrees
        return scalars + self._of_joints() if self._limbs else scalars

    def _of_joints(self) -> bytes:
        joints = self._limbs.joints
        told = bytes(joints.measured_centi) + bytes(joints.commanded_centi) + bytes(joints.current_ma)
        camera, load, cells = self._limbs.camera, self._limbs.load, self._limbs.cells
        if camera:
            told += struct.pack("<h", camera.object_centideg())
        if load:
            told += struct.pack("<i", load.force_mn)
        return told + bytes(cells.pressure_pa) if cells else told

    def _state(self, values: list) -> None:
        values.append(self._core.state)

    def _code(self, values: list) -> None:
        values.append(self._core.code)

    def _step(self, values: list) -> None:
        values.append(self._core.player.step)

    def _coils_on(self, values: list) -> None:
        values.append(self._channels.on_mask)

    def _without(self, values: list) -> None:
        values.append(self._channels.without_mask)

    def _lease_left(self, values: list) -> None:
        values.append(self._core.lease_left_ms())

    def _supply(self, values: list) -> None:
        values.append(self._sense.supply_mv)

    def _current(self, values: list) -> None:
        values.append(self._sense.current_ma)

    def _board(self, values: list) -> None:
        values.append(self._sense.board_decidegc)

    def _roll(self, values: list) -> None:
        values.append(self._attitude.roll_decideg())

    def _pitch(self, values: list) -> None:
        values.append(self._attitude.pitch_decideg())

    def _down(self, values: list) -> None:
        values.append(self._attitude.down_channel())

    def _dropped(self, values: list) -> None:
        values.append(self._core.link.decoder.dropped & 0xFFFF)

    def _resent(self, values: list) -> None:
        values.append(self._core.link.resent & 0xFFFF)

    def _overruns(self, values: list) -> None:
        values.append(self._core.overruns & 0xFFFF)

    def _duties(self, values: list) -> None:
        values.extend(self._channels.duty_permille)

    def _temperatures(self, values: list) -> None:
        values.extend([millidegc // 100 for millidegc in self._sense.temperature_millidegc])

    def _heats(self, values: list) -> None:
        budget_mj = self._budget_mj
        values.extend([min(heat_uj // budget_mj, 0xFFFF) for heat_uj in self._sense.heat_uj])

    def _resistances(self, values: list) -> None:
        resistance = self._resistance
        values.extend([resistance.measured_mohm(channel) for channel in range(self._channels.count)])

    def _martensites(self, values: list) -> None:
        resistance = self._resistance
        values.extend([resistance.martensite_permille(channel) for channel in range(self._channels.count)])

    def _least(self, values: list) -> None:
        resistance = self._resistance
        values.extend([resistance.least_decidegc(channel) for channel in range(self._channels.count)])

    def _most(self, values: list) -> None:
        resistance = self._resistance
        values.extend([resistance.most_decidegc(channel) for channel in range(self._channels.count)])

    def _can_state(self, values: list) -> None:
        values.append(self._core.can.state if self._core.can else 0)

    def _can_overflows(self, values: list) -> None:
        values.append(self._core.can.overflows & 0xFFFF if self._core.can else 0)

    def _can_refused(self, values: list) -> None:
        values.append(self._core.can.refused & 0xFFFF if self._core.can else 0)

    def _can_bus_offs(self, values: list) -> None:
        values.append(self._core.can.bus_offs & 0xFFFF if self._core.can else 0)

    def _joint_positions(self, values: list) -> None:
        if self._limbs:
            values.extend(self._limbs.joints.measured_centi)

    def _commanded(self, values: list) -> None:
        if self._limbs:
            values.extend(self._limbs.joints.commanded_centi)

    def _joint_currents(self, values: list) -> None:
        if self._limbs:
            values.extend(self._limbs.joints.current_ma)

    def _object(self, values: list) -> None:
        if self._limbs and self._limbs.camera:
            values.append(self._limbs.camera.object_centideg())

    def _load(self, values: list) -> None:
        if self._limbs and self._limbs.load:
            values.append(self._limbs.load.force_mn)

    def _cells(self, values: list) -> None:
        if self._limbs and self._limbs.cells:
            values.extend(self._limbs.cells.pressure_pa)

    def _program_at(self, values: list) -> None:
        values.append(self._core.player.gone + self._core.player.at)
