"""What the sheets of the schematic are drawn with: chips as boxes, the names of nets, remarks."""

import schemdraw.elements as elm


def chip(
    drawing, name: str, at: tuple[float, float], left: list[tuple[str, str]], right: list[tuple[str, str]]
) -> None:
    """Draw a chip at its upper left corner; each pin is (name, net)."""
    rows = max(len(left), len(right))
    pins = [
        elm.IcPin(name=pin, side="left", slot=f"{rows - n}/{rows}", anchorname=f"l{n}")
        for n, (pin, _) in enumerate(left)
    ]
    pins += [
        elm.IcPin(name=pin, side="right", slot=f"{rows - n}/{rows}", anchorname=f"r{n}")
        for n, (pin, _) in enumerate(right)
    ]
    body = elm.Ic(pins=pins, size=(5.0, 0.75 * rows + 0.5), pinspacing=0.75, leadlen=0.5, fontsize=10)
    drawing += body.at(at).anchor("center").label(name, loc="top", fontsize=11)
    for side, nets in (("l", left), ("r", right)):
        for number, (_, net) in enumerate(nets):
            if net:
                place = getattr(body, f"{side}{number}")
                where = "left" if side == "l" else "right"
                drawing += elm.Label().at(place).label(net, loc=where, fontsize=10, color="#0a3d8f")


def net(drawing, place, name: str, where: str = "right") -> None:
    """Name the wire at a place."""
    far = {"bottom": (0, -0.25), "top": (0, 0.1), "left": (-0.1, 0), "right": (0.1, 0)}[where]
    drawing += elm.Dot(open=True).at(place).label(name, loc=where, ofst=far, fontsize=10, color="#0a3d8f")


def note(drawing, place, text: str) -> None:
    """Write a remark."""
    drawing += elm.Label().at(place).label(text, loc="right", halign="left", fontsize=10)
