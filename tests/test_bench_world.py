"""The firmware's world: its own modules, its own time, its own end; the same in CPython and in real MicroPython."""

import pytest

from hil_sim.journal import PIN
from hil_sim.worlds import cpython, micropython
from hil_sim.worlds.costs import BOOT_US
from tests.bench_fakes import bench_of


@pytest.fixture(autouse=True, params=[cpython, micropython], ids=["cpython", "micropython"])
def world(request, monkeypatch):
    """Each test runs in both worlds."""
    monkeypatch.setattr("tests.bench_fakes.EXECUTE", request.param.execute)
    return request.param


def said(bench) -> list[str]:
    """Return what the firmware printed, line by line."""
    return "".join(bench.world.console).split("\n")[:-1]


def run(tmp_path, main, files=None, ms=100, **options):
    """Run a firmware for a while and return its bench, closed."""
    bench = bench_of(tmp_path, main, files, **options)
    bench.clock.run_until(BOOT_US + ms * 1000)
    bench.close()
    return bench


def test_boot_runs_before_main_and_both_in_main(tmp_path):
    bench = run(tmp_path, "print(seen, __name__)\nwhile True: time.sleep_ms(5)", {"boot.py": "seen = 1"})

    assert said(bench) == ["1 __main__"]


@pytest.mark.parametrize(
    "statement",
    [
        "import protocol.frames as f",
        "from protocol import frames as f",
        "import protocol.frames; f = protocol.frames",
        "from protocol.frames import *; f = protocol.frames if 'protocol' in dir() else None",
    ],
)
def test_every_form_of_import_reaches_the_image(tmp_path, statement):
    bench = run(tmp_path, statement + "\nprint(MARK if f is None else f.MARK)", {"protocol/frames.py": "MARK = 7"})

    assert said(bench) == ["7"]


def test_a_package_is_taken_from_the_first_folder_of_the_path_that_has_it(tmp_path):
    files = {"a/firmware/mark.py": "MARK = 'a'", "b/firmware/mark.py": "MARK = 'b'", "boot.py": "import sys"}
    main = "sys.path.insert(0, '{}')\nfrom firmware import mark\nprint(mark.MARK)"

    assert [said(run(tmp_path, main.format(slot), files)) for slot in "ab"] == [["a"], ["b"]]


def test_two_modules_may_import_each_other(tmp_path):
    files = {
        "protocol/__init__.py": "",
        "protocol/a.py": "import protocol.b\nx = 1",
        "protocol/b.py": "import protocol.a\ndef x(): return protocol.a.x",
    }
    bench = run(tmp_path, "import protocol.a\nprint(protocol.b.x())", files)

    assert said(bench) == ["1"]


@pytest.mark.parametrize("name", ["dataclasses", "typing", "pathlib", "threading", "hil_sim", "numpy"])
def test_what_a_board_does_not_have_cannot_be_imported(tmp_path, name):
    bench = run(tmp_path, f"try: import {name}\nexcept ImportError as error: print(error)")

    assert said(bench) == [f"no module named '{name}'"]


def test_two_boards_in_one_process_share_nothing(tmp_path):
    main = "import protocol.state as s\ns.count += 1\nprint(s.count)"
    files = {"protocol/state.py": "count = 0"}

    assert [said(run(tmp_path, main, files)) for _ in range(2)] == [["1"], ["1"]]


def test_the_profile_is_a_file_on_the_flash(tmp_path):
    bench = run(tmp_path, "with open('robot.json', 'rb') as file: print(file.read())")

    assert said(bench) == ["b'{}'"]


def test_a_missing_file_is_refused_as_on_the_board(tmp_path):
    main = "try: open('none')\nexcept OSError as error: print(error.args[0])"

    assert said(run(tmp_path, main)) == ["2"]


def test_time_passes_only_by_access_to_the_hardware(tmp_path):
    main = """
a = time.ticks_us()
for _ in range(1000): pass
b = time.ticks_us()
beat.value(1)
c = time.ticks_us()
i2c.writeto_mem(0x60, 6, bytes(4))
d = time.ticks_us()
time.sleep_ms(3)
e = time.ticks_us()
print(b - a, c - b, d - c, e - d)
"""

    assert said(run(tmp_path, main)) == ["1 2 136 3001"]  # 6 bytes of 22.5 us and the reading of the clock


def test_ticks_wrap_at_two_to_the_thirty(tmp_path):
    main = """
a = time.ticks_ms()
time.sleep_ms(30)
b = time.ticks_ms()
print(b < a, time.ticks_diff(b, a), time.ticks_add(2**30 - 1, 2))
"""
    bench = run(tmp_path, main, ticks_start_us=(1 << 30) * 1000 - BOOT_US - 10_000)

    assert said(bench) == ["True 30 1"]


def test_a_busy_wait_ends(tmp_path):
    main = "start = time.ticks_ms()\nwhile time.ticks_diff(time.ticks_ms(), start) < 20: pass\nprint(time.ticks_ms())"

    assert said(run(tmp_path, main)) == ["40"]


def test_pins_are_the_same_object_for_the_same_number(tmp_path):
    bench = run(tmp_path, "print(Pin(3) is beat, Pin('LED') is Pin(25), Pin('GP3') is beat)")

    assert said(bench) == ["True True True"]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("Pin(30)", "invalid pin"),
        ("I2C(0, scl=Pin(4), sda=Pin(5))", "bad SCL pin"),
        ("WDT(timeout=8389)", "timeout exceeds 8388"),
        ("ADC(Pin(3))", "Pin doesn't have ADC capabilities"),
    ],
)
def test_what_the_port_refuses_is_refused_in_its_words(tmp_path, call, message):
    bench = run(tmp_path, f"try: {call}\nexcept ValueError as error: print(error)")

    assert said(bench) == [message]


