"""What is no number in a robot file: its texts, the labels of its coils or joints and where each of them is soldered.

    for name, what in mistakes_in(sections, features): ...

`sections` are the file's tables by name, "" what stands above them; `name` is the section.key that a mistake is at.
"""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from hil_sim.bodies.directions import direction
from hil_sim.robots.keys import COILS, FINGERS, PRESS, RING, SERVOS, SHELL, SPHERE

CHIPS = (96, 97)  # PWM chips of the board
PINS = (8, 9, 10)  # of the board, for servos
JOINTS = {FINGERS: (2, '["R", "L"], the right finger first'), PRESS: (1, '["P"]')}  # how many, and how they are written
PLACES = {
    "centres_percent": "of the block's width and height",
    "centres_mm": "in the coordinates of the block",
}  # where the force cells are: one of these
CELLS_MAX = 13  # of 16 inputs one has the load cell, and two the axis
Mistakes = Iterator[tuple[str, str]]
Sections = Mapping[str, dict[str, Any]]


@dataclass(frozen=True)
class Text:
    """One thing in a robot file that is no number."""

    section: str
    key: str
    only: str = ""  # robots that have this have the text
    words: tuple[str, ...] = ()  # it is one of these
    needed: bool = True

    @property
    def name(self) -> str:
        """Return section and key."""
        return f"{self.section}.{self.key}" if self.section else self.key


TEXTS = (
    Text("", "about"),
    Text("", "profile"),
    Text("", "kind", SERVOS, (FINGERS, PRESS)),
    Text("shell", "kind", SHELL, (RING, SPHERE)),
    Text("coils", "labels", COILS),
    Text("coils", "jump_labels", COILS, needed=False),
    Text("wiring", "outputs", COILS),
    Text("fingers", "tip", FINGERS, ("nail", "radial")),
    Text("fingers", "contact", FINGERS, ("frictionless", "stick", "coulomb")),
    Text("fingers", "motion", FINGERS, ("quasi-static", "dynamic")),
    Text("fingers", "labels", FINGERS),
    Text("press", "labels", PRESS),
    Text("press", "indenter", PRESS, ("cylinder", "flat", "bonded", "polygon")),
    Text("press", "corners_mm", PRESS, needed=False),
    Text("press", "plane", PRESS, ("strain", "stress")),
    Text("press", "mesh", PRESS, needed=False),
    Text("cells", "centres_percent", PRESS, needed=False),
    Text("cells", "centres_mm", PRESS, needed=False),
    Text("wiring", "pins", SERVOS),
)
CHOICES = {text.name: text.words for text in TEXTS if text.section in (FINGERS, PRESS) and text.words}
"""The texts that an address may set, and what it may set them to."""


def texts_of(features: Collection[str]) -> tuple[Text, ...]:
    """Return the texts that a robot with these features has."""
    return tuple(text for text in TEXTS if not text.only or text.only in features)


def mistakes_in(sections: Sections, features: Collection[str]) -> Mistakes:
    """Yield section.key and what is wrong for everything but the numbers, as a robot with these features has it."""
    for text in texts_of(features):
        value = sections.get(text.section, {}).get(text.key)
        if value is None and text.needed:
            yield text.name, f"{f'[{text.section}]' if text.section else 'the file'} lacks {text.key}"
        elif value is not None and text.words and value not in text.words:
            yield text.name, f"{text.key} {value!r} is none of {', '.join(text.words)}"
        elif text.name in ("about", "profile") and not isinstance(value, str):
            yield text.name, f'{text.key}: write it as {text.key} = "text"'
    if COILS in features:
        yield from _coils(sections, SPHERE in features)
    for section, (count, example) in JOINTS.items():
        if section in features:
            yield from _joints(sections, section, count, example)
    if PRESS in features:
        yield from _pressed(sections)


def _coils(sections: Sections, in_hoops: bool) -> Mistakes:
    coils, wiring = (sections.get(name, {}) for name in ("coils", "wiring"))
    spokes, points = coils.get("labels", []), coils.get("jump_labels", [])
    for name, labels in (("labels", spokes), ("jump_labels", points)):
        if not (isinstance(labels, list) and all(isinstance(label, str) for label in labels)):
            yield f"coils.{name}", f'{name}: write them as ["A", "B", ...]'
            return
    if not spokes:
        yield "coils.labels", "labels: a robot has at least one coil"
        return
    if len({*spokes, *points}) < len(spokes) + len(points):
        yield "coils.labels", "labels: each coil needs its own"
        return
    if in_hoops:
        yield from _directions("labels", spokes)
        yield from _directions("jump_labels", points)
    elif points:
        yield "coils.jump_labels", "jump_labels: only a sphere has coils between points of its hoops"
    yield from _outputs(wiring.get("outputs", {}), [*spokes, *points])


