"""The host's part in opening a session with a pairing key."""

from types import SimpleNamespace

import pytest

from host.errors import NotPaired
from host.pairing import Opening, keyless, may_order, opened, session_key
from protocol import messages, secret

KEY, OTHER = bytes(range(32)), bytes(32)
OPENING = Opening(7, 0, 8, 9)


def identity(secured=messages.PAIRED, key=KEY, nonce=(1, 2), crc=3):
    """Return what a robot with that key answers."""
    proof = secret.proof(secret.session_key(secret.prepared(key), OPENING, *nonce, crc))
    return SimpleNamespace(
        secured=secured, nonce_a=nonce[0], nonce_b=nonce[1], proof_a=proof[0], proof_b=proof[1], dictionary_crc=crc
    )


def test_both_ends_with_one_key_make_the_same_session_key():
    made = session_key(KEY, OPENING, identity())

    assert made == secret.session_key(secret.prepared(KEY), OPENING, 1, 2, 3)


def test_a_wrong_key_is_told_as_such():
    with pytest.raises(NotPaired, match="wrong key: this robot was paired with another") as told:
        session_key(OTHER, OPENING, identity())

    assert told.value.exit_code == 4


def test_a_host_with_a_key_refuses_a_robot_that_says_it_has_none():
    with pytest.raises(NotPaired, match="this robot has no pairing key"):
        session_key(KEY, OPENING, identity(secured=messages.UNPAIRED))


def test_an_identity_without_its_proof_is_a_wrong_key():
    pretended = identity()
    pretended.proof_a = pretended.proof_b = 0

    with pytest.raises(NotPaired, match="wrong key"):
        session_key(KEY, OPENING, pretended)


def test_an_identity_that_answered_another_hello_is_a_wrong_key():
    with pytest.raises(NotPaired, match="wrong key"):
        session_key(KEY, OPENING._replace(nonce_b=10), identity())


@pytest.mark.parametrize("key", [KEY, b""])
def test_a_damaged_key_of_the_robot_is_told_with_its_code(key):
    with pytest.raises(NotPaired, match=r"F24 .*`softrig key new`"):
        session_key(key, OPENING, identity(secured=messages.KEY_DAMAGED))


def test_a_host_without_a_key_may_watch_a_robot_that_has_one_but_not_order():
    assert session_key(b"", OPENING, identity()) == b""
    assert not may_order(b"", identity())
    assert may_order(KEY, identity())
    assert may_order(b"", identity(secured=messages.UNPAIRED))
    assert "arm refused: this robot takes orders only with its pairing key" in str(keyless("arm"))


def test_no_two_openings_on_a_line_are_the_same():
    line = SimpleNamespace(now_s=lambda: 1.0)

    assert len({opened(line) for _ in range(100)}) == 100


def test_openings_on_a_line_whose_runs_repeat_depend_on_its_clock_alone():
    early, late = (SimpleNamespace(now_s=lambda s=s: s, repeatable=True) for s in (0.0, 0.000001))

    assert opened(early) == opened(early)
    assert opened(early) != opened(late)
    assert opened(early, attach=5).attach == 5


def test_a_session_is_never_number_0():
    lines = [SimpleNamespace(now_s=lambda us=us: us / 1e6, repeatable=True) for us in range(3000)]

    assert all(1 <= opened(line).session <= 0xFFFFFFFF for line in lines)
