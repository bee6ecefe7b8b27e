"""What each message, field and variable means: the comment beside it in protocol/messages.py and variables.py.

The words stand in the tables, where they are read with the rows they explain, but as comments: a board has no room
for text that only documents print. A comment may go on in lines of its own.

    words = read()
    words["fire"], words["fire.hold_ms"], words["var.supply_mv"]
"""

import ast
import io
import tokenize
from collections.abc import Iterator
from pathlib import Path

from protocol import messages, variables


def read(source: str | None = None) -> dict[str, str]:
    """Return the meanings by `message`, `message.field` and `var.variable`; ValueError names one that has none."""
    if source is None:
        files = [Path(module.__file__) for module in (messages, variables)]
        return {
            name: text for file in files for name, text in _read(file.read_text(encoding="utf-8"), file.name).items()
        }
    return _read(source, "messages.py")


def _read(text: str, file: str) -> dict[str, str]:
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    comments = [token for token in tokens if token.type == tokenize.COMMENT]
    beside = {token.start[0]: token.string for token in comments}
    alone = {token.start[0] for token in comments if not token.line[: token.start[1]].strip()}
    found = {}
    for name, line in _rows(ast.parse(text)):
        if line not in beside:
            raise ValueError(f"{file}:{line}: {name} has no comment that says what it means")
        found[name] = " ".join(_comment(beside, alone, line))
    return found


def _comment(beside: dict[int, str], alone: set[int], line: int) -> Iterator[str]:
    """Yield the comment beside a line, and those that go on below it."""
    yield beside[line].removeprefix("# ")
    while (line := line + 1) in alone:
        yield beside[line].removeprefix("# ")


def _rows(tree: ast.Module) -> Iterator[tuple[str, int]]:
    """Yield each message, each of its fields and each variable with the line that its name stands on."""
    for statement in tree.body:
        if isinstance(statement, ast.Assign) and isinstance(statement.value, ast.Tuple):
            for row in statement.value.elts:
                if _is_call(row, "Variable"):
                    yield f"var.{row.args[0].value}", row.lineno
        if not isinstance(statement, ast.Assign) or not _is_call(statement.value, "Message"):
            continue
        _, name, *fields = statement.value.args
        yield name.value, name.lineno
        for field in fields:
            yield f"{name.value}.{field.args[0].value}", field.lineno


def _is_call(node: ast.expr, name: str) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == name
