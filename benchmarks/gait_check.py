"""How long a script of a thousand lines takes to be read, compiled and checked, temperatures and all.

Every statement of the language, in blocks and calls; the best of several runs, in CPU seconds. The aim is 0.5 s for
all of it, beyond the start of the interpreter. For scale: the same statements as JSON, read by the standard library.

    python benchmarks/gait_check.py
"""

import json
import time
from collections.abc import Callable
from pathlib import Path

from host.gait.checker import check
from host.gait.compiler import compile_script
from host.gait.forecast import foretell
from host.gait.reading.parser import grammar, parse_file
from host.gait.script import loads
from host.profile import read_profile
from protocol.program import disassemble

ROOT = Path(__file__).parent.parent
LINES = 1_000
RUNS = 7
HEAD = (
    "gait 1\nrobot circular\nparam duty = 60 % [5 % .. 90 %]\ndef push(c, t):\n    fire $c at $duty for $t until 95 C\n"
)
BLOCK = """\
repeat 2:
    push(A, 300 ms)
    fire B at $duty / 2 for 600 ms overlap 200 ms   # half of it
    together:
        fire C at 4 % for 500 ms
        fire D E at 3 % for 2 * 400 ms ramp 100 ms
    wait 20 s
    wait until all.temperature < 45 C timeout 20 s else continue

for c in F G:
    hold $c at 80 C with 3 % for 1 s
    note "kept $c warm"
sym 45 deg:
    push(H, 300 ms)
wait until any.temperature < 40 C timeout 20 s else abort
"""
END = """\
wait until time > 10 s timeout 1 s else end
wait 20 s
label end
on fault:
    wait 1 s
"""


def script() -> str:
    """Return a script of about a thousand lines."""
    return HEAD + BLOCK * ((LINES - (HEAD + END).count("\n")) // BLOCK.count("\n")) + END


def best(work: Callable[[], object]) -> float:
    """Return the CPU seconds of the fastest of several runs."""
    times = []
    for _ in range(RUNS):
        begun = time.process_time()
        work()
        times.append(time.process_time() - begun)
    return min(times)


def main() -> None:
    """Measure and print."""
    text = script()
    profile = read_profile((ROOT / "firmware" / "robots" / "circular.json").read_bytes())
    begun = time.process_time()
    grammar()
    built_s = time.process_time() - begun
    loaded = loads(text)
    compiled = compile_script(loaded, profile)
    rows = [list(map(str, row)) for row in disassemble(compiled.code)]
    parse_s = best(lambda: parse_file(text, "script.gait"))
    compile_s = best(lambda: compile_script(loaded, profile))
    check_s = best(lambda: check(compiled))
    foretold_s = best(lambda: foretell(compiled, "sim:circular"))
    json_s = best(lambda: json.loads(json.dumps(rows)))
    lines, total_s = text.count("\n"), built_s + parse_s + compile_s + check_s + foretold_s
    print(f"script     {lines} lines, {len(compiled.steps)} steps, {len(compiled.code)} bytes of program")
    print(f"grammar    {built_s * 1000:6.1f} ms, once")
    print(
        f"parse      {parse_s * 1000:6.1f} ms, {lines / parse_s:,.0f} lines/s, {parse_s / json_s:.0f} x the ops as JSON"
    )
    print(f"compile    {compile_s * 1000:6.1f} ms")
    print(f"check      {check_s * 1000:6.1f} ms")
    print(f"predict    {foretold_s * 1000:6.1f} ms, the temperatures of its coils")
    print(f"all        {total_s * 1000:6.1f} ms of 500 ms")


if __name__ == "__main__":
    main()
