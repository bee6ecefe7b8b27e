"""Every number that a robot file may hold: its key with the unit at the end, and where it goes in SI units.

A row reads: section, key, target, field, factor from the unit of the key to SI, least and greatest value allowed in the
unit of the key. This table is the border between the units that sources print and the SI units of the physics. The
ranges are wide, some thousand times what a soft robot has; beyond them the solvers lose their figures.
"""

from dataclasses import dataclass
from math import inf, radians


@dataclass(frozen=True)
class Key:
    """One number of a robot file."""

    section: str
    key: str
    target: str  # the group of numbers it belongs to, see robotfile.RobotFile
    field: str
    si: float  # one unit of the key in SI units
    least: float = 0.0
    most: float = inf

    @property
    def name(self) -> str:
        """Return section and key, as an override spells them."""
        return f"{self.section}.{self.key}"

    @property
    def range(self) -> str:
        """Return what is allowed, in words."""
        least = f"at least {self.least:g}"
        return least if self.most == inf else f"{least} and at most {self.most:g}"


UNITS = (
    "count", "deg", "deg_per_s", "degc", "g", "gpa", "j_per_kg_k", "k", "kg_per_m3", "kj_per_kg", "m_per_s2", "mm",
    "mpa_per_k", "n", "n_m2", "n_per_m", "n_s_per_m", "ohm", "per_s", "ratio", "s", "uohm_m", "v", "w_per_m2_k",
    # Not used above: so that a number in another unit is recognised, and for the derived section.
    "cm", "kg", "m", "mg", "mohm", "mpa", "ms", "mv", "mw", "pa", "rad", "uj", "uj_per_k", "um", "uw_per_k",
)  # fmt: skip
"""The units a key may end in."""

KEYS = (
    Key("shell", "radius_mm", "ring", "R", 1e-3, 1, 10000),
    Key("shell", "mass_g", "ring", "m", 1e-3, 0.001, 100000),
    Key("shell", "bending_stiffness_n_m2", "ring", "EI", 1.0, 1e-9, 100),
    Key("shell", "stretch_stiffness_n", "ring", "EA", 1.0, 0.01, 1e6),
    Key("shell", "bending_damping_s", "ring", "tau_v", 1.0, 0, 1),
    Key("shell", "air_drag_per_s", "ring", "drag", 1.0, 0, 1000),
    Key("shell", "nodes_count", "ring", "nodes", 1.0, 16, 256),
    Key("hub", "mass_g", "ring", "m_hub", 1e-3, 0.001, 100000),
    Key("hub", "radius_mm", "ring", "r_hub", 1e-3, 0, 10000),
    Key("hub", "attach_mm", "ring", "attach", 1e-3, 0, 10000),
    Key("coils", "slack_mm", "ring", "slack", 1e-3, 0, 10000),
    Key("coils", "taut_damping_n_s_per_m", "ring", "damping", 1.0, 0, 100),
    Key("coils", "wire_diameter_mm", "coil", "d", 1e-3, 0.001, 10),
    Key("coils", "mean_diameter_mm", "coil", "D", 1e-3, 0.001, 100),
    Key("coils", "turns_count", "coil", "n", 1.0, 1, 100000),
    Key("coils", "shear_modulus_austenite_gpa", "coil", "G_A", 1e9, 0.01, 1000),
    Key("coils", "shear_modulus_martensite_gpa", "coil", "G_M", 1e9, 0.01, 1000),
    Key("coils", "transformation_strain_ratio", "coil", "gamma", 1.0, 0, 0.2),
    Key("coils", "closed_stiffness_n_per_m", "coil", "k_s", 1.0, 0, 100000),
    Key("coils", "austenite_start_degc", "coil", "A_s", 1.0, -200, 1000),
    Key("coils", "austenite_finish_degc", "coil", "A_f", 1.0, -200, 1000),
    Key("coils", "martensite_start_degc", "coil", "M_s", 1.0, -200, 1000),
    Key("coils", "martensite_finish_degc", "coil", "M_f", 1.0, -200, 1000),
    Key("coils", "stress_shift_mpa_per_k", "coil", "c_tau", 1e6, 0.01, 10000),
    Key("coils", "density_kg_per_m3", "coil", "rho", 1.0, 100, 100000),
    Key("coils", "specific_heat_j_per_kg_k", "coil", "c", 1.0, 1, 100000),
    Key("coils", "latent_heat_kj_per_kg", "coil", "H", 1e3, 0, 10000),
    Key("coils", "heat_transfer_w_per_m2_k", "coil", "h", 1.0, 0.01, 1e6),
    Key("coils", "resistivity_austenite_uohm_m", "coil", "rho_A", 1e-6, 0.001, 10000),
    Key("coils", "resistivity_martensite_uohm_m", "coil", "rho_M", 1e-6, 0.001, 10000),
    Key("coils", "strain_resistance_ratio", "coil", "k_e", 1.0, 0, 10),
    Key("wiring", "lead_ohm", "wiring", "lead_ohm", 1.0),
    Key("wiring", "switch_ohm", "wiring", "switch_ohm", 1.0),
    Key("wiring", "source_ohm", "wiring", "source_ohm", 1.0),
    Key("wiring", "supply_v", "wiring", "supply_v", 1.0, 0, 60),
    Key("sensors", "shunt_ohm", "sensors", "shunt_ohm", 1.0, 1e-6, 100),
    Key("sensors", "ntc_ohm", "sensors", "ntc_ohm", 1.0, 1, 1e8),
    Key("sensors", "ntc_beta_k", "sensors", "ntc_beta_k", 1.0, 1, 100000),
    Key("sensors", "ntc_pull_up_ohm", "sensors", "ntc_pull_up_ohm", 1.0, 1, 1e8),
    Key("ground", "slope_deg", "ground", "slope", radians(1), -60, 60),
    Key("ground", "tilt_after_s", "ground", "tilt_after", 1.0, 0, 3600),
    Key("ground", "tilt_deg_per_s", "ground", "tilt_rate", radians(1), 0.01, 1000),
    Key("ground", "friction_ratio", "ground", "mu", 1.0, 0, 1000),
    Key("ground", "contact_stiffness_n_per_m", "ground", "k_n", 1.0, 0.001, 1e7),
    Key("ground", "contact_damping_n_s_per_m", "ground", "c_n", 1.0, 0, 10000),
    Key("ground", "gravity_m_per_s2", "ground", "gravity", 1.0, 0, 1000),
    Key("ground", "ambient_degc", "ground", "T_amb", 1.0, -40, 60),
    Key("start", "turn_deg", "start", "turn", radians(1), -360, 360),
    Key("start", "settle_s", "start", "settle", 1.0, 0, 60),
)
