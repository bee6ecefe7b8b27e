"""Every number that a robot file may hold: its key with the unit at the end, and where it goes in SI units.

A row reads: section, key, target, field, factor from the unit of the key to SI, least and greatest value allowed in the
unit of the key, and where not every robot has it: which do. This table is the border between the units that sources
print and the SI units of the physics. The ranges are wide, some thousand times what a soft robot has; beyond them the
solvers lose their figures.
"""

from collections.abc import Collection
from dataclasses import dataclass
from math import inf, isfinite, radians

RING, SPHERE, FINGERS, PRESS = "ring", "sphere", "fingers", "press"  # kinds of robots
SHELL, COILS, SERVOS = "shell", "coils", "servos"  # what robots of some kinds have
BENCH, BATTERY = "bench supply", "battery"  # kinds of power
GRID = "block without a mesh"  # of its own, from a file
KINDS: dict[str, tuple[str, ...]] = {
    RING: (RING, SHELL, COILS),
    SPHERE: (SPHERE, SHELL, COILS),
    FINGERS: (FINGERS, SERVOS),
    PRESS: (PRESS, SERVOS),
}
"""What a robot of each kind has."""


@dataclass(frozen=True)
class Key:
    """One number of a robot file."""

    section: str
    key: str
    target: str  # the group of numbers it belongs to, see file.RobotFile
    field: str
    si: float  # one unit of the key in SI units
    least: float = 0.0
    most: float = inf
    only: str = ""  # robots that have this have the number
    multiple: int = 0  # it counts, in steps of this many
    needed: bool = True

    @property
    def name(self) -> str:
        """Return section and key, as an override spells them."""
        return f"{self.section}.{self.key}"

    @property
    def range(self) -> str:
        """Return what is allowed, in words."""
        most = "" if self.most == inf else f" and at most {self.most:g}"
        steps = {0: "", 1: " and a whole number"}.get(self.multiple, f" and a multiple of {self.multiple}")
        return f"at least {self.least:g}{most}{steps}"

    def allows(self, value: float) -> bool:
        """Return whether this is a value that a robot may have."""
        fits = isfinite(value) and self.least <= value <= self.most
        return fits and (not self.multiple or value % self.multiple == 0)


UNITS = (
    "count", "deg", "deg_per_s", "degc", "g", "gpa", "hz", "j_per_kg_k", "k", "kg_m2", "kg_per_m3", "kj_per_kg", "kpa",
    "kpa_s", "m_per_s2", "ma", "mah", "mm", "mm_per_s", "mpa", "mpa_per_k", "ms", "mv", "n", "n_m", "n_m2", "n_m_s",
    "n_per_m", "n_s_per_m", "ohm", "pa", "per_s", "percent", "rad_per_s", "ratio", "s", "uohm_m", "us", "v",
    "w_per_m2_k",
    # Not used above: so that a number in another unit is recognised, and for the derived section.
    "cm", "kg", "m", "mg", "mj", "mm_per_n", "mohm", "mpa_s", "mw", "n_mm", "n_per_mm", "pa_s", "rad", "uj", "uj_per_k",
    "um", "uw_per_k",
)  # fmt: skip
"""The units a key may end in."""

