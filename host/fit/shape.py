"""The number that stands for a block's and an indenter's geometry: force per modulus and depth, in metres.

The bench's observer tells it for an indenter whose contact does not grow; for a press on the table it is given by hand,
from an elastic computation or a calibration with a known material.
"""

from __future__ import annotations

import json
from typing import Any

from host.errors import BadRequest
from host.logbook import Log

GROWS = ("cylinder", "polygon")


def shape_of(log: Log) -> float:
    """Return what the observer told of the first contact [m]; BadRequest says why there is no such number."""
    seen = _observed(log)
    shape_m = seen.get("shape_m")
    if shape_m is not None:
        return float(shape_m)
    indenter = (seen.get("model") or {}).get("indenter")
    if indenter in GROWS:
        raise BadRequest(
            f"{log.path} is of a {indenter}, whose contact grows with the depth, so that its force has no closed form:"
            " press with a flat punch, sim:press?indenter=flat or bonded"
        )
    if seen.get("poisson_one") is False:
        raise BadRequest(
            f"{log.path} is of a material whose parts differ in Poisson ratio: its force has no closed form; give all"
            " parts one ratio"
        )
    raise BadRequest(
        f"{log.path} does not tell the force per modulus and depth of its block and indenter: give it, --shape 45.9mm"
    )


def _observed(log: Log) -> dict[str, Any]:
    """Return what an observer saw at the first contact, or at last where none was seen, or nothing."""
    scenes = log.rows.get("scenes", [])
    for scene in [*(each for each in scenes if each.get("touching")), *scenes[-1:]]:
        return dict(scene["observed"])
    report = json.loads(log.attachments.get("report.json", b"{}"))
    return dict(report.get("observed") or {})
