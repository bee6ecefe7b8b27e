"""Records on the flash: what was written is read again, and a cut leaves the record before it or the new one."""

import struct
from array import array
from binascii import crc32

import pytest

from firmware.channels import Refused
from firmware.faultlog import FAULTS_MAX, KEEP_EVERY_MS, FaultLog
from firmware.profile import Profile
from firmware.settings import Settings
from firmware.store import Store
from hil_sim.devices.flash import Flash
from protocol import codes, messages
from tests.firmware_bench import PROFILE
from tests.torn_flash import PowerCut, opener

WRITE_OPERATIONS = 3  # of one record: truncate, write, close


def store_on(flash, name="x", version=1):
    return Store(opener(flash), name, version)


def settings_on(flash):
    return Settings(store_on(flash, "settings"), Profile(PROFILE.read_bytes()))


def faults_on(flash, cause=messages.POWER_ON):
    return FaultLog(store_on(flash, "faults"), cause)


def cut_during(flash, operation, act):
    """Do `act` with the power cut in the middle of that write operation; return whether it was cut."""
    flash.cut_at = operation
    try:
        act()
    except PowerCut:
        return True
    return False


def test_what_was_written_last_is_read():
    flash = Flash({})
    written = [store_on(flash).write(text) for text in (b"", b"one", b"two" * 1000, b"three")]

    assert written == [True] * 4
    assert store_on(flash).read() == b"three"


def test_nothing_written_is_no_record_and_no_damage():
    assert store_on(Flash({})).read() is None
    assert not store_on(Flash({})).damaged()


@pytest.mark.parametrize("at", range(13 + 4))
def test_a_record_with_any_byte_changed_is_none_and_the_older_one_is_read(at):
    flash = Flash({})
    for text in (b"old", b"new"):
        store_on(flash).write(text)
    body = bytearray(flash.read("x.1"))
    body[at % len(body)] ^= 0x10
    flash.store("x.1", bytes(body))

    assert store_on(flash).read() == b"old"


def test_two_damaged_files_are_told_apart_from_none():
    flash = Flash({"x.0": b"", "x.1": b"sr and noise"})

    assert store_on(flash).read() is None
    assert store_on(flash).damaged()


@pytest.mark.parametrize("before", range(4))
@pytest.mark.parametrize("operation", range(1, WRITE_OPERATIONS + 1))
def test_a_cut_in_any_operation_leaves_the_record_before_or_the_new_one(before, operation):
    flash = Flash({})
    texts = [None, b"a" * 40, b"b" * 30, b"c" * 50, b"d" * 20]
    for text in texts[1 : before + 1]:
        store_on(flash).write(text)

    assert cut_during(flash, operation, lambda: store_on(flash).write(texts[before + 1]))

    assert store_on(flash).read() in (texts[before], texts[before + 1])
    assert store_on(flash).write(b"again")
    assert store_on(flash).read() == b"again"


def test_cut_after_cut_never_loses_the_last_record_that_was_read():
    flash = Flash({})
    assert store_on(flash).write(b"0")
    for turn in range(1, 200):
        last = store_on(flash).read()
        cut_during(flash, turn % (WRITE_OPERATIONS + 1), lambda turn=turn: store_on(flash).write(b"%d" % turn))

        assert store_on(flash).read() in (last, b"%d" % turn)


def test_a_record_of_another_version_is_kept_for_the_firmware_that_knows_it():
    flash = Flash({})
    store_on(flash, version=1).write(b"mine")
    store_on(flash, version=2).write(b"theirs")

    assert store_on(flash, version=1).read() == b"mine"
    assert store_on(flash, version=2).read() == b"theirs"
    assert store_on(flash, version=3).read() is None
    assert store_on(flash, version=1).write(b"mine again")
    assert store_on(flash, version=1).read() == b"mine again"


def test_a_flash_that_does_not_keep_what_it_is_told_is_found_out():
    flash = Flash({})
    store_on(flash).write(b"before")
    open_file = opener(flash)

    def deaf(path, mode):
        return open_file("/elsewhere" if mode == "wb" else path, mode)

    assert not Store(deaf, "x", 1).write(b"after")
    assert store_on(flash).read() == b"before"


