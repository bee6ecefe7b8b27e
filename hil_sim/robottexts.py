"""What is no number in a robot file: its texts, the labels of its coils and where each of them is soldered.

    for name, what in mistakes_in(sections, kind): ...

`sections` are the file's tables by name, "" what stands above them; `name` is the section.key that a mistake is at.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from hil_sim.directions import direction
from hil_sim.robotkeys import KINDS, SPHERE

CHIPS = (96, 97)  # PWM chips of the board
TEXTS = {"": ("about", "profile"), "shell": ("kind",), "coils": ("labels",), "wiring": ("outputs",)}
MAY = {"coils": ("jump_labels",)}  # texts that need not be there

Mistakes = Iterator[tuple[str, str]]
Sections = Mapping[str, dict[str, Any]]


def is_text(section: str, key: str) -> bool:
    """Return whether this key holds no number."""
    return key in TEXTS.get(section, ()) or key in MAY.get(section, ())


def mistakes_in(sections: Sections, kind: str) -> Mistakes:
    """Yield section.key and what is wrong for everything but the numbers, as a robot of that kind should have it."""
    for section, names in TEXTS.items():
        for name in names:
            if name not in sections.get(section, {}):
                yield section, f"{f'[{section}]' if section else 'the file'} lacks {name}"
    for name in TEXTS[""]:
        if not isinstance(sections[""].get(name, ""), str):
            yield name, f'{name}: write it as {name} = "text"'
    given = sections.get("shell", {}).get("kind", kind)
    if given not in KINDS:
        yield "shell.kind", f"kind {given!r} is none of {', '.join(KINDS)}"
    yield from _coils(sections, kind)


def _coils(sections: Sections, kind: str) -> Mistakes:
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
    if kind == SPHERE:
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
