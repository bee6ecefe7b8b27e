"""What hosts do in a trial: run a script of gaits/, give random legal orders, or speak the bare protocol.

Every job works until a time of the line's clock or until an error ends it, and draws what it does from a generator.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from random import Random
from zlib import crc32

from hil_sim.link import SimLink
from host.definitions import dictionary_of
from host.gait.compiler import compile_script
from host.gait.script import load
from host.pairing import Opening
from host.profile import Profile, read_profile
from host.robot import ENDS, Robot
from host.run import TELEMETRY_MS
from protocol import messages, program
from protocol.link import Link
from tests import job_programs, limb_jobs
from tests.witness import profile_text

COOL_MS = 1500
GAITS = Path(__file__).parents[1] / "gaits"
Job = Callable[[SimLink, Random, float], None]


@cache
def scripts_of(robot: str) -> tuple[str, ...]:
    """Return the names of a robot's scripts."""
    paths = sorted(GAITS.glob("*.gait"))
    return tuple(path.stem for path in paths if f"\nrobot {robot}\n" in path.read_text())


def job_of(name: str) -> Job:
    """Return the job of that name, or the one that runs the script of that name."""
    return JOBS[name] if name in JOBS else lambda link, draw, until_s: play(link, name, until_s)


def play(link: SimLink, script: str, until_s: float) -> None:
    """Run a script again and again."""
    robot = connected(link)
    code = _compiled(script, profile_text(link.bench))
    while link.now_s() < until_s:
        _run(robot, code, until_s)


def give_orders(link: SimLink, draw: Random, until_s: float) -> None:
    """Fire random coils, or drive joints, within every limit that the robot states, with pauses."""
    robot = connected(link)
    robot.arm()
    while link.now_s() < until_s:
        if robot.profile.joint_labels:
            limb_jobs.drive(robot, draw)
        else:
            coils, duty, hold_ms = _order(draw, robot.profile)
            robot.fire(robot.profile.named(coils), duty, hold_ms)
        for _ in robot.listen(draw.randrange(20, 800)):
            pass


def upload_orders(link: SimLink, draw: Random, until_s: float) -> None:
    """Run random programs whose every order is legal, some of which may outlive their host."""
    robot = connected(link)
    while link.now_s() < until_s:
        ops = [_op(draw, robot.profile) for _ in range(draw.randrange(1, 6))]
        code = job_programs.whole(ops, draw)
        flags = program.OUTLIVES_HOST if draw.random() < 0.2 else 0
        job_programs.play(robot, program.header(code, robot.profile.crc, flags) + code, draw, until_s)


def speak_bare(link: SimLink, draw: Random, until_s: float) -> None:
    """Arm and drive in bare frames, as a stranger's client: what the robot answers is acknowledged and not believed."""
    text = profile_text(link.bench)
    profile, session = read_profile(text), draw.randrange(1, 1 << 32)
    client = Link()
    client.begin(crc32(dictionary_of(text)), session)
    client.post(messages.HELLO.number, Opening(session).payload())
    _exchange(link, client, 0.1)
    client.send(messages.ARM.number, messages.ARM.pack(session=session, lease_ms=0, without=0), _now_ms(link))
    while link.now_s() < until_s:
        if client.room() and draw.random() < 0.3:
            message, payload = _payload(draw, profile)
            client.send(message.number, payload, _now_ms(link))
        client.acknowledge()
        _exchange(link, client, draw.uniform(0.01, 0.3))


JOBS: dict[str, Job] = {"orders": give_orders, "programs": upload_orders, "bare": speak_bare}


def connected(link: SimLink) -> Robot:
    """Return a host that knows the robot and gets its telemetry."""
    robot = Robot(link)
    robot.connect()
    robot.subscribe(TELEMETRY_MS)
    return robot


def cleared(link: SimLink) -> None:
    """Have the robot leave the tripped state, if that is where it is."""
    robot = Robot(link)
    robot.connect()
    if robot.status().state == "tripped":
        for _ in robot.listen(COOL_MS):
            pass
        robot.clear()


def _run(robot: Robot, code: bytes, until_s: float) -> None:
    """Upload and run a program; come back when it has ended, or at `until_s`."""
    robot.upload(code[: program.HEADER_BYTES], code[program.HEADER_BYTES :])
    robot.arm()
    robot.start()
    while robot.link.now_s() < until_s:
        for record in robot.listen(100):
            if getattr(record, "event", "") in ENDS:
                return


def _order(draw: Random, profile: Profile) -> tuple[int, int, int]:
    """Return coils, duty and hold of a legal order."""
    most, count = profile.supply.at_once_max, len(profile.channels)
    chosen = draw.sample(range(count), draw.randint(1, max(1, min(most, 3) - 1)))
    if draw.random() < 0.5:
        duty, hold_ms = profile.coil.duty_max_permille, draw.randint(20, 600)
    else:
        duty, hold_ms = draw.randint(1, profile.coil.duty_max_permille // 3), draw.randint(20, 5000)
    return sum(1 << channel for channel in chosen), duty, hold_ms


def _payload(draw: Random, profile: Profile) -> tuple[messages.Message, bytes]:
    """Return a legal order as it goes on the line."""
    if profile.joint_labels:
        return limb_jobs.payload(draw, profile)
    coils, duty, hold_ms = _order(draw, profile)
    return messages.FIRE, messages.FIRE.pack(coils=coils, duty_permille=duty, hold_ms=hold_ms)


def _op(draw: Random, profile: Profile) -> bytes:
    """Return a piece of a program: an order, and most often a pause."""
    if profile.joint_labels:
        return limb_jobs.op(draw, profile)
    coils, duty, time_ms = _order(draw, profile)
    fires = (program.fire(coils, duty, time_ms), program.ramp(coils, duty, time_ms, 900, draw.randint(0, time_ms)))
    return draw.choice(fires) + program.delay(draw.choice((0, time_ms, draw.randint(1, 2000))))


def _exchange(link: SimLink, client: Link, seconds: float) -> None:
    """Write what is due and take what comes within so long."""
    link.write(client.poll(_now_ms(link)))
    clock = link.bench.clock
    until_us = clock.now_us + round(seconds * 1e6)
    while clock.now_us < until_us:
        client.receive(link.read(until_us / 1e6), _now_ms(link))


def _now_ms(link: SimLink) -> int:
    return round(link.now_s() * 1000)


@cache
def _compiled(script: str, profile: bytes) -> bytes:
    return compile_script(load(GAITS / f"{script}.gait"), read_profile(profile)).program