def test_settings_have_defaults_and_survive():
    flash = Flash({})
    fresh = settings_on(flash)
    assert (fresh.source, fresh.node, fresh.board_offset_decidegc) == (messages.DEFAULTS, 1, 0)
    assert list(fresh.measured_mohm) == [0] * 8

    fresh.change(messages.NODE, 255, 9)
    fresh.change(messages.BOARD_OFFSET, 255, -15)
    fresh.change(messages.RESISTANCE, 2, 9000)

    later = settings_on(flash)
    assert (later.source, later.node, later.board_offset_decidegc) == (messages.STORED, 9, -15)
    assert list(later.measured_mohm) == [0, 0, 9000, *[0] * 5]


@pytest.mark.parametrize(
    ("setting", "channel", "value", "limit"),
    [
        (messages.NODE, 255, 0, 1),
        (messages.NODE, 255, 127, 126),
        (messages.BOARD_OFFSET, 255, 101, 100),
        (messages.BOARD_OFFSET, 255, -101, -100),
        (messages.RESISTANCE, 0, 1, 4750),
        (messages.RESISTANCE, 0, 65_535, 19_000),
        (99, 255, 1, 2),
    ],
)
def test_a_setting_outside_its_range_is_refused_and_changes_nothing(setting, channel, value, limit):
    flash = Flash({})
    with pytest.raises(Refused) as refused:
        settings_on(flash).change(setting, channel, value)

    assert (refused.value.code, refused.value.limit) == (codes.SETTING_LIMIT, limit)
    assert flash.operations == 0


def test_a_resistance_of_a_coil_that_is_not_there_is_refused():
    with pytest.raises(Refused) as refused:
        settings_on(Flash({})).change(messages.RESISTANCE, 8, 9000)

    assert (refused.value.code, refused.value.limit) == (codes.UNKNOWN_CHANNEL, 7)


def test_a_resistance_of_none_is_the_profiles_again():
    settings = settings_on(Flash({}))
    settings.change(messages.RESISTANCE, 0, 9100)
    settings.change(messages.RESISTANCE, 0, 0)

    assert settings.measured_mohm[0] == 0


@pytest.mark.parametrize("record", [b"", b"\x01\x00\x00", bytes(100)])
def test_settings_of_another_shape_are_damage_and_the_defaults_stand(record):
    flash = Flash({})
    store_on(flash, "settings").write(record)

    assert (settings_on(flash).source, settings_on(flash).node) == (messages.DAMAGED, 1)


@pytest.mark.parametrize("head", [(0, 0), (127, 0), (1, 101), (1, -101), (1, 0x7FFF)])
@pytest.mark.parametrize("mohm", [0, 1, 0xFFFF])
def test_settings_that_could_not_have_been_set_are_damage_and_the_defaults_stand(head, mohm):
    """As 32767 of the board's offset, with which its temperature fits in no status: the firmware died of it."""
    flash = Flash({})
    store_on(flash, "settings").write(struct.pack("<Bh8H", *head, *[mohm] * 8))

    settings = settings_on(flash)

    assert (settings.source, settings.packed()) == (messages.DAMAGED, settings_on(Flash({})).packed())


@pytest.mark.parametrize("sequence", [1 << 30, 0xFFFFFFFF])
def test_a_record_whose_number_no_flash_can_reach_is_none_and_the_next_one_counts(sequence):
    flash = Flash({})
    body = struct.pack("<2sBxIH", b"sr", 1, sequence, 3) + b"old"
    flash.store("x.0", body + struct.pack("<I", crc32(body)))

    assert store_on(flash).read() is None
    assert store_on(flash).write(b"new")
    assert store_on(flash).read() == b"new"


def test_settings_that_the_flash_does_not_take_do_not_count():
    flash = Flash({})
    settings = Settings(Store(refusing_writes(opener(flash)), "settings", 1), Profile(PROFILE.read_bytes()))
    with pytest.raises(Refused) as refused:
        settings.change(messages.NODE, 255, 5)

    assert refused.value.code == codes.FLASH_FAILED
    assert (settings.node, settings.source) == (1, messages.DEFAULTS)


