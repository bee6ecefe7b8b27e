"""Findings in the types of the protocol, and positions of the protocol as lines and columns of a text."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Protocol

from lsprotocol import types
from pygls.exceptions import JsonRpcInvalidParams
from pygls.workspace import PositionCodec

from host.errors import BadRequest
from host.gait.diagnostics import Diagnostic, GaitError
from host.gait.forms.formatting import formatted
from host.gait.tree import Place
from host.lsp import outline as names
from host.lsp.completion import Item, complete
from host.lsp.desk import Desk
from host.lsp.hover import hover
from host.lsp.places import Columns
from host.lsp.texts import path_of
from host.lsp.verdicts import Unasked, code_page
from host.lsp.view import View

KINDS = {
    "statement": types.CompletionItemKind.Keyword,
    "word": types.CompletionItemKind.Keyword,
    "name": types.CompletionItemKind.Variable,
    "label": types.CompletionItemKind.Reference,
    "quantity": types.CompletionItemKind.Property,
    "unit": types.CompletionItemKind.Unit,
    "channel": types.CompletionItemKind.Field,
    "robot": types.CompletionItemKind.Module,
    "file": types.CompletionItemKind.File,
}
SYMBOLS = {
    "param": types.SymbolKind.Variable,
    "circle": types.SymbolKind.Array,
    "def": types.SymbolKind.Function,
    "label": types.SymbolKind.Key,
}
SOURCE = "softrig"


class Asked(Protocol):
    """What every question about a cursor has."""

    text_document: types.TextDocumentIdentifier
    position: types.Position


class Answers:
    """What the desk knows, in the editor's types and columns."""

    def __init__(self, desk: Desk, codec: PositionCodec) -> None:
        self._desk = desk
        self._columns = Columns(codec)

    def diagnostics(self, path: str) -> list[types.Diagnostic]:
        """Return what is wrong with a text, and why its robot's limits are not known."""
        lines = self._desk.lines(path)
        found = [self._diagnostic(item, lines) for item in self._desk.found(path)]
        unasked = self._desk.unasked(path)
        return [*found, self._hint(unasked, lines)] if unasked else found

    def completed(self, params: types.CompletionParams, robots: list[str]) -> types.CompletionList:
        """Return what may come next."""
        view, line, column = self._cursor(params)
        offers = complete(replace(view, robots=tuple(robots)), line, column)
        items = [self._item(offer, order, line, column, view) for order, offer in enumerate(offers)]
        return types.CompletionList(is_incomplete=False, items=items)

    def hover(self, params: types.HoverParams) -> types.Hover | None:
        """Return what a cursor points at."""
        text = hover(*self._cursor(params))
        return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, text)) if text else None

    def formatted(self, uri: str) -> list[types.TextEdit] | None:
        """Return the edit that lays a text out; nothing while it cannot be read, or when it is laid out already."""
        path = path_of(uri)
        text, lines = self._desk.texts.get(path), self._desk.lines(path)
        if text is None:
            return None
        try:
            new = formatted("\n".join(lines), path).replace("\n", text.line_end)
        except GaitError:
            return None
        return [types.TextEdit(self._columns.whole(lines), new)] if new != text.source else []

    def fixes(self, params: types.CodeActionParams) -> list[types.CodeAction]:
        """Return what puts right the words at a cursor that were meant otherwise."""
        path = path_of(params.text_document.uri)
        lines, actions = self._desk.lines(path), []
        for item in self._desk.found(path):
            told, slip = self._diagnostic(item, lines), _slip(item)
            if slip and told.range.start <= params.range.end and params.range.start <= told.range.end:
                edit = types.TextEdit(self._columns.range(slip[0], lines), slip[1])
                change = types.WorkspaceEdit(changes={params.text_document.uri: [edit]})
                title = f"Write `{slip[1]}`"
                actions.append(types.CodeAction(title, types.CodeActionKind.QuickFix, [told], True, edit=change))
        return actions

    def outline(self, uri: str) -> list[types.DocumentSymbol]:
        """Return what a text declares."""
        view = self._desk.view(path_of(uri))
        return [self._symbol(entry, view) for entry in names.outline(view)]

    def definition(self, params: types.DefinitionParams) -> types.Location | None:
        """Return where the name under a cursor is declared."""
        place = names.declaration(*self._cursor(params))
        return self._location(place) if place else None

    def references(self, params: types.ReferenceParams) -> list[types.Location]:
        """Return where the name under a cursor is used, and declared if that is asked for."""
        places = names.uses(*self._cursor(params))
        return [self._location(place) for place in places[not params.context.include_declaration :]]

    def name_at(self, params: types.PrepareRenameParams) -> types.Range | None:
        """Return the range of the name under a cursor that can have another name."""
        view, line, column = self._cursor(params)
        found = view.word(line, column)
        if found is None or not names.uses(view, line, column):
            return None
        first = found.start() + found[0].startswith("$")
        return self._columns.range(Place(view.path, line, first + 1, found.end() + 1), view.lines)

    def renamed(self, params: types.RenameParams) -> types.WorkspaceEdit:
        """Return the edits that give a name another one, in every file of the script."""
        try:
            places = names.renamed(*self._cursor(params), params.new_name)
        except BadRequest as error:
            raise JsonRpcInvalidParams(str(error)) from error
        changes: dict[str, list[types.TextEdit]] = {}
        for place in places:
            edit = types.TextEdit(self._columns.range(place, self._desk.lines(place.file)), params.new_name)
            changes.setdefault(self._desk.texts.uri(place.file), []).append(edit)
        return types.WorkspaceEdit(changes=changes)

    def _cursor(self, params: Asked) -> tuple[View, int, int]:
        view = self._desk.view(path_of(params.text_document.uri))
        return view, params.position.line + 1, self._columns.column(params.position, view.lines)

    def _diagnostic(self, item: Diagnostic, lines: list[str]) -> types.Diagnostic:
        page = code_page(item.code)
        return types.Diagnostic(
            range=self._columns.range(item.place, lines),
            message=f"{item.message}\nhelp: {item.help}" if item.help else item.message,
            severity=types.DiagnosticSeverity.Error,
            code=item.code,
            code_description=types.CodeDescription(page) if page else None,
            source=SOURCE,
        )

    def _hint(self, unasked: Unasked, lines: list[str]) -> types.Diagnostic:
        return types.Diagnostic(
            range=self._columns.range(unasked.place, lines),
            message=unasked.reason,
            severity=types.DiagnosticSeverity.Information,
            source=SOURCE,
        )

    def _item(self, offer: Item, order: int, line: int, column: int, view: View) -> types.CompletionItem:
        typed = Place(view.path, line, offer.start + 1, column + 1)
        about = types.MarkupContent(types.MarkupKind.Markdown, offer.about) if offer.about else None
        return types.CompletionItem(
            label=offer.text,
            kind=KINDS[offer.kind],
            detail=offer.detail or None,
            documentation=about,
            sort_text=f"{order:04}",
            filter_text=offer.text,
            text_edit=types.TextEdit(self._columns.range(typed, view.lines), offer.text),
        )

    def _symbol(self, entry: names.Entry, view: View) -> types.DocumentSymbol:
        name = self._columns.range(entry.place, view.lines)
        end = view.line(entry.last_line)
        last = self._columns.range(Place(view.path, entry.last_line, 1, len(end) + 1), view.lines)
        whole = types.Range(types.Position(name.start.line, 0), last.end)
        return types.DocumentSymbol(entry.name, SYMBOLS[entry.kind], whole, name, detail=entry.detail)

    def _location(self, place: Place) -> types.Location:
        return types.Location(
            self._desk.texts.uri(place.file), self._columns.range(place, self._desk.lines(place.file))
        )


def _slip(item: Diagnostic) -> tuple[Place, str] | None:
    """Return the place of a word for which another was meant, and that word."""
    wrong, meant = re.search(r"`\$?(\w+)`", item.message), re.search(r"did you mean `(\S+)`\?", item.help)
    at = item.source_line.find(wrong[1], item.place.column - 1, item.place.end_column - 1) if wrong else -1
    if wrong is None or meant is None or at < 0:
        return None
    return replace(item.place, column=at + 1, end_column=at + 1 + len(wrong[1])), meant[1]
