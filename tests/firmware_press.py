"""A press on the table: its axis follows the pulses within 10 ms, and what it presses is a law of one dimension.

The block is a spring with a dashpot in series, and a dashpot beside both: the bonded block of the bench, seen from its
punch, and softer or harder by `scale`.
"""

from math import exp

from protocol import messages
from tests.firmware_bench import ROOT, Rig

PRESS = ROOT / "firmware" / "robots" / "press.json"
P, LOAD, CELL = 0b1, 8, 2
ZERO_COUNTS, MN_PER_COUNT = 819, 8
MODULUS_N_PER_MM, VISCOSITY_N_S_PER_MM, DAMPING_N_S_PER_MM = 2.74, 13.7, 0.274
STEP_S, LAG_S = 0.005, 0.010


class Axis:
    """What the converter of a press reads; a load cell or a force cell may read what a test says."""

    def __init__(self, table, scale: float) -> None:
        self.load_counts = None  # None: what the block says
        self.cell_counts = [0] * 6
        self.force_n = 0.0
        self.surface_mm = 0.0  # where the block begins
        self.stuck = False
        self._branch_n = 0.0
        self._table = table
        self._scale = scale
        self.mm = -2.0

    def pass_time(self) -> None:
        """Let the axis follow its pulses, and the block creep, for a control step."""
        width_ns = self._table.servos[8].width_ns
        before = max(0.0, self.mm - self.surface_mm)
        if width_ns is not None and not self.stuck:
            self.mm += ((width_ns - 1_500_000) / 1e5 - self.mm) * (1 - exp(-STEP_S / LAG_S))
        deep = max(0.0, self.mm - self.surface_mm)
        moved = (deep - before) * self._scale
        tau_s = VISCOSITY_N_S_PER_MM / MODULUS_N_PER_MM
        self._branch_n = self._branch_n * exp(-STEP_S / tau_s) + MODULUS_N_PER_MM * moved
        self.force_n = self._branch_n + DAMPING_N_S_PER_MM * moved / STEP_S if deep else 0.0

    def counts(self, channel: int) -> int:
        if channel == 0:
            return 63
        if channel == 1:
            return 410 + round((self.mm + 10) * 3276 / 20)
        if channel == LOAD:
            felt = ZERO_COUNTS + round(self.force_n * 1000 / MN_PER_COUNT)
            return min(max(felt, 0), 4095) if self.load_counts is None else self.load_counts
        return self.cell_counts[channel - CELL]


class PressRig(Rig):
    """A core of the press with its block; each control step passes there, too."""

    def __init__(self, scale: float = 1.0) -> None:
        self.axis = None
        self._scale = scale
        super().__init__(PRESS)

    def run(self, ms: int, silent: bool = False, line: bytes = b""):
        """Let time pass for core and block."""
        if self.axis is None:
            self.axis = self.board.converter = Axis(self.board, self._scale)
            self.core.limbs.sense._converter = self.axis
            self.core.limbs.load._converter = self.core.limbs.cells._converter = self.axis
        fresh = []
        for _ in range(0, ms, 5):
            self.axis.pass_time()
            fresh += super().run(5, silent, line)
            line = b""
        return fresh

    def press(self, target_mn: int, over_ms: int = 500, time_ms: int = 5000, hold_ms: int = 5000):
        """Order a force and return the answers."""
        fields = {"target_mn": target_mn, "over_ms": over_ms, "time_ms": time_ms, "hold_ms": hold_ms}
        return self.say(messages.PRESS, **fields)

    @property
    def commanded_centi(self):
        """Where the axis is told to be."""
        return self.core.limbs.joints.commanded_centi[0]
