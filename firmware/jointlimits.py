"""What joints may be told, how they are read and regulated, and what they may press with; see profile.py.

Loaded only where the profile names joints: a robot of coils has that memory for itself.
"""

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
PRESS_GAIN_MAX = 10_000  # um/s for a newton: beyond it the loop's integers would not stay small
RESET_MAX = 20_000
SMOOTH_MIN_MS = 20  # no less than a late control step
WAY_MIN_COUNTS = 1000  # of a potentiometer: less would make angles of its noise


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