@pytest.mark.parametrize("operation", range(1, 2 * WRITE_OPERATIONS + 1))
def test_a_cut_between_two_settings_leaves_the_one_the_other_or_both(operation):
    flash = Flash({})
    settings = settings_on(flash)
    settings.calibrate(array("H", [9000] * 8))

    def change():
        settings.calibrate(array("H", [9100] * 8))
        settings.calibrate(array("H", [9200] * 8))

    assert cut_during(flash, operation, change)

    assert len(set(settings_on(flash).measured_mohm)) == 1  # all eight of one writing
    assert settings_on(flash).measured_mohm[0] in ((9000, 9100) if operation <= WRITE_OPERATIONS else (9100, 9200))


def faults_of(log):
    """Return (start, time, code) of the faults, newest first."""
    page = log.page(0, FAULTS_MAX)
    rows = [page[at : at + messages.FAULT_BYTES] for at in range(0, len(page), messages.FAULT_BYTES)]
    return [messages.struct.unpack(messages.FAULT, row)[:3] for row in rows]


def test_faults_are_told_newest_first_and_the_oldest_make_room():
    log = faults_on(Flash({}))
    for now_ms in range(FAULTS_MAX + 3):
        log.add(now_ms, codes.CHIP, 255, 0, messages.ARMED)

    assert faults_of(log) == [(1, now_ms, codes.CHIP) for now_ms in range(FAULTS_MAX + 2, 2, -1)]
    assert len(log.page(10, 4)) == 4 * messages.FAULT_BYTES
    assert log.page(200, 4) == b""


def test_faults_survive_and_the_next_start_has_another_number():
    flash = Flash({})
    first = faults_on(flash)
    first.add(700, codes.CHIP, 255, 5, messages.RUNNING)
    first.keep(705)

    second = faults_on(flash, messages.RESET)
    second.add(3, codes.WATCHDOG, 255, 0, messages.BOOT)

    assert faults_of(second) == [(2, 3, codes.WATCHDOG), (1, 700, codes.CHIP)]


def test_a_start_without_faults_writes_nothing():
    flash = Flash({})
    faults_on(flash).keep(5)

    assert flash.operations == 0


@pytest.mark.parametrize(("start", "faults", "count"), [(0xFFFFFFFF, 1, 1), (1, 40, FAULTS_MAX), (1, 1.5, 0)])
def test_a_log_that_cannot_be_is_cut_to_one_that_can(start, faults, count):
    """A start that no number follows made the firmware die of each fault, and so of the one that told of that."""
    flash = Flash({})
    store_on(flash, "faults").write(struct.pack("<I", start) + bytes(int(faults * messages.FAULT_BYTES)))

    log = faults_on(flash)
    assert log.count() == count
    log.add(5, codes.CHIP, 255, 5, messages.IDLE)
    log.keep(5)

    assert faults_on(flash).count() == min(count + 1, FAULTS_MAX)


def test_faults_in_quick_succession_are_written_down_together():
    flash = Flash({})
    log = faults_on(flash)
    for now_ms in range(0, 2 * KEEP_EVERY_MS, 5):
        log.add(now_ms, codes.CHIP, 255, 5, messages.IDLE)
        log.keep(now_ms)

    assert flash.operations == 2 * WRITE_OPERATIONS


def test_a_cleared_log_stays_cleared():
    flash = Flash({})
    log = faults_on(flash)
    log.add(1, codes.CHIP, 255, 5, messages.IDLE)
    log.keep(5)

    assert log.clear()
    assert faults_on(flash).count() == 0
    assert faults_on(flash).start == 2


@pytest.mark.parametrize("operation", range(1, 3 * WRITE_OPERATIONS + 1))
def test_a_cut_while_faults_are_written_down_loses_at_most_the_newest(operation):
    flash = Flash({})
    log = faults_on(flash)

    def three():
        for turn in range(3):
            log.add(turn, codes.CHIP, turn, 5, messages.IDLE)
            log.keep(turn * KEEP_EVERY_MS)

    assert cut_during(flash, operation, three)

    kept = [time_ms for _, time_ms, _ in faults_of(faults_on(flash))]
    whole = (operation - 1) // WRITE_OPERATIONS
    assert kept in (list(range(whole))[::-1], list(range(whole + 1))[::-1])


def refusing_writes(open_file):
    """Return an `open` of a flash that can only be read."""

    def refusing(path, mode):
        if mode == "wb":
            raise OSError(5, "EIO")
        return open_file(path, mode)

    return refusing
