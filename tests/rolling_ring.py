"""A made-up run for tests of pictures: a ring of true geometry that rolls, with one dented and hot coil at a time."""

import math

from host.recording import Recording
from host.records import Event, Telemetry

LABELS = tuple("ABCDEFGH")
RADIUS_MM = 20.0
NODES = 32
STEP_S = 2.0


class RollingRing:
    """An observer of a ring that turns by 45 degrees in each step of two seconds."""

    def __init__(self, slope_deg=0.0):
        self.t_s = 0.0
        self.slope_deg = slope_deg

    def observe(self):
        """Return the travel, as the bench's observer does."""
        return {"travel_mm": self._turn() * RADIUS_MM}

    def snapshot(self):
        """Return the ring's shape, as the bench's observer does."""
        turn = self._turn()
        rim = [self._node(i, turn) for i in range(NODES)]
        low = min(y for _, y in rim)
        nodes = [[turn * RADIUS_MM + x, y - low] for x, y in rim]
        hub = [turn * RADIUS_MM, -low, -turn]
        coils = {
            label: {"degc": self.degc(i), "duty": self.duty(i), "from": hub[:2], "to": nodes[4 * i]}
            for i, label in enumerate(LABELS)
        }
        return {"t_s": self.t_s, "hub": hub, "nodes": nodes, "coils": coils, "slope_deg": self.slope_deg}

    def degc(self, i):
        """Return the i-th coil's temperature: hot in its own step, cooling after it."""
        since = self.t_s - STEP_S * i
        if since < 0:
            return 25.0
        return 25.0 + 62.0 * (1 - math.exp(-since / 0.4)) * math.exp(-max(0.0, since - STEP_S) / 2.0)

    def duty(self, i):
        """Return the i-th coil's duty: boost, then hold."""
        since = self.t_s - STEP_S * i
        return 1.0 if 0 <= since < 0.7 else 0.32 if 0.7 <= since < STEP_S else 0.0

    def _turn(self):
        step, phase = divmod(self.t_s / STEP_S, 1.0)
        return (step + min(1.0, max(0.0, (phase - 0.2) / 0.3))) * math.pi / 4

    def _node(self, i, turn):
        angle = -math.pi / 2 + 2 * math.pi * i / NODES - turn
        dent = sum(
            (self.degc(c) - 25.0) / 62.0 * 7.0 * math.exp(-((_between(i, 4 * c) * 2 * math.pi / NODES / 0.4) ** 2))
            for c in range(8)
        )
        radius = RADIUS_MM - dent
        return radius * math.cos(angle), radius * math.sin(angle)


def recorded_run(seconds=16.0, slope_deg=0.0, observed=True):
    """Return the Recording of such a run, a record each 50 ms."""
    ring = RollingRing(slope_deg)
    recording = Recording(LABELS, "circular-crawl.gait on sim:circular")
    recording.note(Event(1000, 0, "started", 0, 0, None, 0))
    for i in range(int(seconds * 20) + 1):
        ring.t_s = i / 20
        recording.note(_telemetry(ring, 50 * i))
        if observed:
            recording.look(ring, 1000 + 50 * i)
    return recording


def _telemetry(ring, now_ms):
    duty = tuple(round(1000 * ring.duty(i)) for i in range(8))
    degc = tuple(round(ring.degc(i) + 0.6, 1) for i in range(8))
    current_ma = sum(duty) // 5
    return Telemetry(1000 + now_ms, now_ms, "running", 1, 2000 - current_ma // 50, current_ma, 26.5, duty, degc)


def _between(i, j):
    return min((i - j) % NODES, (j - i) % NODES)
