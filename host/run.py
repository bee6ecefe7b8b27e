"""One run of a compiled script on one robot: upload, arm, start, watch to its end, disarm.

ending = run(robot, compiled.program, progress)
ending.result                        # "done", "guard", "timeout", "fault", ...
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from host.errors import LinkLost, Refused, RobotFault, ScriptFailed, SoftrigError
from host.records import Event, Record
from host.robot import Robot
from host.stream import AT, AT_MS, SLOT, Stream
from protocol import causes, codes, program

TELEMETRY_MS = 50
FINE_MS = 10  # from what a press does to what a material is: `softrig fit`
FINE, FINE_SLOT = ("load_mn", "joint_centi", "commanded_centi"), 1
PATIENCE_MS = 10_000  # with a line that breaks while the program runs
COOL_MS = 2 * TELEMETRY_MS  # after the end, so that the record ends with every coil off
ABORTS = {
    0: "cancelled", codes.WAIT_TIMEOUT: "timeout", codes.CAMERA: "camera lost", codes.STARVED: "starved",
}  # fmt: skip

Take = Callable[[Record], None]  # looks at each record that comes while a program runs


class Progress(Protocol):
    """Whoever shows how far a run has come."""

    def __call__(self, stage: str, done: float) -> None:
        """Show that of `stage` ("upload", "self-test", "run") this many bytes, channels or seconds are done."""


@dataclass(frozen=True, slots=True)
class Ending:
    """How a run ended; `event` is the robot's last word, about a channel of that `kind`; `lost` why there is none.

    `refused` is why it took no more of a streamed program.
    """

    result: str
    event: Event | None = None
    lost: LinkLost | None = None
    kind: str = "coil"
    unit: str = "deg"  # of joints
    refused: Refused | None = None

    def error(self) -> SoftrigError | None:
        """Return what the caller should raise, or None when the script ran to its end."""
        if self.lost or self.event is None or self.result == "done":
            return self.lost
        if self.result == "starved" and self.refused:
            return self.refused
        if self.result in ("guard", "refused", *ABORTS.values()):
            return ScriptFailed(f"the script ended early: {_cause(self.event)}")
        if self.result == "lease":
            return LinkLost("the robot heard nothing from this host for its lease and switched everything off")
        return RobotFault(self.event.code, self.event.value, self.event.coil, self.kind, self.unit)


@dataclass(frozen=True, slots=True)
class IfLost:
    """What to do when the line breaks: go on when it is back, or only stop the robot; up to `patience_ms` later."""

    stops: bool = False
    patience_ms: int = PATIENCE_MS


def run(
    robot: Robot,
    code: bytes,
    progress: Progress,
    without: tuple[str, ...] = (),
    if_lost: IfLost | None = None,
    finely: bool = False,
    streamed: bool = False,
    stepper: Take | None = None,
) -> Ending:
    """Run a program (header and code) on a robot that is connected, and watch it to its end.

    Coils of `without` are known to be broken: whatever the program orders, they stay cold. With `finely` a robot with a
    load cell tells force and depth a hundred times a second, beside its telemetry. A `streamed` program is sent while
    it runs. With a `stepper` it stands still at its beginning until that has it go on.
    """
    stream = announce(robot, code, progress, streamed)
    robot.subscribe(TELEMETRY_MS)
    if finely and robot.profile.load is not None:
        robot.subscribe(FINE_MS, FINE, slot=FINE_SLOT)
    robot.arm(without=without)
    progress("self-test", len(robot.profile.labels))
    if stream or stepper:
        robot.subscribe(AT_MS, [AT], slot=SLOT)
    robot.start(paused=stepper is not None)
    takers = [stream.take] if stream else []
    ending = watch(robot, progress, if_lost or IfLost(), [*takers, stepper] if stepper else takers)
    return replace(ending, refused=stream.refused) if stream else ending


def watch(robot: Robot, progress: Progress, if_lost: IfLost, takers: Sequence[Take] = ()) -> Ending:
    """Watch a running program to its end; a line that stays broken ends it too. The takers are shown every record."""
    robot.endure(if_lost.patience_ms, if_lost.stops)
    try:
        event = _watched(robot, progress, takers)
        if event.event in ("finished", "aborted"):
            robot.disarm()
    except LinkLost as lost:
        robot.leave()
        return Ending("link lost", None, lost)
    if if_lost.stops and robot.interruptions() and event.code == codes.STOP:
        cause = robot.interruptions()[-1].cause
        return Ending("link lost", event, LinkLost(f"{cause}; once it was back, the robot was stopped, as asked"))
    parts = robot.profile.parts
    return Ending(_result(event), event, kind=parts.kind(event.coil), unit=parts.unit)


def outliving(code: bytes) -> bytes:
    """Return the program (header and code) as one that runs on when its host is gone."""
    read = program.read_header(code[: program.HEADER_BYTES])
    body = code[program.HEADER_BYTES :]
    return program.header(body, read.robot_crc, read.flags | program.OUTLIVES_HOST) + body


def announce(robot: Robot, code: bytes, progress: Progress, streamed: bool = False) -> Stream | None:
    """Send a program to a robot that is connected, of a streamed one as much as it holds; nothing moves."""
    if not streamed:
        upload(robot, code, progress)
        return None
    stream = Stream(robot, code)
    progress("upload", stream.begin())
    return stream


def upload(robot: Robot, code: bytes, progress: Progress) -> None:
    """Send a program to a robot that is connected; nothing moves."""
    header, body = code[: program.HEADER_BYTES], code[program.HEADER_BYTES :]
    robot.upload(header, body, lambda taken: progress("upload", taken))


def _watched(robot: Robot, progress: Progress, takers: Sequence[Take]) -> Event:
    """Watch the running program and return the event that ended it; a moment more is recorded, and may yet trip."""
    start_ms = robot.now_ms()
    last = None
    for record in robot.watch():
        progress("run", (record.host_ms - start_ms) / 1000)
        last = record
        for take in takers:
            take(record)
    for record in robot.listen(COOL_MS):
        if isinstance(record, Event) and record.event == "tripped":
            last = record
    if not isinstance(last, Event):
        raise LinkLost("the robot ended the program without a word")
    return last


def _result(event: Event) -> str:
    """Return the word for an ending."""
    if event.event == "finished":
        return "done"
    if event.event == "aborted":
        return ABORTS.get(event.code, "refused")
    if event.event == "disarmed":
        return "lease" if event.code == codes.LEASE_EXPIRED else "cancelled"
    return {codes.GUARD: "guard", codes.STOP: "stopped"}.get(event.code, "fault")


def _cause(event: Event) -> str:
    row = causes.row(event.code)
    return f"{row.name} {row.cause} {row.todo}" if row else f"it was {event.event}"
