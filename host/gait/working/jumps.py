"""Labels of a script: where a wait that ran out may go on, further down."""

from __future__ import annotations

from dataclasses import dataclass, field

from host.gait import tree
from host.gait.diagnostics import Problems
from host.gait.script import walk
from protocol import program

CHOICES = {"abort": program.ABORT, "continue": program.CONTINUE}


@dataclass
class Labels:
    """The labels of the main script by name; `passed` are those behind the statement that is worked out."""

    numbers: dict[str, int] = field(default_factory=dict)
    passed: set[str] = field(default_factory=set)
    chosen: dict[str, set[str]] = field(default_factory=dict)  # names chosen whenever a wait goes on there
    misplaced: set[str] = field(default_factory=set)  # labels within blocks, which are reported where they stand

    def jump(self, name: str, chosen: set[str]) -> int:
        """Return how a wait goes on at a label, with what the robot has chosen by then."""
        self.chosen[name] = self.chosen.get(name, chosen) & chosen
        return program.JUMP + self.numbers[name]

    def arrive(self, name: str, chosen: set[str]) -> set[str]:
        """Pass a label; return which names are chosen there, whichever way the robot has come."""
        self.passed.add(name)
        return self.chosen.get(name, chosen) & chosen


def labelled(statements: tuple[tree.Statement, ...], problems: Problems) -> Labels:
    """Return the labels at the top level of a script, numbered in the order of the text."""
    labels = Labels(misplaced={node.name.text for node in walk(statements) if isinstance(node, tree.Label)})
    for node in statements:
        if isinstance(node, tree.Label):
            name = node.name.text
            if name in CHOICES:
                problems.add(node.name.place, "E161", f"`{name}` is a word of the language", "choose another name")
            elif name in labels.numbers:
                problems.add(node.name.place, "E171", f"`{name}` is a label already")
            labels.numbers.setdefault(name, len(labels.numbers))
    return labels


def check_last(statements: tuple[tree.Statement, ...], problems: Problems) -> None:
    """Report an `on fault` that is not the last statement, or not the only one of its kind."""
    catches = [node for node in statements if isinstance(node, tree.OnFault)]
    for node in catches[1:]:
        problems.add(node.place, "E174", "`on fault` is there already", "put both into one block")
    if catches and statements[-1] is not catches[-1] and not isinstance(statements[-1], tree.Broken):
        problems.add(catches[-1].place, "E175", "`on fault` is not the last statement", "move it to the end")
