"""Made-up runs for tests of pictures: a sphere of three hoops that rolls and one that jumps, of true geometry."""

import math

import numpy as np

from host.recording import Recording
from host.records import Event, Telemetry

DIAGONALS = "A110 Am110 A1m10 Am1m10 A101 Am101 A10m1 Am10m1 A011 A0m11 A01m1 A0m1m1"
SPOKES = tuple(f"A100 Am100 A010 A0m10 A001 A00m1 {DIAGONALS}".split())
SQUARE = ("B10m1", "B01m1", "Bm10m1", "B0m1m1")
LABELS = SPOKES + SQUARE
FORWARD = ("A00m1", "A10m1", "A100", "A101", "A001", "Am101", "Am100", "Am10m1")
NODES = 24
STEP_S = 2.5
SNAP_S, APEX_S, LANDED_S = 4.93, 5.125, 5.325
RISE_MM = 186.0
DRIVEN_S = {
    "A00m1": (0.3, 1.2),
    **dict.fromkeys(("A101", "A011", "Am101", "A0m11"), (0.3, 1.45)),
    **dict.fromkeys(SQUARE, (1.25, 3.85)),
    **dict.fromkeys(("A100", "Am100", "A010", "A0m10"), (1.95, 5.0)),
}
MASS_KG, GRAVITY = 5e-3, 9.81


def direction(label):
    """Return the unit direction that a label spells."""
    digits, sign = [], 1
    for letter in label[1:]:
        if letter == "m":
            sign = -1
        else:
            digits.append(sign * int(letter))
            sign = 1
    return np.array(digits) / np.linalg.norm(digits)


def hoops():
    """Return the directions of the nodes and the nodes of each hoop; crossings are shared."""
    places, indexes, found = [], [], {}
    for normal in (2, 1, 0):
        a, b = [axis for axis in range(3) if axis != normal]
        hoop = []
        for i in range(NODES):
            place = np.zeros(3)
            place[a], place[b] = math.cos(2 * math.pi * i / NODES), math.sin(2 * math.pi * i / NODES)
            key = tuple(np.round(place, 6) + 0.0)
            if key not in found:
                found[key] = len(places)
                places.append(place)
            hoop.append(found[key])
        indexes.append(hoop)
    return np.array(places), indexes


class RollingSphere:
    """An observer of a sphere that turns by 45 degrees in each step, over the points of its rolling hoop."""

    driven_s = STEP_S

    def __init__(self, slope_deg=0.0, radius_mm=45.0, attach_mm=0.0, terrain_mm=()):
        self.t_s = 0.0
        self.slope_deg, self.radius_mm, self.attach_mm = slope_deg, radius_mm, attach_mm
        self.terrain_mm = [list(point) for point in terrain_mm]
        self._places, self._hoops = hoops()

    def observe(self):
        """Return the travel, as the bench's observer does."""
        return {"travel_mm": self._turn() * self.radius_mm, "lateral_mm": 0.3 * self._turn(), "jump": None}

    def snapshot(self):
        """Return the shape, as the bench's observer does."""
        turn = self._turn()
        nodes = self._turned(self._dented(self._places), turn)
        lift = np.array([turn * self.radius_mm, 0.0, self.height_mm() - nodes[:, 2].min()])
        ends = {label: self._turned(self._dented(direction(label)[None]), turn)[0] + lift for label in LABELS}
        return {
            "t_s": self.t_s,
            "slope_deg": self.slope_deg,
            "hub": lift.tolist(),
            "attitude": [math.cos(turn / 2), 0.0, math.sin(turn / 2), 0.0],
            "nodes": (nodes + lift).tolist(),
            "hoops": self._hoops,
            "strip_mm": 0.13 * self.radius_mm,
            "coils": self._coils(ends, lift, turn),
            "energy_j": self.energy_j(),
            "terrain_mm": self.terrain_mm,
        }

    def height_mm(self):
        """Return the height of the lowest point."""
        return 0.0

    def energy_j(self):
        """Return the energies of the body."""
        turning = 2e-5 if 0.2 < self.t_s / STEP_S % 1.0 < 0.5 else 0.0
        return {"kinetic": turning, "gravity": 2e-3, "elastic": 1e-3}

    def since_s(self, label):
        """Return how long ago a coil was first driven, negative when it is still to come."""
        return self.t_s - STEP_S * FORWARD.index(label) if label in FORWARD else -1.0

    def degc(self, label):
        """Return a coil's temperature: hot while driven, cooling after it."""
        since = self.since_s(label)
        cooled = math.exp(-max(0.0, since - self.driven_s) / 2.0)
        return 25.0 + 90.0 * (1 - math.exp(-since / 0.4)) * cooled if since > 0 else 25.0

    def duty(self, label):
        """Return a coil's duty: boost, then hold."""
        since = self.since_s(label)
        return 1.0 if 0 <= since < 0.8 else 0.34 if 0.8 <= since < self.driven_s else 0.0

    def _coils(self, ends, hub, turn):
        coils = {}
        for i, label in enumerate(LABELS):
            start = hub + self._turned(self.attach_mm * direction(label)[None], turn)[0]
            if label in SQUARE:
                start, label_to = ends[label], SQUARE[(i - len(SPOKES) + 1) % 4]
            end = ends[label_to] if label in SQUARE else ends[label]
            state = {"degc": self.degc(label), "force_n": 0.1, "duty": self.duty(label)}
            coils[label] = {**state, "from": start.tolist(), "to": end.tolist()}
        return coils

    def _dented(self, places):
        depth = np.zeros(len(places))
        for label in SPOKES:
            share = (self.degc(label) - 25.0) / 90.0
            if share:
                between = np.arccos(np.clip(places @ direction(label), -1, 1))
                depth += 0.35 * share * np.exp(-((between / 0.4) ** 2))
        return self.radius_mm * (1 - np.minimum(depth, 0.6))[:, None] * places

    def _turned(self, places, turn):
        c, s = math.cos(turn), math.sin(turn)
        return places @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T

    def _turn(self):
        step, phase = divmod(self.t_s / STEP_S, 1.0)
        return (step + min(1.0, max(0.0, (phase - 0.2) / 0.3))) * math.pi / 4


