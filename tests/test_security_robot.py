"""The key on the robot: whole, damaged or missing, its number of starts, and the order for the console."""

import pytest

from firmware.pairing import VERSION, Pairing
from firmware.store import Store
from hil_sim.devices.flash import Flash
from host.keys import packed
from host.pairing import Opening
from protocol import codes, frames, messages
from tests.firmware_bench import SESSION, Rig, refusal
from tests.security_bench import KEY, PairedRig
from tests.torn_flash import PowerCut, opener

WHOLE = packed(KEY)
HELLO = Opening(SESSION, 0, 8, 9)
DAMAGED = {
    "empty": b"",
    "cut short": WHOLE[:-1],
    "longer": WHOLE + b"\n",
    "huge": bytes(5000),
    "without its check": KEY,
    "a bit flipped": bytes((WHOLE[0] ^ 1,)) + WHOLE[1:],
    "its check flipped": WHOLE[:-1] + bytes((WHOLE[-1] ^ 1,)),
    "erased": b"\xff" * 36,
}


@pytest.mark.parametrize("raw", DAMAGED.values(), ids=DAMAGED)
def test_a_damaged_key_begins_no_session_and_opens_nothing(raw):
    rig = PairedRig(raw, begin=False)

    _, identity = rig.greet()
    order = messages.ARM.pack(session=SESSION, lease_ms=0, without=0)
    for session in (0, SESSION):
        for flags in (frames.RELIABLE, 0):
            rig.attack(rig.closed(frames.head(messages.ARM.number, 0, 0, flags) + order, session), 200)

    assert identity.secured == messages.KEY_DAMAGED
    assert (identity.proof_a, identity.proof_b, identity.role) == (0, 0, messages.VIEWER)
    assert (rig.core.state, rig.core.code) == (messages.TRIPPED, codes.KEY)
    assert rig.served == []


def test_a_key_that_cannot_be_read_is_a_damaged_one():
    def open_file(path, mode):
        raise OSError(5, "EIO")

    assert Pairing(open_file, b"").secured == messages.KEY_DAMAGED


def test_a_robot_without_a_key_is_open_and_writes_nothing():
    rig = Rig()

    rig.arm()

    assert rig.core.pairing.secured == messages.UNPAIRED
    assert rig.core.state == messages.ARMED
    assert rig.board.flash.files == {}


def test_no_start_makes_the_numbers_of_another():
    rig = PairedRig(begin=False)
    nonces = set()

    for _ in range(20):
        rig.restart()
        nonces |= {(rig.greet()[1].nonce_a, rig.greet()[1].nonce_b)}

    assert len(nonces) == 20


def test_a_power_cut_at_any_moment_of_a_start_makes_no_number_come_again():
    """Starts in each of which the power fails a little later, in the middle of a write."""
    flash = Flash({"key": WHOLE})
    nonces = []

    for cut_at in (*range(1, 13), 0) * 3:
        flash.cut_at = cut_at
        try:
            pairing = Pairing(opener(flash), b"")
        except PowerCut:
            continue
        assert pairing.offer(HELLO, 1)
        nonces.append(pairing.nonce)

    assert len(set(nonces)) == len(nonces) > 12


@pytest.mark.parametrize("kept", [b"", b"torn"])
def test_a_first_number_that_was_torn_by_a_power_cut_is_written_again(kept):
    rig = PairedRig(files={"/starts.0": kept}, begin=False)

    assert rig.greet()[1].secured == messages.PAIRED


def test_a_start_that_cannot_be_numbered_begins_no_session():
    rig = PairedRig(begin=False)
    rig.board.flash.broken = True
    rig.restart()

    _, identity = rig.greet()

    assert identity.secured == messages.KEY_DAMAGED
    assert rig.core.code == codes.KEY


@pytest.mark.parametrize("kept", [b"", b"torn", bytes(40)])
def test_a_lost_number_of_starts_begins_no_session(kept):
    rig = PairedRig(files={"/starts.0": kept, "/starts.1": kept}, begin=False)

    assert rig.greet()[1].secured == messages.KEY_DAMAGED


def test_what_was_kept_as_a_number_but_is_none_begins_no_session():
    flash = Flash({"key": WHOLE})
    Store(opener(flash), "starts", VERSION).write(b"not a number")

    assert Pairing(opener(flash), b"").secured == messages.KEY_DAMAGED


def test_two_robots_with_one_key_never_make_the_same_session():
    """Else what a host says to one of them could be sent to the other as well."""
    one, other = PairedRig(begin=False), PairedRig(begin=False)
    other.board.serial = b"another board"
    other.restart()
    one.restart()

    first, second = one.greet()[1], other.greet()[1]

    assert (first.nonce_a, first.proof_a) != (second.nonce_a, second.proof_a)


def test_a_paired_robot_does_not_wait_for_a_sync_that_anybody_may_say():
    rig = PairedRig()
    rig.arm()

    answers = rig.say(messages.START, paused=0, at_ms=messages.AT_SYNC)

    assert refusal(answers).code == codes.OPEN_START


def test_service_is_refused_while_the_robot_is_armed():
    rig = PairedRig()
    rig.arm()

    answers = rig.say(messages.SERVICE)

    assert refusal(answers).code == codes.NOT_WHILE_ARMED
    rig.run(500)
    assert not rig.core.leaves()


def test_service_ends_the_program_once_its_answer_is_on_its_way():
    rig = PairedRig()

    answers = rig.say(messages.SERVICE)

    assert [name for name, _ in answers] == ["ok"]
    assert not rig.core.leaves()
    rig.run(150)
    assert rig.core.leaves()


def test_service_needs_the_key():
    rig = PairedRig()

    rig.attack(rig.closed(frames.head(messages.SERVICE.number, 0, 0, frames.RELIABLE)), 300)

    assert rig.served == []
    assert not rig.core.leaves()
