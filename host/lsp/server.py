"""The language server's end of the protocol: what an editor asks, handed to the desk and answered in its types.

Texts come in the order of the line; a worker of one thread looks at them, so that typing is never waited for. A script
is looked at once for its newest version: versions that came meanwhile are passed over. A second thread asks robots.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from typing import TypeVar

from lsprotocol import types
from pygls.lsp.server import LanguageServer

from host.gait.diagnostics import Diagnostic
from host.lsp.answers import Answers
from host.lsp.desk import Desk

T = TypeVar("T")


class GaitServer(LanguageServer):
    """Serves one editor."""

    def __init__(self, desk: Desk) -> None:
        super().__init__("softrig", version("softrig"), text_document_sync_kind=types.TextDocumentSyncKind.Full)
        self.desk = desk
        self.worker = ThreadPoolExecutor(1)
        self.asker = ThreadPoolExecutor(1)
        self._wanted: dict[str, int] = {}
        self._turn = asyncio.Lock()
        self._tasks: set[asyncio.Task[None]] = set()

    @property
    def answers(self) -> Answers:
        """Return what turns findings into the editor's types, in the columns that it counts."""
        return Answers(self.desk, self.workspace.position_codec)

    async def work(self, task: Callable[[], T]) -> T:
        """Return what the worker finds, in its turn."""
        return await asyncio.get_running_loop().run_in_executor(self.worker, task)

    def look(self, path: str) -> None:
        """Let a script be looked at, and the open scripts that include it."""
        for each in self.desk.depending(path):
            self._wanted[each] = self._wanted.get(each, 0) + 1
            task = asyncio.get_running_loop().create_task(self._look(each, self._wanted[each]))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)

    def look_at_all(self) -> None:
        """Let every open script be looked at again, for what may be another on disk, or reached by now."""
        self.desk.renew()
        for path in self.desk.texts.paths():
            self.look(path)

    async def close(self, path: str) -> None:
        """Take back what was said of a script that was closed."""
        self._wanted[path] = self._wanted.get(path, 0) + 1
        self._publish(await self.work(lambda: self._told(self.desk.forget(path))))

    async def _look(self, path: str, number: int) -> None:
        """Look at a version of a script, tell, and then ask a model of its robot, unless a newer one has come."""
        loop = asyncio.get_running_loop()
        async with self._turn:
            if not self._newest(path, number):
                return
            address = await self.work(lambda: self.desk.address(path))
            robot = await loop.run_in_executor(self.asker, self.desk.robots.ask, address) if address else None
            if not self._newest(path, number):
                return
            self._publish(await self.work(lambda: self._told(self.desk.judge(path, robot))))
        if address and (found := await loop.run_in_executor(self.asker, self._foretold, path, number, address)):
            self._publish(await self.work(lambda: self._told(self._added(path, number, found))))

    def _newest(self, path: str, number: int) -> bool:
        return self._wanted[path] == number and self.desk.texts.get(path) is not None

    def _foretold(self, path: str, number: int, address: str) -> tuple[Diagnostic, ...]:
        return self.desk.foretold(path, address) if self._newest(path, number) else ()

    def _added(self, path: str, number: int, found: tuple[Diagnostic, ...]) -> set[str]:
        return self.desk.add(path, found) if self._newest(path, number) else set()

    def _told(self, paths: set[str]) -> list[types.PublishDiagnosticsParams]:
        """Return what there is to say now about these texts."""
        texts = {path: self.desk.texts.get(path) for path in sorted(paths)}
        return [
            types.PublishDiagnosticsParams(
                self.desk.texts.uri(path), self.answers.diagnostics(path), text.version if text else None
            )
            for path, text in texts.items()
        ]

    def _publish(self, told: list[types.PublishDiagnosticsParams]) -> None:
        for each in told:
            self.text_document_publish_diagnostics(each)


def make_server(desk: Desk) -> GaitServer:
    """Return a server with everything that it can be asked."""
    server = GaitServer(desk)
    _add_texts(server)
    _add_questions(server)
    _add_names(server)
    return server


def _add_texts(server: GaitServer) -> None:
    """Let texts be opened, changed, saved and closed."""

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def opened(params: types.DidOpenTextDocumentParams) -> None:
        text = params.text_document
        server.look(server.desk.texts.put(text.uri, text.text, text.version))

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def changed(params: types.DidChangeTextDocumentParams) -> None:
        text = params.text_document
        for change in params.content_changes:
            server.look(server.desk.texts.put(text.uri, change.text, text.version))

    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    def saved(params: types.DidSaveTextDocumentParams) -> None:
        server.look_at_all()

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def changed_on_disk(params: types.DidChangeWatchedFilesParams) -> None:
        server.look_at_all()

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    async def closed(params: types.DidCloseTextDocumentParams) -> None:
        await server.close(server.desk.texts.drop(params.text_document.uri))


def _add_questions(server: GaitServer) -> None:
    """Let an editor ask what may come next, what a cursor points at, and how a text is laid out."""

    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=["$", ".", '"', "/"]))
    async def completion(params: types.CompletionParams) -> types.CompletionList:
        names = await asyncio.get_running_loop().run_in_executor(server.asker, server.desk.robots.names)
        return await server.work(lambda: server.answers.completed(params, names))

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def hover(params: types.HoverParams) -> types.Hover | None:
        return await server.work(lambda: server.answers.hover(params))

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    async def formatting(params: types.DocumentFormattingParams) -> list[types.TextEdit] | None:
        return await server.work(lambda: server.answers.formatted(params.text_document.uri))

    kinds = types.CodeActionOptions([types.CodeActionKind.QuickFix])

    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, kinds)
    async def fixes(params: types.CodeActionParams) -> list[types.CodeAction]:
        return await server.work(lambda: server.answers.fixes(params))

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def symbols(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        return await server.work(lambda: server.answers.outline(params.text_document.uri))


def _add_names(server: GaitServer) -> None:
    """Let an editor ask where a name is declared and used, and give it another."""

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def definition(params: types.DefinitionParams) -> types.Location | None:
        return await server.work(lambda: server.answers.definition(params))

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    async def references(params: types.ReferenceParams) -> list[types.Location]:
        return await server.work(lambda: server.answers.references(params))

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    async def prepare(params: types.PrepareRenameParams) -> types.Range | None:
        return await server.work(lambda: server.answers.name_at(params))

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    async def rename(params: types.RenameParams) -> types.WorkspaceEdit:
        return await server.work(lambda: server.answers.renamed(params))
