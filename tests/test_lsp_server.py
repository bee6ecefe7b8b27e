"""`softrig lsp` as an editor meets it: a real process, its pipes, and a client of another library."""

import subprocess
import sys
from pathlib import Path

import pytest
from lsprotocol import types

from tests.lsp_editor import SOFTRIG, Editor

GAITS = Path(__file__).parents[1] / "gaits"
HERE = (GAITS / "new.gait").as_uri()
AFTER = (GAITS / "other.gait").as_uri()
HEAD = "gait 1\nrobot circular\n"
WITHOUT_PYGLS = "import sys; sys.modules['pygls'] = None; from host.cli import main; main(['lsp'])"


@pytest.fixture(scope="module")
def editor():
    """One editor with one server, for all tests of this file."""
    desk = Editor(encodings=["utf-16"])
    yield desk
    assert desk.end() == 0


def test_without_the_extra_one_line_names_it():
    told = subprocess.run([sys.executable, "-c", WITHOUT_PYGLS], capture_output=True, text=True, check=False)

    assert told.returncode == 2
    assert told.stderr == "softrig: softrig lsp needs pygls: pip install 'softrig[lsp]'\n"


def test_a_script_of_the_library_has_nothing_wrong(editor):
    script = GAITS / "circular-crawl.gait"

    assert editor.open(script.as_uri(), script.read_text()) == []


def test_limits_of_the_robot_and_mistakes_of_the_language_are_told_with_code_range_and_help(editor):
    told = editor.open(HERE, HEAD + "fire A at 60 for 600 ms\n")
    beyond = editor.type(HERE, HEAD + "fire A at 60 % for 60 s\n")

    assert [(each.code, each.severity, each.source) for each in told] == [("E120", 1, "softrig")]
    assert str(told[0].range) == "2:10-2:12"
    assert "write `60 %`" in told[0].message
    assert told[0].code_description.href.endswith("docs/codes.md#e120")
    assert "E302" in [each.code for each in beyond]


def test_only_the_last_of_many_states_is_looked_at(editor):
    texts = [HEAD + f"fire A at 60 % for {time} s\n" for time in range(40, 0, -1)]
    editor.open(HERE, texts[0])

    assert editor.type(HERE, *texts[1:]) == []
    version = editor.told[HERE].version
    editor.open(AFTER, HEAD)  # looked at when all looks before it are done
    assert editor.versions.count(version) <= 2  # what is wrong, and perhaps what a model of the robot adds


def test_columns_are_counted_in_utf_16_units(editor):
    told = editor.open(HERE, HEAD + 'note "😀" fire\n')

    assert str(told[0].range) == "2:10-2:14"


def test_lines_that_end_as_on_windows_stay_so_when_they_are_laid_out(editor):
    told = editor.open(HERE, "gait 1\r\nrobot circular\r\nwait   2 s\r\n")
    asked = types.DocumentFormattingParams(types.TextDocumentIdentifier(HERE), types.FormattingOptions(4, True))

    edits = editor.wait(editor.client.text_document_formatting_async(asked))

    assert told == []
    assert [edit.new_text for edit in edits] == ["gait 1\r\nrobot circular\r\nwait 2 s\r\n"]


def test_what_is_wrong_in_an_included_file_is_told_there_before_it_is_saved(editor):
    library, main = (GAITS / "lib" / "push.gait").as_uri(), (GAITS / "uses.gait").as_uri()
    editor.open(main, HEAD + 'include "lib/push.gait"\npush(A, 2 s)\n')

    told = editor.open(library, (GAITS / "lib" / "push.gait").read_text().replace("$duty", "$dutty"))
    editor.until(lambda: editor.told[library].diagnostics)

    assert told in ([], list(editor.told[library].diagnostics))
    assert [each.code for each in editor.told[library].diagnostics] == ["E160"]
    assert editor.type(library, (GAITS / "lib" / "push.gait").read_text()) is not None
    editor.until(lambda: not editor.told[library].diagnostics)


def test_a_robot_that_cannot_be_reached_leaves_the_mistakes_of_the_language_and_says_so(editor):
    told = editor.open(HERE, "gait 1\nrobot circlar\nfire Q at 95 % for 600\n")

    assert [each.code for each in told] == ["E120", None]
    assert "did you mean circular?" in told[1].message
    assert told[1].severity == types.DiagnosticSeverity.Information


def test_completion_and_hover_know_the_robot(editor):
    editor.open(HERE, HEAD + "fire A at 60 % for 600 ms\nfire ")

    offers = editor.wait(editor.client.text_document_completion_async(types.CompletionParams(**editor.at(HERE, 3, 5))))
    shown = editor.wait(editor.client.text_document_hover_async(types.HoverParams(**editor.at(HERE, 2, 8))))

    assert [item.label for item in offers.items][:8] == list("ABCDEFGH")
    assert "duty 0.1 .. 100 %" in shown.contents.value


def test_a_new_name_is_written_everywhere(editor):
    editor.open(HERE, HEAD + 'param much = 60 %\nnote "duty $much"\nfire A at $much for 600 ms\n')
    asked = types.RenameParams(**editor.at(HERE, 4, 12), new_name="duty")

    edit = editor.wait(editor.client.text_document_rename_async(asked))

    assert [str(each.range) for each in edit.changes[HERE]] == ["2:6-2:10", "3:12-3:16", "4:11-4:15"]


def test_closing_a_text_takes_back_what_was_said_of_it(editor):
    assert editor.open(HERE, "gait 1\nrobot circular\nfire\n")

    gone = types.DidCloseTextDocumentParams(types.TextDocumentIdentifier(HERE))
    editor.client.text_document_did_close(gone)

    editor.until(lambda: not editor.told[HERE].diagnostics)


def test_an_editor_that_dies_takes_its_server_along():
    server = subprocess.Popen([SOFTRIG, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    server.stdin.close()

    assert server.stdout.read() == b""
    assert server.wait() == 0


def test_another_robot_is_asked_by_its_address_and_so_is_its_model():
    neovim = Editor("neovim", "--robot", "sim:circular?supply=2.4")

    neovim.open(HERE, HEAD + "fire A at 100 % for 1100 ms\n")
    neovim.until(lambda: neovim.told[HERE].diagnostics)

    assert [(each.code, str(each.range)) for each in neovim.told[HERE].diagnostics] == [("E328", "2:0-2:27")]
    assert neovim.end() == 0
