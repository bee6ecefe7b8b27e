"""Coverage-guided fuzzing with atheris. What is found is written into the corpus, which `make test` replays.

.venv/bin/python -m tests.fuzz                # a minute over all targets
.venv/bin/python -m tests.fuzz link 600       # ten minutes of one
"""

import subprocess
import sys
import tempfile
from pathlib import Path

CORPUS = Path(__file__).parent / "corpus"  # a folder for each target
ALL_S = 60
INPUT_MAX = 2048
STUCK_S = 20  # an input that takes so long is a finding
WATCHED = ["protocol", "firmware", "host", "hil_sim.can.slcan", "hil_sim.can.socketcand", "hil_sim.can.host"]
ABSENT = """make fuzz needs atheris, and there is none here: it exists as a ready package for some versions of Python on
Linux only. Try `.venv/bin/python -m pip install atheris`, or make setup PYTHON=python3.11. The corpus that `make test`
replays needs none."""


def all_targets() -> int:
    """Fuzz each target for its share of a minute; return 1 if anything was found."""
    status = 0
    names = sorted(folder.name for folder in CORPUS.iterdir())
    for name in names:
        print(f"== {name}", flush=True)
        done = subprocess.run([sys.executable, "-m", "tests.fuzz", name, str(ALL_S // len(names))], check=False)
        status |= done.returncode != 0
    return status


def one_target(name: str, time_s: str) -> None:
    """Fuzz one target and end the process."""
    import atheris  # noqa: PLC0415 - a machine that only replays has none

    with atheris.instrument_imports(include=WATCHED):
        from tests.fuzz_targets import TARGETS  # noqa: PLC0415 - instrumented
    with tempfile.TemporaryDirectory() as fresh:
        options = [
            f"-max_total_time={time_s}", f"-max_len={INPUT_MAX}", f"-timeout={STUCK_S}", "-verbosity=0",
            "-print_final_stats=1", "-rss_limit_mb=2048", f"-artifact_prefix={CORPUS / name}/found-",
        ]  # fmt: skip
        atheris.Setup([sys.argv[0], *options, fresh, str(CORPUS / name)], TARGETS[name])
        atheris.Fuzz()


if __name__ == "__main__":
    try:
        import atheris  # noqa: F401 - only whether it is there
    except ImportError:
        sys.exit(ABSENT)
    if len(sys.argv) > 1:
        one_target(sys.argv[1], sys.argv[2])
    sys.exit(all_targets())
