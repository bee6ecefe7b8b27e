"""A thermistor to ground with a pull-up to the reference, read by a 12-bit converter.

Beta model, R = R25 exp(beta (1/T - 1/298.15 K)), the form thermistor sheets give. A broken wire reads the upper rail
and a short the lower one, which is how firmware tells a dead sensor from a hot or cold board.
"""

from math import exp

FULL_SCALE = 4095
COLDEST_DEGC = -100.0  # where a drift ends
_KELVIN = 273.15
_T25_K = 298.15


class Ntc:
    """Turns a temperature into a conversion result. `fault` is None, "open" or "short".

    One that drifts reads `drift_k_per_s` more with each second since `drifts_from_us`.
    """

    def __init__(self, r25_ohm: float = 10_000, beta_k: float = 3950, pull_up_ohm: float = 10_000) -> None:
        self.r25_ohm = r25_ohm
        self.beta_k = beta_k
        self.pull_up_ohm = pull_up_ohm
        self.fault: str | None = None
        self.drift_k_per_s = 0.0
        self.drifts_from_us = 0

    def counts(self, degc: float, now_us: int = 0) -> int:
        """Return the 12-bit result at `degc`."""
        if self.fault is not None:
            return FULL_SCALE if self.fault == "open" else 0
        degc = max(COLDEST_DEGC, degc + self.drift_k_per_s * (now_us - self.drifts_from_us) * 1e-6)
        r_ohm = self.r25_ohm * exp(self.beta_k * (1 / (degc + _KELVIN) - 1 / _T25_K))
        return round(FULL_SCALE * r_ohm / (r_ohm + self.pull_up_ohm))


def scaled_to_u16(counts: int) -> int:
    """Return a 12-bit result as `ADC.read_u16` gives it: shifted up, the top bits repeated below."""
    return counts << 4 | counts >> 8
