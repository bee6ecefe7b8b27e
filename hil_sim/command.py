"""The bench's commands of the command line: `softrig sim` and `softrig robots`."""

from __future__ import annotations

import json
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from hil_sim.address import Address
    from hil_sim.can.desk import CanDesk


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
@click.option(
    "--can",
    "cans",
    multiple=True,
    metavar="slcan[=LINK]|socketcand[=PORT]",
    help="Serve the CAN bus, too; may be given several times.",
)
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
    cans: tuple[str, ...],
    speed: float,
    seed: int | None,
    slope: float | None,
    faults: str | None,
    as_json: bool,
) -> None:
    """Run robots on the bench, each behind a serial port, in real time.

    NAME is a robot of the bench or the path of a robot file, with options as in an address: circular?mu=0.1. Several
    share a CAN bus: circular@1,sphere-b@2, each with its number there.
    Prints where it listens; Ctrl-C ends it and prints what was observed.
    """
    from hil_sim.ports import PortError  # noqa: PLC0415
    from hil_sim.serving import Serving  # noqa: PLC0415
    from hil_sim.soundness import CameApart  # noqa: PLC0415

    buses = [_can_port(text) for text in cans]
    wanted = _addresses(name, bool(cans), seed, slope, faults, key)
    if listen and tcp is None:
        raise click.UsageError("--listen says where a TCP port listens: add --tcp PORT")
    first = min(wanted, key=lambda address: address.node)  # which the port belongs to, see serving.py
    place = None if tcp is None else (_listening(listen, first), tcp)
    desk = _desk(wanted)
    try:
        with Serving(name, desk, link, place) as serving:
            for kind, argument in buses:
                serving.can(kind, argument)
            serving.run(speed, lambda fields, text: _say(as_json, fields, text))
    except PortError as error:
        raise NoRobot(str(error)) from error
    except CameApart as error:
        raise click.ClickException(str(error)) from error
    finally:
        desk.close()


@click.command()
@click.option("--json", "as_json", is_flag=True, help="One JSON object per line.")
def robots(as_json: bool) -> None:
    """List the robots of the bench."""
    from hil_sim.robots.file import RobotFileError, load, names  # noqa: PLC0415

    for name in names():
        try:
            robot = load(name)
        except RobotFileError as error:
            raise NoRobot(str(error)) from error
        address, labels, joints = f"sim:{name}", list(robot.labels), list(robot.joints)
        fields: dict[str, Any] = {"robot": name, "address": address, "kind": robot.kind, "about": robot.about}
        fields |= {"coils": labels, "joints": joints}
        count = f"{len(labels):2} coils" if labels else f"{len(joints):2} joints"
        parts = click.wrap_text(" ".join([*labels, *joints]), 100, "    ", "    ")
        _say(as_json, fields, f"{address:22} {count:9}  {robot.about}\n{parts}")


def _addresses(
    name: str, on_can: bool, seed: int | None, slope: float | None, faults: str | None, key: str | None
) -> list[Address]:
    """Return the robots of a name; a single one that is on no bus stays without a number."""
    from hil_sim.address import AddressError, parse  # noqa: PLC0415
    from hil_sim.can.desk import addresses  # noqa: PLC0415

    try:
        wanted = addresses(name) if on_can or "," in name.partition("?")[0] or "@" in name else [parse(name)]
    except AddressError as error:
        raise click.UsageError(str(error)) from error
    if faults and len(wanted) > 1:
        raise click.UsageError("--faults is for one robot: write faults=FILE as an option of the one that is meant")
    for address in wanted:
        _override(address, seed, slope)
        address.faults = faults or address.faults
        address.key = key or address.key
    return wanted


def _can_port(text: str) -> tuple[str, str]:
    """Return the kind of a port of the CAN bus, and where it is to be."""
    kind, equals, place = text.partition("=")
    if kind not in ("slcan", "socketcand") or (equals and not place):
        raise click.UsageError(f"--can {text}: write slcan, slcan=LINK, socketcand or socketcand=PORT")
    if kind == "socketcand" and place and not (place.isdecimal() and int(place) < 65_536):
        raise click.UsageError(f"--can {text}: a TCP port is a number up to 65535, 0 takes any free one")
    return kind, place


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


def _desk(wanted: list[Address]) -> CanDesk:
    from hil_sim.can.desk import CanDesk  # noqa: PLC0415

    try:
        return CanDesk(wanted)
    except LookupError as error:
        raise NoRobot(str(error)) from error
    except ValueError as error:
        raise click.UsageError(str(error)) from error
    except OSError as error:
        raise click.ClickException(str(error)) from error


def _override(address: Address, seed: int | None, slope: float | None) -> None:
    from hil_sim.address import SHORT  # noqa: PLC0415

    if seed is not None:
        address.seed = seed
    if slope is not None:
        address.overrides[SHORT["slope"]] = str(slope)


def _say(as_json: bool, fields: dict[str, Any], text: str) -> None:
    click.echo(json.dumps(fields, default=float) if as_json else text)