def test_an_absent_chip_raises_eio_and_scan_finds_the_others(tmp_path):
    main = "try: i2c.writeto(0x20, b'x')\nexcept OSError as e: print(e.args[0])\nprint([hex(a) for a in i2c.scan()])"

    assert said(run(tmp_path, main)) == ["5", "['0x40', '0x60', '0x61', '0x70']"]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("time.sleep_ms(-1)", "None"),
        ("time.sleep_us(1.5)", "TypeError"),
        ("time.sleep_ms(1.5)", "TypeError"),
        ("UART(0).write('abc')", "3"),
        ("i2c.readfrom_mem(0x60, 0x100, 1)", "b'\\x11'"),
        ("i2c.readfrom_mem(0x60, -256, 1)", "b'\\x11'"),
        ("i2c.readfrom_mem_into(0x60, 0x100, bytearray(1))", "None"),
        ("i2c.writeto_mem(0x60, -256, b'\\x11')", "None"),
        ("[file := open('x', 'wb'), file.close(), file.close()][1:]", "[None, None]"),
    ],
)
def test_odd_arguments_are_taken_as_the_port_takes_them(tmp_path, call, message):
    main = f"try: print({call})\nexcept Exception as error: print(type(error).__name__)\nprint(time.ticks_ms() < 70)"

    assert said(run(tmp_path, main)) == [message, "True"]


def test_an_empty_uart_reads_none_and_a_full_one_writes_none(tmp_path):
    main = """
uart = UART(0, baudrate=115200, tx=Pin(0), rx=Pin(1))
print(uart.read(), uart.readinto(bytearray(4)), uart.any(), uart.write(bytes(300)), uart.write(b'x'))
"""

    assert said(run(tmp_path, main)) == ["None None 0 256 None"]


@pytest.mark.parametrize("wait", ["time.sleep_ms(5)", "beat.toggle()", "beat.value(1)", "time.ticks_ms()"])
def test_an_interrupt_on_the_console_is_raised_where_the_firmware_is(tmp_path, wait):
    main = f"""
try:
    while True: {wait}
except KeyboardInterrupt:
    print("interrupted")
    while True: time.sleep_ms(5)
"""
    bench = bench_of(tmp_path, main)
    bench.clock.run_until(BOOT_US + 20_000)
    bench.world.interrupt()
    bench.clock.run_until(BOOT_US + 30_000)
    bench.close()

    assert said(bench) == ["interrupted"]
    assert bench.crashes == []


def test_a_crash_is_reported_with_its_line_and_the_firmware_stays_dead(tmp_path):
    bench = run(tmp_path, "time.sleep_ms(10)\nraise ValueError('no')")

    assert [(crash.time_us, crash.error) for crash in bench.crashes] == [(30_002, "ValueError('no')")]
    assert "main.py" in bench.crashes[0].trace
    assert not bench.world.running


def test_reset_starts_again_with_fresh_modules_and_says_why(tmp_path):
    main = """
import protocol.state as s
s.count += 1
print(s.count, reset_cause(), time.ticks_ms())
time.sleep_ms(30)
reset()
print("never")
"""
    bench = run(tmp_path, main, {"protocol/state.py": "count = 0"}, ms=70)

    assert said(bench) == ["1 1 20", "1 3 20"]
    assert bench.world.resets == 1


def test_nothing_the_firmware_does_can_catch_a_reset(tmp_path):
    main = """
Pin(25, Pin.OUT)
try:
    reset()
except BaseException:
    print("caught")
finally:
    Pin(25).value(1)
"""
    bench = run(tmp_path, main, ms=10, keep_journal=True)

    assert bench.world.resets == 1
    assert bench.world.console == []
    assert not [entry for entry in bench.journal.kept() if entry[1:] == (PIN, 25, b"\x01")]


def test_a_firmware_that_catches_everything_can_still_be_ended(tmp_path):
    main = "while True:\n  try: time.sleep_ms(1)\n  except BaseException: pass"

    run(tmp_path, main)  # comes back


def test_the_watchdog_resets_a_firmware_that_does_not_feed_it(tmp_path):
    main = """
print(reset_cause())
dog = WDT(timeout=50)
for _ in range(3):
    time.sleep_ms(40)
    dog.feed()
while True: time.sleep_ms(5)
"""
    bench = run(tmp_path, main, ms=160)
    assert said(bench) == ["1"]

    bench = run(tmp_path, main, ms=175 + BOOT_US // 1000)

    assert said(bench) == ["1", "3"]


def test_whoever_feeds_the_watchdog_loads_the_time_that_was_set_last(tmp_path):
    main = "short = WDT(timeout=50)\nWDT(timeout=1000)\nwhile True:\n  short.feed()\n  time.sleep_ms(200)"

    assert run(tmp_path, main, ms=900).world.resets == 0


def test_a_hung_processor_is_reset_by_its_watchdog(tmp_path):
    bench = bench_of(tmp_path, "dog = WDT(timeout=50)\nwhile True:\n  time.sleep_ms(5)\n  dog.feed()")
    bench.run(0.2)

    bench.world.hang()
    bench.run(0.04)
    assert not bench.world.running
    bench.run(0.04)

    assert bench.world.running
    assert bench.world.resets == 1
    bench.close()


def test_what_was_due_first_happens_before_a_firmware_that_wakes_at_the_same_instant(tmp_path):
    bench = bench_of(tmp_path, "time.sleep_us(1000)\nprint('firmware')")
    wakes_us = BOOT_US + 2 + 1000  # two pins are set up first
    bench.clock.at(wakes_us, lambda: bench.world.console.append("event\n"))

    bench.clock.run_until(wakes_us)
    bench.close()

    assert said(bench) == ["event", "firmware"]
