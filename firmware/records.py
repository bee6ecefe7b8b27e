"""What the robot keeps on its flash, and the orders about it: faults and settings.

The flash is written only while nothing is on and nothing can be: writing stops the processor for tens of milliseconds.

    records = Records(core)
    records.orders()
    records.keep()
"""

from firmware.channels import Refused
from firmware.faultlog import VERSION as FAULTS_VERSION
from firmware.faultlog import FaultLog
from firmware.settings import VERSION as SETTINGS_VERSION
from firmware.settings import Settings
from firmware.store import Store
from protocol import codes, messages

FAULTS_A_PAGE = 8


class Records:
    """The records of one core."""

    def __init__(self, core, cause: int) -> None:
        open_file = core.board.open
        self.faults = FaultLog(Store(open_file, "faults", FAULTS_VERSION), cause)
        self.settings = Settings(Store(open_file, "settings", SETTINGS_VERSION), core.profile)
        self._core = core

    def orders(self) -> tuple:
        """Return the orders that are served here, each with its handler."""
        return (
            (messages.FAULTS_REQUEST, self._faults), (messages.CLEAR_FAULTS, self._clear_faults),
            (messages.SETTINGS_REQUEST, self._settings), (messages.SET, self._set),
        )  # fmt: skip

    def begin(self) -> None:
        """Use what was kept; say so when it cannot be read."""
        self._apply()
        if self.settings.source == messages.DAMAGED:
            self._core.reports.event(messages.DEFAULTED, codes.SETTINGS)

    def note(self, now_ms: int, code: int, channel: int, value: int, state: int) -> None:
        """Take a fault, to be written down when it is time."""
        self.faults.add(now_ms, code, channel, value, state)

    def keep(self) -> None:
        """Write down what is new, if no coil can be on."""
        if self.faults.unkept and self._core.at_rest():
            self.faults.keep(self._core.now_ms)

    def must_be_cold(self, without: int) -> None:
        """Raise Refused if a coil, but for these, may not be all martensite."""
        control, coil = self._core.control, self._core.profile.coil
        for channel in range(control.channels.count):
            temperature = control.sense.temperature_millidegc[channel]
            if not without >> channel & 1 and temperature >= coil.mf_millidegc:
                raise Refused(codes.NOT_COLD, channel, temperature // 100, coil.mf_millidegc // 100)

    def calibrate(self, without: int) -> None:
        """Keep the resistances that a self-test has just measured, but for these coils, or raise Refused."""
        mohm = self._core.control.resistance.mohm
        self.settings.calibrate([0 if without >> i & 1 else min(mohm[i], 0xFFFF) for i in range(len(mohm))])
        self._apply()

    def _faults(self, order, seq: int) -> bool:
        faults = self.faults
        self._core.commands.answer(
            messages.FAULTS, request=seq, start=faults.start, count=faults.count(),
            records=faults.page(order.skip, FAULTS_A_PAGE),
        )  # fmt: skip
        return True

    def _clear_faults(self, order, seq: int) -> None:
        self._at_rest()
        if not self.faults.clear():
            raise Refused(codes.FLASH_FAILED)

    def _settings(self, order, seq: int) -> bool:
        settings = self.settings
        self._core.commands.answer(
            messages.SETTINGS, request=seq, source=settings.source, node=settings.node,
            board_offset_decidegc=settings.board_offset_decidegc, resistances=settings.resistances(),
        )  # fmt: skip
        return True

    def _set(self, order, seq: int) -> None:
        self._at_rest()
        self.settings.change(order.setting, order.channel, order.value)
        self._apply()

    def _apply(self) -> None:
        control, settings = self._core.control, self.settings
        control.sense.board_offset_decidegc = settings.board_offset_decidegc
        for channel in range(len(settings.measured_mohm)):
            if settings.measured_mohm[channel]:
                control.resistance.refer(channel, settings.measured_mohm[channel])

    def _at_rest(self) -> None:
        if not self._core.at_rest():
            raise Refused(codes.NOT_WHILE_ARMED)
