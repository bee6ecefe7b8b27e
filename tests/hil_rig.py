"""A robot on the bench with a host at its line, for HIL tests: every layer real, time virtual.

rig = HilRig("sim:circular")
rig.fire("A", duty_percent=80, hold_s=0.3)
rig.run(seconds=0.1)
rig.happens("cable-cut")
"""

from dataclasses import dataclass

from hil_sim.faults.happening import schedule
from hil_sim.link import open_link
from host.robot import Robot


@dataclass(frozen=True)
class CoilState:
    """What was done to one coil; times are seconds of the bench's clock."""

    duty_percent: float
    on_at_s: float | None
    off_at_s: float | None
    degc: float


class HilRig:
    """One robot that is connected; leaving it to the garbage collector is fine."""

    def __init__(self, address: str = "sim:circular") -> None:
        self.link = open_link(address)
        self.bench = self.link.bench
        self.robot = Robot(self.link)
        self.robot.connect()

    def connect_again(self) -> None:
        """Greet the robot as a host that was started anew."""
        self.robot = Robot(self.link)
        self.robot.connect()

    @property
    def now_s(self) -> float:
        """Return the bench's clock."""
        return self.link.now_s()

    def fire(self, *coils: str, duty_percent: float, hold_s: float, without: tuple[str, ...] = ()) -> float:
        """Arm if need be, fire, and return the time at which the first coil was switched on."""
        if self.robot.status().state == "idle":
            self.robot.arm(without=without)
        self.robot.fire(coils, round(duty_percent * 10), round(hold_s * 1000))
        return self.coil(coils[0]).on_at_s

    def run(self, seconds: float) -> list:
        """Let time pass with the host alive; return what the robot told."""
        return list(self.robot.listen(round(seconds * 1000)))

    def run_alone(self, seconds: float) -> None:
        """Let time pass without a host, as after its process was killed."""
        self.bench.run(seconds)

    def happens(self, fault: str) -> float:
        """Let a fault happen now; return the time."""
        schedule(self.bench, self.bench.clock.now_us, fault)
        return self.now_s

    def later(self, seconds: float, fault: str) -> None:
        """Let a fault happen that long from now."""
        schedule(self.bench, self.bench.clock.now_us + round(seconds * 1e6), fault)

    def coil(self, label: str) -> CoilState:
        """Return what is being done to a coil."""
        record = self.bench.coil(label)
        index = list(self.bench.plant.labels).index(label)
        return CoilState(
            duty_percent=record.duty * 100,
            on_at_s=None if record.on_at_us is None else record.on_at_us / 1e6,
            off_at_s=None if record.off_at_us is None else record.off_at_us / 1e6,
            degc=float(self.bench.plant.temperature[index]),
        )
