"""What the resistance of each coil says: whether it is whole, its share of martensite, a bracket of its temperature.

Austenite has less resistance than martensite; stretch moves both by some percent, so that the share of martensite is
known within SHARE_PERMILLE only. The wire is somewhere between its cooling and its heating line, and stress moves both
up: that makes the bracket wide, but the true temperature is in it.

The reference is what the coil had when it was cold, as a self-test has measured it or `refer` was told.
"""

from array import array

from protocol import codes

OPEN_PERMILLE = 1600  # of the profile's resistance. Phase and stretch make 0.7 to 1.3; two coils in parallel 0.5
SHORT_PERMILLE = 600
COLD_SHORT_PERMILLE = 800  # of a coil that is cold, so all martensite: less is a coil some of whose turns touch
MOST_MOHM = 999_999  # stands for all above, and for no current at all
MOST_TOLD_MOHM = 655_350
SHARE_PERMILLE = 350  # stretch is 2 % of the resistance, the whole change of phase 8 %; the rest is the cosine's
STRESS_MILLIDEGC = 55_000  # a coil of 0.1 mm wire under 0.5 N is shifted so far, at 6.9 MPa/K
UNKNOWN = 0xFFFF
COLDEST_DECIDEGC, HOTTEST_DECIDEGC = -0x8000, 0x7FFF  # no bound


class Resistance:
    """The resistances of all coils as they were measured last; the nominal one before."""

    def __init__(self, count: int, coil) -> None:
        self.mohm = array("i", [coil.resistance_mohm] * count)
        self.open_mohm = coil.resistance_mohm * OPEN_PERMILLE // 1000
        self.short_mohm = coil.resistance_mohm * SHORT_PERMILLE // 1000
        self._cold_short_mohm = coil.resistance_mohm * COLD_SHORT_PERMILLE // 1000
        self._cold_mohm = array("i", [0] * count)  # 0: not known
        self._measured = array("B", [0] * count)
        self._coil = coil

    def take(self, channel: int, mohm: int) -> None:
        """Keep a measurement of a coil that is whole."""
        self.mohm[channel] = mohm
        self._measured[channel] = 1

    def measured_mohm(self, channel: int) -> int:
        """Return what was measured last, 0 when nothing was."""
        return min(self.mohm[channel], MOST_TOLD_MOHM) if self._measured[channel] else 0

    def refer(self, channel: int, mohm: int) -> None:
        """Take that as the coil's resistance when it is cold, all martensite."""
        self._cold_mohm[channel] = mohm

    def hot_mohm(self, channel: int) -> int:
        """Return the least resistance to reckon with: that of the coil when it is all austenite."""
        cold_mohm = self._cold_mohm[channel]
        hot_mohm = (cold_mohm or self.mohm[channel]) * self._coil.austenite_permille // 1000
        return min(hot_mohm, self.mohm[channel])

    def verdict(self, mohm: int, is_cold: bool = False) -> int:
        """Return the code of what is wrong with a coil of that resistance, or 0."""
        if mohm > self.open_mohm:
            return codes.COIL_OPEN
        return codes.COIL_SHORT if mohm < self.limit_mohm(codes.COIL_SHORT, is_cold) else 0

    def limit_mohm(self, code: int, is_cold: bool = False) -> int:
        """Return the end of the band that a verdict is about."""
        if code == codes.COIL_OPEN:
            return self.open_mohm
        return self._cold_short_mohm if is_cold else self.short_mohm

    def martensite_permille(self, channel: int) -> int:
        """Return the share of martensite by the last measurement, or UNKNOWN."""
        cold = self._cold_mohm[channel]
        if not cold or not self._measured[channel]:
            return UNKNOWN
        austenite = cold * self._coil.austenite_permille // 1000
        share = (self.mohm[channel] - austenite) * 1000 // (cold - austenite)
        return 0 if share < 0 else 1000 if share > 1000 else share

    def least_decidegc(self, channel: int) -> int:
        """Return what the coil's temperature was at least when it was measured, or COLDEST_DECIDEGC."""
        share = self.martensite_permille(channel) + SHARE_PERMILLE
        if share >= 1000:
            return COLDEST_DECIDEGC
        coil = self._coil
        return (coil.ms_millidegc - share * ((coil.ms_millidegc - coil.mf_millidegc) // 1000)) // 100

    def most_decidegc(self, channel: int) -> int:
        """Return what the coil's temperature was at most when it was measured, or HOTTEST_DECIDEGC."""
        share = self.martensite_permille(channel)
        if share == UNKNOWN or share <= SHARE_PERMILLE:
            return HOTTEST_DECIDEGC
        coil = self._coil
        span = (coil.af_millidegc - coil.as_millidegc) // 1000
        return (coil.af_millidegc + STRESS_MILLIDEGC - (share - SHARE_PERMILLE) * span) // 100
