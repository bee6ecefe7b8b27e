"""The flash: its files outlive everything, and a power cut tears exactly the operation that it falls into."""

import pytest

from hil_sim.devices.flash import CLOSE, TRUNCATE, WRITE, Flash, cost_us
from tests.bench_fakes import bench_of

WRITES = """
def contents(path):
    try:
        with open(path, "rb") as file: return file.read()
    except OSError as error: return error.args[0]
print(reset_cause(), contents("/log"))
if reset_cause() == 1 and contents("/log") == 2:
    with open("/log", "wb") as file: file.write(b"abcdef")
    print("written")
    reset()
while True: time.sleep_ms(5)
"""


def said(bench) -> list[str]:
    """Return what the firmware printed, line by line."""
    return "".join(bench.world.console).split("\n")[:-1]


def operated(*operations, cut_at=0, old=b"old!"):
    """Return what a file holds after some operations, the one number `cut_at` cut."""
    flash = Flash({"file": old})
    flash.cut_at = cut_at
    for kind, data in operations:
        if not flash.operate(kind, "/file", data):
            break
    return flash.read("file")


def test_a_file_is_found_with_and_without_its_leading_slash():
    flash = Flash({"robot.json": b"{}"})

    assert flash.read("/robot.json") == flash.read("robot.json") == b"{}"
    assert flash.paths() == ["robot.json"]


def test_a_missing_file_is_enoent():
    with pytest.raises(OSError, match="ENOENT") as missing:
        Flash({}).read("/none")

    assert missing.value.args == (2, "ENOENT")


def test_a_file_is_written_anew():
    assert operated((TRUNCATE, b""), (WRITE, b"abc"), (WRITE, b"def"), (CLOSE, b"")) == b"abcdef"


@pytest.mark.parametrize(("cut_at", "left"), [(1, b"ol"), (2, b"ab"), (3, b"abc"), (4, b"abcd")])
def test_a_cut_operation_is_half_done(cut_at, left):
    assert operated((TRUNCATE, b""), (WRITE, b"abcd"), (CLOSE, b""), cut_at=cut_at) == left


def test_a_cut_happens_once_and_counts_from_where_it_was_ordered():
    flash = Flash({})
    flash.operate(WRITE, "/file", b"abcd")
    flash.cut_at = 2

    assert [flash.operate(WRITE, "/file", b"ef") for _ in range(4)] == [True, False, True, True]
    assert flash.operations == 5


def test_erasing_takes_45_ms_and_each_started_page_400_us():
    assert cost_us(TRUNCATE, 0) == 45_000
    assert [cost_us(WRITE, size) for size in (0, 1, 256, 257)] == [400, 400, 400, 800]


def test_what_the_firmware_writes_survives_a_reset_and_a_power_cycle(tmp_path):
    bench = bench_of(tmp_path, WRITES)
    bench.run(0.2)

    bench.world.power_on()
    bench.run(0.1)
    bench.close()

    assert said(bench) == ["1 2", "written", "3 b'abcdef'", "1 b'abcdef'"]


@pytest.mark.parametrize(("cut_at", "found"), [(1, b""), (2, b"abc"), (3, b"abcde")])
def test_a_cut_ends_the_firmware_in_the_middle_of_a_write_and_the_board_comes_back(tmp_path, cut_at, found):
    bench = bench_of(tmp_path, WRITES)
    bench.board.flash.cut_at = cut_at
    bench.run(0.3)
    bench.close()

    assert said(bench) == ["1 2", f"1 {found}"]
    assert bench.world.resets == 0


@pytest.mark.parametrize("mode", ["ab", "r+b", "w", "x"])
def test_other_modes_are_refused(tmp_path, mode):
    bench = bench_of(tmp_path, f"try: open('/log', '{mode}')\nexcept OSError as error: print(error.args[0])")
    bench.run(0.1)
    bench.close()

    assert said(bench) == ["22"]


def test_writing_is_in_the_trace(tmp_path):
    traces = []
    for letter in "ab":
        bench = bench_of(tmp_path, f"with open('/log', 'wb') as file: file.write(b'{letter}')")
        bench.run(0.2)
        bench.close()
        traces.append(bench.trace_sha256())

    assert traces[0] != traces[1]
