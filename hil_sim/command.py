"""The bench's commands of the command line: `softrig sim` and `softrig robots`."""

from __future__ import annotations

import json
import signal
from collections.abc import Callable
from contextlib import ExitStack
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from hil_sim.address import Address
    from hil_sim.bench import Bench


class NoRobot(click.ClickException):
    """There is no robot, or no port for it."""

    exit_code = 3


class Speed(click.FloatRange):
    """A number within a range; "nan" is no number."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number, or fail."""
        number = float(super().convert(value, param, ctx))
        if isnan(number):
            self.fail(f"{value!r} is not a number", param, ctx)
        return number


@click.command()
@click.argument("name")
@click.option("--link", type=click.Path(path_type=Path), help="Keep a symbolic link to the port at this path.")
@click.option("--tcp", type=click.IntRange(0, 65_535), help="Listen on 127.0.0.1 too; 0 takes any free port.")
@click.option("--listen", metavar="ADDRESS", help="Where --tcp listens, if others may come: needs a key.")
@click.option("--key", type=click.Path(dir_okay=False), help="Give the robot the pairing key in this file.")
@click.option("--speed", type=Speed(0.01, 100), default=1.0, help="Virtual seconds in one real second.")
@click.option("--seed", type=click.IntRange(0, 2**32 - 1), help="Identity of the run.")
@click.option("--slope", type=float, help="Slope of the ground in degrees, uphill positive.")
@click.option("--faults", type=click.Path(dir_okay=False), help="Let the faults of this file happen.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object per line.")
def sim(
    name: str,
    link: Path | None,
    tcp: int | None,
    listen: str | None,
    key: str | None,
    speed: float,
    seed: int | None,
    slope: float | None,
    faults: str | None,
    as_json: bool,
) -> None:
    """Run a robot on the bench behind a serial port, in real time.

    NAME is a robot of the bench or the path of a robot file, with options as in an address: circular?mu=0.1.
    Prints where it listens; Ctrl-C ends it and prints what was observed.
    """
    from hil_sim.link import BOOTED_US  # noqa: PLC0415
    from hil_sim.ports import PortError  # noqa: PLC0415
    from hil_sim.soundness import CameApart  # noqa: PLC0415

    address = _address(name, seed, slope, faults, key)
    if listen and tcp is None:
        raise click.UsageError("--listen says where a TCP port listens: add --tcp PORT")
    place = None if tcp is None else (_listening(listen, address), tcp)
    bench = _bench(address)
    try:
        bench.clock.run_until(BOOTED_US)
        _serve(bench, name, link, place, speed, as_json)
    except PortError as error:
        raise NoRobot(str(error)) from error
    except CameApart as error:
        raise click.ClickException(str(error)) from error
    finally:
        bench.close()


@click.command()
@click.option("--json", "as_json", is_flag=True, help="One JSON object per line.")
def robots(as_json: bool) -> None:
    """List the robots of the bench."""
    from hil_sim.robotfile import RobotFileError, load, names  # noqa: PLC0415

    for name in names():
        try:
            robot = load(name)
        except RobotFileError as error:
            raise NoRobot(str(error)) from error
        address, labels = f"sim:{name}", list(robot.labels)
        fields = {"robot": name, "address": address, "kind": robot.kind, "about": robot.about, "coils": labels}
        coils = click.wrap_text(" ".join(labels), 100, "    ", "    ")
        _say(as_json, fields, f"{address:13} {len(labels):2} coils  {robot.about}\n{coils}")


def _address(name: str, seed: int | None, slope: float | None, faults: str | None, key: str | None) -> Address:
    from hil_sim.address import AddressError, parse  # noqa: PLC0415

    try:
        address = parse(name)
    except AddressError as error:
        raise click.UsageError(str(error)) from error
    _override(address, seed, slope)
    address.faults = faults or address.faults
    address.key = key or address.key
    return address


def _listening(listen: str | None, address: Address) -> str:
    """Return the address that a TCP port listens at: of this machine alone, unless the robot has a key."""
    from ipaddress import ip_address  # noqa: PLC0415

    from hil_sim.ports import LOOPBACK  # noqa: PLC0415

    try:
        place = ip_address(listen or LOOPBACK)
    except ValueError:
        raise click.UsageError(f"--listen {listen}: write an IP address, such as 0.0.0.0 for all") from None
    if not (place.is_loopback or address.key):
        raise click.UsageError(f"--listen {listen}: others may come there, so the robot needs a key: --key FILE")
    return str(place)


def _bench(address: Address) -> Bench:
    try:
        return _assembled(address)
    except LookupError as error:
        raise NoRobot(str(error)) from error
    except ValueError as error:
        raise click.UsageError(str(error)) from error


def _assembled(address: Address) -> Bench:
    from hil_sim.assembly import assemble  # noqa: PLC0415

    return assemble(address)


def _override(address: Address, seed: int | None, slope: float | None) -> None:
    from hil_sim.address import SHORT  # noqa: PLC0415

    if seed is not None:
        address.seed = seed
    if slope is not None:
        address.overrides[SHORT["slope"]] = str(slope)


def _serve(
    bench: Bench, name: str, link: Path | None, tcp: tuple[str, int] | None, speed: float, as_json: bool
) -> None:
    from hil_sim.announcement import Announcement  # noqa: PLC0415
    from hil_sim.ports import Pace, Port, Pty, Tcp, serve  # noqa: PLC0415

    with ExitStack() as stack:
        pty = stack.enter_context(Pty(link))
        ports: list[Port] = [pty]
        where: dict[str, Any] = {"robot": name, "pty": pty.path, "link": str(link.absolute()) if link else None}
        if tcp is not None:
            server = stack.enter_context(Tcp(tcp[1], tcp[0]))
            ports.append(server)
            where["tcp"] = f"socket://{f'[{tcp[0]}]' if ':' in tcp[0] else tcp[0]}:{server.port}"
        ended = _until_a_signal(stack)
        stack.enter_context(Announcement(where))
        places = ", ".join(str(where[key]) for key in ("link", "pty", "tcp") if where.get(key))
        _say(as_json, {"event": "listening", **where, "speed": speed}, f"{name} listens on {places}; Ctrl-C ends it")
        pace = Pace(speed)
        serve(bench, ports, pace, ended)
        seen = {**bench.observe(), "slipped_s": round(pace.slipped_s, 3)}
    _say(as_json, {"event": "observed", **seen}, "\n".join(f"{key}: {_short(value)}" for key, value in seen.items()))


def _until_a_signal(stack: ExitStack) -> Callable[[], bool]:
    """Return a function that says whether the operator has ended the bench; handlers are put back with the stack."""
    came: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        before = signal.signal(number, lambda number, _: came.append(number))
        stack.callback(signal.signal, number, before)
    return lambda: bool(came)


def _say(as_json: bool, fields: dict[str, Any], text: str) -> None:
    click.echo(json.dumps(fields, default=float) if as_json else text)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, dict):
        return " ".join(f"{key}={_short(item)}" for key, item in value.items())
    return str(value)