class JumpingSphere(RollingSphere):
    """An observer of a sphere whose bottom is pulled in, locked, and snaps out: it flies and lands."""

    def observe(self):
        """Return what is told of a jump once it is done."""
        told = {"stored_mj": 36.0, "released_mj": 20.4, "takeoff_m_per_s": 1.91, "takeoff_s": 4.945}
        jump = {**told, "apex_mm": 186.2, "losses_mj": 11.3} if self.t_s > APEX_S else None
        return {"travel_mm": 0.0, "lateral_mm": 0.0, "apex_mm": self.height_mm(), "jump": jump}

    def height_mm(self):
        """Return the height of the lowest point: a parabola between snap and landing."""
        if not SNAP_S < self.t_s < LANDED_S:
            return 0.0
        return max(0.0, RISE_MM - 1e3 * GRAVITY / 2 * (self.t_s - APEX_S) ** 2)

    def energy_j(self):
        """Return the energies: stored slowly, released in 20 ms, and flight."""
        gravity = 1.8e-3 + MASS_KG * GRAVITY * 1e-3 * self.height_mm()
        moving = SNAP_S < self.t_s < LANDED_S
        kinetic = MASS_KG / 2 * (GRAVITY * (self.t_s - APEX_S)) ** 2 if moving else 0.0
        loaded = 36e-3 * min(1.0, max(0.0, self.t_s - 0.4) / 4.0)
        elastic = loaded if self.t_s <= SNAP_S else 16e-3 * (1 + 0.2 * math.cos((self.t_s - SNAP_S) * 500))
        return {"kinetic": kinetic, "gravity": gravity, "elastic": elastic}

    def since_s(self, label):
        """Return how long ago a coil was first driven."""
        return self.t_s - DRIVEN_S[label][0] if label in DRIVEN_S else -1.0

    def duty(self, label):
        """Return a coil's duty: boost, then hold, until its own end."""
        since = self.since_s(label)
        if since < 0 or self.t_s >= DRIVEN_S[label][1]:
            return 0.0
        return 1.0 if since < 0.72 else 0.34

    def degc(self, label):
        """Return a coil's temperature: hot while driven, cooling after it."""
        since = self.since_s(label)
        if since <= 0:
            return 25.0
        cooled = math.exp(-max(0.0, self.t_s - DRIVEN_S[label][1]) / 2.0)
        return 25.0 + 95.0 * (1 - math.exp(-since / 0.4)) * cooled

    def _dented(self, places):
        squash = min(0.3, 0.1 * self.t_s) if self.t_s <= SNAP_S else 0.1 * math.cos((self.t_s - SNAP_S) * 60)
        shaped = np.array(places) * [1 + squash / 3, 1 + squash / 3, 1 - squash]
        bottom = np.arccos(np.clip(-places[:, 2], -1, 1))
        shaped[:, 2] += (0.55 if 1.0 < self.t_s <= SNAP_S else 0.0) * np.exp(-((bottom / 0.5) ** 2))
        return self.radius_mm * shaped

    def _turn(self):
        return 0.0


def recorded_sphere(seconds=20.0, observer=None, title="sphere-b-crawl.gait on sim:sphere-b"):
    """Return the Recording of such a run, a record each 50 ms and a scene each 50 ms, in a jump each 5 ms."""
    sphere = observer or RollingSphere()
    recording = Recording(LABELS, title)
    recording.note(Event(1000, 0, "started", 0, 0, None, 0))
    for i in range(int(seconds * 200) + 1):
        sphere.t_s = i / 200
        if i % 10 == 0:
            recording.note(_telemetry(sphere, 5 * i))
        if i % 10 == 0 or (isinstance(sphere, JumpingSphere) and SNAP_S - 0.1 < sphere.t_s < LANDED_S + 0.1):
            recording.look(sphere, 1000 + 5 * i)
    return recording


def recorded_jump(seconds=6.0):
    """Return the Recording of a jump."""
    return recorded_sphere(seconds, JumpingSphere(), "sphere-b-jump.gait on sim:sphere-b")


def _telemetry(sphere, now_ms):
    duty = tuple(round(1000 * sphere.duty(label)) for label in LABELS)
    degc = tuple(round(sphere.degc(label) + 0.6, 1) for label in LABELS)
    current_ma = sum(duty) // 4
    return Telemetry(1000 + now_ms, now_ms, "running", 1, 5000 - current_ma // 50, current_ma, 26.5, duty, degc)
