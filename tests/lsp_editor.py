"""An editor for tests: the client of another library, which speaks with a real `softrig lsp` over its pipes."""

import asyncio
import sysconfig
from pathlib import Path

from lsprotocol import types
from pygls.protocol import default_converter
from pytest_lsp import LanguageClient, client_capabilities

SOFTRIG = Path(sysconfig.get_path("scripts")) / "softrig"
PATIENCE_S = 60  # the first question to a robot may load the compiled physics


class Editor:
    """One editor with a server of its own; every call waits for what the server sends, never for time to pass."""

    def __init__(self, kind="visual-studio-code", *arguments, cwd=None, encodings=None):
        self._loop = asyncio.new_event_loop()
        self.client = LanguageClient(converter_factory=default_converter)
        self.told = {}
        self.versions = []
        self._news = asyncio.Event()
        self.client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(self._heard())
        self.wait(self.client.start_io(str(SOFTRIG), "lsp", *arguments, cwd=cwd))
        capabilities = client_capabilities(kind)
        if encodings:
            capabilities.general.position_encodings = encodings
        hello = types.InitializeParams(capabilities=capabilities, workspace_folders=[])
        self.server = self.wait(self.client.initialize_session(hello))
        self._version = 0

    def wait(self, task):
        """Return what a task comes to."""
        return self._loop.run_until_complete(asyncio.wait_for(task, PATIENCE_S))

    def open(self, uri, text):
        """Open a text and return what the server says is wrong with it."""
        self._version += 1
        item = types.TextDocumentItem(uri, "gait", self._version, text)
        self.client.text_document_did_open(types.DidOpenTextDocumentParams(item))
        return self._verdict(uri)

    def type(self, uri, *texts):
        """Send the states that a text goes through, in one message, and return what is wrong with the last one."""
        self._version += 1
        item = types.VersionedTextDocumentIdentifier(self._version, uri)
        changes = [types.TextDocumentContentChangeWholeDocument(text) for text in texts]
        self.client.text_document_did_change(types.DidChangeTextDocumentParams(item, changes))
        return self._verdict(uri)

    def at(self, uri, line, column):
        """Return what a question about a cursor carries."""
        return {"text_document": types.TextDocumentIdentifier(uri), "position": types.Position(line, column)}

    def until(self, ready):
        """Wait until what the server has told fulfils `ready`."""
        self.wait(self._until(ready))

    def end(self):
        """Say goodbye and return the exit status of the server."""
        self.wait(self.client.shutdown_session())
        status = self.client._server.returncode
        self.wait(self.client.stop())
        self._loop.close()
        return status

    def _verdict(self, uri):
        version = self._version
        self.until(lambda: uri in self.told and self.told[uri].version == version)
        return list(self.told[uri].diagnostics)

    async def _until(self, ready):
        while not ready():
            self._news.clear()
            await self._news.wait()

    def _heard(self):
        def hear(params: types.PublishDiagnosticsParams):
            self.told[params.uri] = params
            self.versions.append(params.version)
            self._news.set()

        return hear
