"""The C header: it compiles without a warning, as C99 and as C++, and its codec passes every published vector.

A machine without a compiler fails these tests: nothing is skipped.
"""

import shutil
import subprocess
from pathlib import Path

import pytest

from docs import cheader, cvectors, vectors

FOLDER = Path(__file__).parents[1] / "docs" / "c"
STRICT = ["-Wall", "-Wextra", "-Werror", "-pedantic"]
LANGUAGES = [("cc", "-std=c99", "c"), ("c++", "-std=c++11", "c++")]


@pytest.fixture(params=LANGUAGES, ids=["c", "c++"])
def build(request, tmp_path):
    """Return what compiles a source in one of the languages, and returns the path of the program."""
    compiler, standard, language = request.param

    def built(source, *options):
        command = [compiler, standard, *STRICT, *options, "-I", str(FOLDER), "-x", language, str(source)]
        done = subprocess.run([*command, "-o", str(tmp_path / "program")], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return tmp_path / "program"

    assert shutil.which(compiler), f"these tests need a C compiler: there is no {compiler}"
    return built


def said(program):
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False, timeout=60)
    return done.returncode, done.stdout


def test_a_program_of_the_header_passes_every_vector(build):
    status, text = said(build(FOLDER / "vectors.c", "-fsanitize=undefined", "-fno-sanitize-recover"))

    assert status == 0, text
    assert text.endswith(" 0 failed\n")
    assert int(text.split()[0]) > 600


def test_the_program_has_every_vector():
    text = cvectors.text()

    wires = [vector["wire"] for part in (vectors.whole_frames, vectors.refused, vectors.streams) for vector in part()]
    assert all(f'"{wire}"' in text for wire in wires)
    assert all(vector["payload"] in text for vector in vectors.payloads())


def test_a_vector_that_is_not_so_fails_the_program(build, tmp_path):
    text = cvectors.text()
    payload = vectors.usual("fire").hex()
    source = tmp_path / "wrong.c"
    other = f"{payload[:-2]}{int(payload[-2:], 16) ^ 1:02x}"
    source.write_text(text.replace(f'hex(&payload, "{payload}")', f'hex(&payload, "{other}")'))

    status, told = said(build(source))

    assert status == 1
    assert told.startswith("failed: fire")


def test_two_files_of_a_program_may_include_the_header(build, tmp_path):
    source = tmp_path / "twice.c"
    source.write_text('#include "softrig.h"\n#include "softrig.h"\nint main(void) { return 0; }\n')

    assert said(build(source)) == (0, "")


def test_a_value_outside_the_range_of_its_field_is_not_packed(build, tmp_path):
    source = tmp_path / "range.c"
    source.write_text(
        '#include "softrig.h"\nint main(void)\n{\n    softrig_alive told = {0, 32, 0};\n    uint8_t out[7];\n'
        "    int packed = softrig_pack_alive(&told, out, sizeof out);\n    told.slots = 33;\n"
        "    return !(packed == 7 && softrig_pack_alive(&told, out, sizeof out) == -1);\n}\n"
    )

    assert said(build(source)) == (0, "")


def test_the_header_is_in_plain_characters_and_leaves_no_place_unfilled():
    text = cheader.text()

    assert text.isascii()
    assert "@" not in text