KEYS = (
    Key("shell", "radius_mm", "body", "R", 1e-3, 1, 10000, SHELL),
    Key("shell", "mass_g", "body", "m", 1e-3, 0.001, 100000, SHELL),
    Key("shell", "joints_mass_g", "body", "m_joints", 1e-3, 0, 100000, SPHERE),
    Key("shell", "bending_stiffness_n_m2", "body", "EI", 1.0, 1e-9, 100, SHELL),
    Key("shell", "edgewise_ratio", "body", "edgewise", 1.0, 0.1, 1000, SPHERE),
    Key("shell", "twist_ratio", "body", "twist", 1.0, 0.1, 1000, SPHERE),
    Key("shell", "stretch_stiffness_n", "body", "EA", 1.0, 0.01, 1e6, SHELL),
    Key("shell", "bending_damping_s", "body", "tau_v", 1.0, 0, 1, SHELL),
    Key("shell", "strip_width_mm", "body", "width", 1e-3, 0, 1000, SPHERE),
    Key("shell", "air_drag_per_s", "body", "drag", 1.0, 0, 1000, SHELL),
    Key("shell", "nodes_count", "body", "nodes", 1.0, 16, 256, RING, 1),
    Key("shell", "nodes_count", "body", "nodes", 1.0, 8, 128, SPHERE, 8),
    Key("hub", "mass_g", "body", "m_hub", 1e-3, 0.001, 100000, RING),
    Key("hub", "radius_mm", "body", "r_hub", 1e-3, 0, 10000, RING),
    Key("hub", "attach_mm", "body", "attach", 1e-3, 0, 10000, RING),
    Key("core", "mass_g", "body", "m_core", 1e-3, 0.001, 100000, SPHERE),
    Key("core", "radius_mm", "body", "r_core", 1e-3, 0.01, 10000, SPHERE),
    Key("core", "attach_mm", "body", "attach", 1e-3, 0, 10000, SPHERE),
    Key("coils", "taut_damping_n_s_per_m", "body", "damping", 1.0, 0, 100, COILS),
    Key("coils", "wire_diameter_mm", "coil", "d", 1e-3, 0.001, 10, COILS),
    Key("coils", "mean_diameter_mm", "coil", "D", 1e-3, 0.001, 100, COILS),
    Key("coils", "turns_count", "coil", "n", 1.0, 1, 100000, COILS),
    Key("coils", "shear_modulus_austenite_gpa", "coil", "G_A", 1e9, 0.01, 1000, COILS),
    Key("coils", "shear_modulus_martensite_gpa", "coil", "G_M", 1e9, 0.01, 1000, COILS),
    Key("coils", "transformation_strain_ratio", "coil", "gamma", 1.0, 0, 0.2, COILS),
    Key("coils", "closed_stiffness_n_per_m", "coil", "k_s", 1.0, 0, 100000, COILS),
    Key("coils", "austenite_start_degc", "coil", "A_s", 1.0, -200, 1000, COILS),
    Key("coils", "austenite_finish_degc", "coil", "A_f", 1.0, -200, 1000, COILS),
    Key("coils", "martensite_start_degc", "coil", "M_s", 1.0, -200, 1000, COILS),
    Key("coils", "martensite_finish_degc", "coil", "M_f", 1.0, -200, 1000, COILS),
    Key("coils", "stress_shift_mpa_per_k", "coil", "c_tau", 1e6, 0.01, 10000, COILS),
    Key("coils", "density_kg_per_m3", "coil", "rho", 1.0, 100, 100000, COILS),
    Key("coils", "specific_heat_j_per_kg_k", "coil", "c", 1.0, 1, 100000, COILS),
    Key("coils", "latent_heat_kj_per_kg", "coil", "H", 1e3, 0, 10000, COILS),
    Key("coils", "heat_transfer_w_per_m2_k", "coil", "h", 1.0, 0.01, 1e6, COILS),
    Key("coils", "resistivity_austenite_uohm_m", "coil", "rho_A", 1e-6, 0.001, 10000, COILS),
    Key("coils", "resistivity_martensite_uohm_m", "coil", "rho_M", 1e-6, 0.001, 10000, COILS),
    Key("coils", "strain_resistance_ratio", "coil", "k_e", 1.0, 0, 10, COILS),
    Key("tips", "radius_mm", "fingers", "a", 1e-3, 1, 1000, FINGERS),
    Key("tips", "youngs_modulus_mpa", "fingers", "E", 1e6, 0.001, 1000, FINGERS),
    Key("tips", "offset_mm", "fingers", "e", 1e-3, -1000, 1000, FINGERS),
    Key("tips", "shear_ratio", "fingers", "k", 1.0, 0.001, 1000, FINGERS),
    Key("tips", "damping_s", "fingers", "tau", 1.0, 0, 1, FINGERS),
    Key("tips", "shear_damping_s", "fingers", "tau_t", 1.0, 0, 1, FINGERS),
    Key("links", "length_mm", "fingers", "L", 1e-3, 1, 10000, FINGERS),
    Key("links", "gap_mm", "fingers", "gap", 1e-3, -100, 1000, FINGERS),
    Key("object", "width_mm", "fingers", "w", 1e-3, 0, 1000, FINGERS),
    Key("object", "height_mm", "fingers", "h", 1e-3, 0, 1000, FINGERS),
    Key("object", "mass_g", "fingers", "m", 1e-3, 0, 100000, FINGERS),
    Key("object", "friction_ratio", "fingers", "mu", 1.0, 0, 1000, FINGERS),
    Key("servos", "rate_deg_per_s", "fingers", "rate", radians(1), 1, 100000, FINGERS),
    Key("servos", "bandwidth_rad_per_s", "fingers", "omega", 1.0, 1, 1000, FINGERS),
    Key("servos", "stall_torque_n_m", "fingers", "stall", 1.0, 0.001, 1000, FINGERS),
    Key("servos", "inertia_kg_m2", "fingers", "J", 1.0, 1e-6, 10, FINGERS),
    Key("servos", "gear_damping_n_m_s", "fingers", "rub", 1.0, 0, 1000, FINGERS),
    Key("servos", "stall_current_ma", "fingers", "I_stall", 1e-3, 1, 100000, FINGERS),
    Key("servos", "idle_current_ma", "fingers", "I_idle", 1e-3, 0, 10000, FINGERS),
    Key("servos", "dead_band_us", "wiring", "dead_band_us", 1.0, 0, 100, FINGERS),
    Key("camera", "rate_hz", "camera", "rate_hz", 1.0, 1, 1000, FINGERS),
    Key("camera", "latency_ms", "camera", "latency_ms", 1.0, 0, 1000, FINGERS),
    Key("camera", "noise_deg", "camera", "noise_deg", 1.0, 0, 10, FINGERS),
    Key("block", "width_mm", "press", "width", 1e-3, 1, 10000, GRID),
    Key("block", "height_mm", "press", "height", 1e-3, 1, 10000, GRID),
    Key("block", "columns_count", "press", "columns", 1.0, 2, 256, GRID, 1),
    Key("block", "rows_count", "press", "rows", 1.0, 1, 256, GRID, 1),
    Key("block", "thickness_mm", "press", "thickness", 1e-3, 0.1, 10000, PRESS),
    Key("material", "youngs_modulus_kpa", "material", "E", 1e3, 0, 1e6, PRESS),
    Key("material", "viscosity_kpa_s", "material", "c", 1e3, 0, 1e9, PRESS),
    Key("material", "damping_kpa_s", "material", "c0", 1e3, 0, 1e6, PRESS),
    Key("material", "parallel_modulus_kpa", "material", "E0", 1e3, 0, 1e6, PRESS),
    Key("material", "poisson_ratio", "material", "nu", 1.0, -0.9, 0.49, PRESS),
    Key("material", "youngs_modulus_2_kpa", "material", "E_2", 1e3, 0, 1e6, PRESS, needed=False),
    Key("material", "viscosity_2_kpa_s", "material", "c_2", 1e3, 0, 1e9, PRESS, needed=False),
    Key("material", "poisson_2_ratio", "material", "nu_2", 1.0, -0.9, 0.49, PRESS, needed=False),
    Key("material", "damping_poisson_ratio", "material", "nu_c", 1.0, -0.9, 0.49, PRESS, needed=False),
    Key("material", "parallel_poisson_ratio", "material", "nu0", 1.0, -0.9, 0.49, PRESS, needed=False),
    Key("material", "unloading_viscosity_kpa_s", "material", "c_unloading", 1e3, 0, 1e9, PRESS, needed=False),
    Key("material", "unloading_damping_kpa_s", "material", "c0_unloading", 1e3, 0, 1e6, PRESS, needed=False),
    Key("indenter", "radius_mm", "press", "R", 1e-3, 0.1, 10000, PRESS),
    Key("indenter", "width_mm", "press", "w", 1e-3, 0.1, 10000, PRESS),
    Key("indenter", "at_mm", "press", "at", 1e-3, -10000, 10000, PRESS, needed=False),
    Key("indenter", "pull_off_n", "press", "pull_off", 1.0, 0, 10000, PRESS),
    Key("indenter", "tool_mass_g", "press", "tool_mass", 1e-3, 0, 100000, PRESS),
    Key("axis", "rate_mm_per_s", "screw", "rate_mm_per_s", 1.0, 0.01, 10000, PRESS),
    Key("axis", "bandwidth_rad_per_s", "screw", "bandwidth_rad_per_s", 1.0, 1, 1000, PRESS),
    Key("axis", "stall_force_n", "screw", "stall_n", 1.0, 0.001, 100000, PRESS),
    Key("axis", "stall_current_ma", "screw", "stall_a", 1e-3, 1, 100000, PRESS),
    Key("axis", "idle_current_ma", "screw", "idle_a", 1e-3, 0, 10000, PRESS),
    Key("axis", "backlash_mm", "press", "backlash", 1e-3, 0, 5, PRESS),
    Key("axis", "dead_band_us", "wiring", "dead_band_us", 1.0, 0, 100, PRESS),
    Key("load_cell", "zero_mv", "load_cell", "zero_v", 1e-3, 0, 3300, PRESS),
    Key("load_cell", "full_scale_n", "load_cell", "full_n", 1.0, 0.001, 100000, PRESS),
    Key("load_cell", "noise_n", "load_cell", "noise_n", 1.0, 0, 10000, PRESS),
    Key("cells", "side_mm", "press", "side", 1e-3, 0.01, 1000, PRESS),
    Key("cells", "full_scale_kpa", "cells", "full_pa", 1e3, 0.001, 1e6, PRESS),
    Key("cells", "noise_pa", "cells", "noise_pa", 1.0, 0, 1e9, PRESS),
    Key("wiring", "lead_ohm", "wiring", "lead_ohm", 1.0, only=COILS),
    Key("wiring", "switch_ohm", "wiring", "switch_ohm", 1.0, only=COILS),
    Key("wiring", "source_ohm", "wiring", "source_ohm", 1.0),
    Key("wiring", "supply_v", "wiring", "supply_v", 1.0, 0, 60, BENCH),
    Key("battery", "cells_count", "battery", "cells", 1.0, 1, 20, BATTERY, 1),
    Key("battery", "capacity_mah", "battery", "Q", 3.6, 0.001, 1e6, BATTERY),
    Key("battery", "charge_percent", "battery", "z", 1e-2, 0, 100, BATTERY),
    Key("battery", "internal_ohm", "battery", "r", 1.0, 0, 1000, BATTERY),
    Key("battery", "cut_off_v", "battery", "V_cut", 1.0, 0, 100, BATTERY),
    Key("battery", "board_ma", "battery", "I_board", 1e-3, 0, 10000, BATTERY),
    Key("sensors", "shunt_ohm", "sensors", "shunt_ohm", 1.0, 1e-6, 100),
    Key("sensors", "ntc_ohm", "sensors", "ntc_ohm", 1.0, 1, 1e8),
    Key("sensors", "ntc_beta_k", "sensors", "ntc_beta_k", 1.0, 1, 100000),
    Key("sensors", "ntc_pull_up_ohm", "sensors", "ntc_pull_up_ohm", 1.0, 1, 1e8),
    Key("sensors", "imu_count", "sensors", "imu", 1.0, 0, 1, SPHERE, 1),
    Key("ground", "slope_deg", "ground", "slope", radians(1), -60, 60, SHELL),
    Key("ground", "tilt_after_s", "ground", "tilt_after", 1.0, 0, 3600, SHELL),
    Key("ground", "tilt_deg_per_s", "ground", "tilt_rate", radians(1), 0.01, 1000, SHELL),
    Key("ground", "friction_ratio", "ground", "mu", 1.0, 0, 1000, SHELL),
    Key("ground", "contact_stiffness_n_per_m", "ground", "k_n", 1.0, 0.001, 1e7, SHELL),
    Key("ground", "contact_damping_n_s_per_m", "ground", "c_n", 1.0, 0, 10000, SHELL),
    Key("ground", "gravity_m_per_s2", "ground", "gravity", 1.0, 0, 1000),
    Key("ground", "ambient_degc", "ground", "T_amb", 1.0, -40, 60),
    Key("ground", "step_mm", "ground", "step", 1e-3, -1000, 1000, SHELL),
    Key("ground", "step_at_mm", "ground", "step_at", 1e-3, -100000, 100000, SHELL),
    Key("ground", "roughness_mm", "ground", "rough", 1e-3, 0, 1000, SHELL),
    Key("ground", "roughness_length_mm", "ground", "rough_length", 1e-3, 0.25, 100000, SHELL),
    Key("start", "turn_deg", "start", "turn", radians(1), -360, 360, RING),
    Key("start", "yaw_deg", "start", "yaw", radians(1), -360, 360, SPHERE),
    Key("start", "pitch_deg", "start", "pitch", radians(1), -360, 360, SPHERE),
    Key("start", "roll_deg", "start", "roll", radians(1), -360, 360, SPHERE),
    Key("start", "settle_s", "start", "settle", 1.0, 0, 60, SHELL),
    Key("numerics", "tolerance_um", "numerics", "tolerance", 1e-6, 0.001, 1000, SHELL),
    Key("numerics", "step_ms", "press", "dt", 1e-3, 1, 100, PRESS),
)


def features_of(kind: str, power: str = BENCH, meshed: bool = False) -> tuple[str, ...]:
    """Return what a robot of this kind and with this power has; one that is not `meshed` has a block of cells."""
    return (*KINDS[kind], power, *((GRID,) if kind == PRESS and not meshed else ()))


def keys_of(features: Collection[str]) -> tuple[Key, ...]:
    """Return the numbers that a robot with these features has."""
    return tuple(key for key in KEYS if not key.only or key.only in features)