def _directions(name: str, labels: list[str]) -> Mistakes:
    """Yield what is wrong with labels that should name points, and with coils from each of these to the next."""
    known = []
    for label in labels:
        try:
            known.append(direction(label))
        except ValueError as error:
            yield f"coils.{name}", f"{name}: {error}"
    following = known[1:] + known[:1]
    if name == "jump_labels" and any(a == b for a, b in zip(known, following, strict=True)):
        yield f"coils.{name}", f"{name}: coils run from each point to the next and back to the first: none to itself"


def _outputs(outputs: object, labels: list[str]) -> Mistakes:
    if not isinstance(outputs, dict) or sorted(outputs) != sorted(labels):
        yield "wiring.outputs", f"outputs: one [chip, output] for each of {', '.join(labels)}"
        return
    seen: dict[tuple[int, int], str] = {}
    for label, place in outputs.items():
        if not (isinstance(place, list) and len(place) == 2 and all(type(part) is int for part in place)):
            yield "wiring.outputs", f"outputs: {label} needs [chip address, output number]"
            continue
        chip, output = place
        if chip not in CHIPS:
            known = " and ".join(map(str, CHIPS))
            yield "wiring.outputs", f"outputs: {label} on chip {chip}, the board has {known}"
        if not 0 <= output < 16:
            yield "wiring.outputs", f"outputs: {label} on output {output}, a chip has 0 to 15"
        if (chip, output) in seen:
            yield "wiring.outputs", f"outputs: {label} and {seen[chip, output]} share [{chip}, {output}]"
        seen[chip, output] = label


def _joints(sections: Sections, section: str, count: int, example: str) -> Mistakes:
    """Yield what is wrong with the labels of so many joints, and with the pins of their servos."""
    labels, pins = sections.get(section, {}).get("labels"), sections.get("wiring", {}).get("pins")
    if not (isinstance(labels, list) and len(labels) == count and all(isinstance(label, str) for label in labels)):
        if labels is not None:
            yield f"{section}.labels", f"labels: write them as {example}"
        return
    if len(set(labels)) < count:
        yield f"{section}.labels", "labels: each joint needs its own"
        return
    if pins is None:
        return
    if not isinstance(pins, dict) or sorted(pins) != sorted(labels):
        yield "wiring.pins", f"pins: one pin for each of {', '.join(labels)}, as in {labels[0]} = {PINS[0]}"
        return
    for label, pin in pins.items():
        if type(pin) is not int or pin not in PINS:
            yield "wiring.pins", f"pins: {label} on pin {pin}, the board has servos on {', '.join(map(str, PINS))}"
    if len({pins[label] for label in labels}) < count:
        yield "wiring.pins", f"pins: {' and '.join(labels)} share {pins[labels[0]]}"


def _pressed(sections: Sections) -> Mistakes:
    """Yield what is wrong with the mesh of a press's block, the corners of its polygon, and the places of its cells."""
    press, cells = sections.get("press", {}), sections.get("cells", {})
    if not isinstance(press.get("mesh", ""), str):
        yield "press.mesh", 'mesh: write it as mesh = "block.msh", a file beside this one'
    corners = press.get("corners_mm", [])
    if not (isinstance(corners, list) and all(map(_is_place, corners))):
        yield "press.corners_mm", "corners_mm: write them as [[x, y], ...], x from the axis"
    given = [key for key in PLACES if key in cells]
    if len(given) != 1:
        yield "cells", f"[cells] needs {' or '.join(PLACES)}, and has {' and '.join(given) or 'neither'}"
        return
    centres = cells[given[0]]
    if not (isinstance(centres, dict) and all(map(_is_place, centres.values()))):
        yield f"cells.{given[0]}", f"{given[0]}: write them as {{ C1 = [x, y], ... }}, {PLACES[given[0]]}"
    elif len(centres) > CELLS_MAX:
        yield f"cells.{given[0]}", f"{given[0]}: {len(centres)} cells, the converters have {CELLS_MAX} inputs for them"


def _is_place(value: object) -> bool:
    """Return whether this is a point of two numbers."""
    return isinstance(value, list) and len(value) == 2 and all(type(part) in (int, float) for part in value)
