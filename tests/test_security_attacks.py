"""What an attacker on the line of a paired robot can do: watch, and stop. All else is refused and counted."""

import random

import pytest

from host.errors import NotPaired
from protocol import codes, frames, messages, secret
from protocol.link import Link
from tests.firmware_bench import SESSION
from tests.security_bench import KEY, PairedRig, body_of, of_kind

ARM_FIELDS = {"session": SESSION, "lease_ms": 0, "without": 0}


@pytest.fixture
def rig():
    """A paired robot and its host, in session, idle."""
    return PairedRig()


@pytest.fixture
def armed(rig):
    """The same, armed."""
    rig.arm()
    assert rig.core.state == messages.ARMED
    return rig


def arm_said(rig) -> bytes:
    """Return the frame with which the host armed."""
    return of_kind(rig.said, messages.ARM)[0]


def test_a_host_with_the_key_arms_and_fires(armed):
    armed.fire(1)

    assert armed.core.channels.on_mask == 1
    assert armed.forged == 0


def test_every_frame_of_a_session_carries_a_tag_and_no_two_carry_the_same(armed):
    sealed = [body_of(line) for line in armed.said + armed.heard if body_of(line)[1] >= frames.GREETINGS_BELOW]
    tags = [body[-8:] for body in sealed]

    assert all(body[0] & frames.SEALED for body in sealed)
    assert len(set(tags)) == len(tags) > 10


def test_a_replayed_arm_of_the_same_session_is_a_duplicate(armed):
    armed.say(messages.DISARM)
    served = len(armed.served)

    armed.attack(arm_said(armed), 50)

    assert len(armed.served) == served
    assert armed.core.state == messages.IDLE
    assert armed.core.link.duplicates == 1


def test_a_replayed_arm_of_an_older_session_is_forged(armed):
    armed.say(messages.DISARM)
    recorded = list(armed.said)
    armed.begin(SESSION + 1)
    armed.served.clear()

    for line in recorded:
        armed.attack(line)

    assert armed.served == []
    assert armed.core.session == SESSION + 1


def test_a_session_that_is_replayed_with_its_hello_does_not_begin_again(armed):
    armed.say(messages.DISARM)
    recorded = list(armed.said)
    armed.begin(SESSION + 1)
    armed.served.clear()

    for _ in range(3):
        for line in recorded:
            armed.attack(line)

    assert armed.served == []
    assert armed.core.session == SESSION + 1
    assert armed.refused > 3 * len(recorded) // 2


def test_a_session_that_is_replayed_after_a_restart_does_not_begin_again(armed):
    recorded = list(armed.said)

    for _ in range(3):
        armed.restart()
        for line in recorded:
            armed.attack(line)

        assert armed.core.session == 0
        assert armed.served == []


def test_a_replayed_order_is_forged_once_the_numbers_have_wrapped(armed):
    armed.say(messages.DISARM)
    line = arm_said(armed)
    order = body_of(line)[2]
    while armed.core.link._next_receive % 256 != order or armed.core.link._next_receive < 256:
        armed.say(messages.STATUS_REQUEST)
    forged, served = armed.forged, len(armed.served)

    armed.attack(line)

    assert armed.forged == forged + 1
    assert len(armed.served) == served


def test_orders_that_were_put_in_another_order_are_obeyed_in_their_own(armed):
    for duty in (100, 200, 300):
        armed.host.send(
            messages.FIRE.number, messages.FIRE.pack(coils=1, duty_permille=duty, hold_ms=500), armed.now_ms
        )
    lines = [line for line in armed.host.poll(armed.now_ms).split(b"\x00") if line]

    armed.attack(b"\x00".join(reversed(lines)) + b"\x00")

    assert armed.core.channels.duty_permille[0] == 300
    assert armed.served[-3:] == ["fire"] * 3


def test_an_alive_that_comes_after_a_newer_one_is_a_duplicate(armed):
    older, newer = of_kind(armed.said, messages.ALIVE)[-2:]
    left_ms = armed.core.lease_left_ms()

    armed.attack(older)

    assert armed.core.link.duplicates == 1
    assert armed.core.lease_left_ms() < left_ms
    assert newer != older


@pytest.mark.parametrize("what", ["the newest alive", "an alive", "an arm", "everything"])
def test_what_is_replayed_does_not_renew_the_lease(armed, what):
    said = {
        "the newest alive": of_kind(armed.said, messages.ALIVE)[-1:],
        "an alive": of_kind(armed.said, messages.ALIVE)[3:4],
        "an arm": [arm_said(armed)],
        "everything": armed.said,
    }[what]

    for step in range(armed.profile.lease_ms // 5 + 2):
        armed.attack(said[step % len(said)])

    assert armed.core.state == messages.IDLE
    assert armed.core.lease_left_ms() == 0


def test_a_tag_is_wrong_if_any_of_its_bits_is(armed):
    number = armed.core.link._next_receive
    good = armed.sealed(messages.FIRE, number, armed.host.key, coils=1, duty_permille=100, hold_ms=100)
    body = body_of(good)

    for bit in range(64):
        tag = (int.from_bytes(body[-8:], "little") ^ 1 << bit).to_bytes(8, "little")
        armed.attack(armed.closed(body[:-8] + tag))

    assert armed.forged == 64
    assert armed.core.channels.on_mask == 0
    armed.attack(good)
    assert armed.core.channels.on_mask == 1


def test_every_bit_of_an_order_is_covered_by_its_tag(armed):
    number = armed.core.link._next_receive
    body = body_of(armed.sealed(messages.FIRE, number, armed.host.key, coils=1, duty_permille=100, hold_ms=100))
    served = len(armed.served)

    for place in range(len(body) - 8):
        for bit in range(8):
            armed.attack(armed.closed(body[:place] + bytes((body[place] ^ 1 << bit,)) + body[place + 1 :]))

    assert len(armed.served) == served
    assert armed.core.channels.on_mask == 0


def test_random_tags_are_forged(armed):
    number, generator = armed.core.link._next_receive, random.Random(1)
    order = messages.FIRE.pack(coils=1, duty_permille=100, hold_ms=100)

    for _ in range(500):
        flags = frames.RELIABLE | frames.SEALED
        head = frames.head(messages.FIRE.number, number & 255, 0, flags)
        armed.attack(armed.closed(head + order + generator.randbytes(8)))

    assert armed.forged == 500
    assert armed.core.channels.on_mask == 0


def test_an_order_without_its_tag_is_forged(armed):
    number = armed.core.link._next_receive
    order = messages.FIRE.pack(coils=1, duty_permille=100, hold_ms=100)

    for flags in (frames.RELIABLE, 0, frames.RELIABLE | frames.SEALED):
        armed.attack(armed.closed(frames.head(messages.FIRE.number, number & 255, 0, flags) + order))

    assert armed.forged == 3
    assert armed.core.channels.on_mask == 0


@pytest.mark.parametrize("length", range(8))
def test_a_tag_that_was_cut_short_is_forged(armed, length):
    number = armed.core.link._next_receive
    body = body_of(armed.sealed(messages.STATUS_REQUEST, number, armed.host.key))
    served = len(armed.served)

    armed.attack(armed.closed(body[: len(body) - 8 + length]))

    assert len(armed.served) == served


def test_a_robots_own_frames_are_no_orders_to_it(armed):
    recorded = [line for line in armed.heard if body_of(line)[1] >= frames.GREETINGS_BELOW]
    served = len(armed.served)

    for line in recorded:
        armed.attack(line)

    assert armed.forged == len(recorded) > 2
    assert len(armed.served) == served


def test_an_order_that_was_tagged_as_if_by_the_robot_is_forged(armed):
    number = armed.core.link._next_receive

    armed.attack(armed.sealed(messages.DISARM, number, armed.host.key, device=True))

    assert armed.forged == 1
    assert armed.core.state == messages.ARMED


def test_orders_without_a_session_are_nobodys(rig):
    rig.restart()
    rig.attack(b"")

    order = messages.ARM.pack(session=0, lease_ms=0, without=0)
    rig.attack(rig.closed(frames.head(messages.ARM.number, 0, 0, frames.RELIABLE) + order, session=0))

    assert rig.served == []
    assert rig.core.link.foreign == 1


def test_an_order_without_a_tag_does_not_begin_the_session_that_its_hello_asked_for(rig):
    rig.greet(SESSION + 1)
    order = messages.ARM.pack(session=SESSION + 1, lease_ms=0, without=0)

    for flags in (frames.RELIABLE, 0):
        rig.attack(rig.closed(frames.head(messages.ARM.number, 0, 0, flags) + order, SESSION + 1))

    assert rig.core.session == SESSION
    assert rig.served == []
    assert rig.forged == 2


def test_a_flood_of_hellos_takes_nothing_from_a_session(armed):
    armed.fire(1, hold_ms=2000)
    generator = random.Random(1)

    for _ in range(100):
        armed.greet(generator.randrange(1, 1 << 32), generator.choice((0, SESSION)), (generator.randrange(1 << 32), 0))
        armed.run(5)

    assert armed.core.session == SESSION
    assert armed.core.state == messages.ARMED
    assert armed.core.channels.on_mask == 1
    assert armed.forged == 0


def test_a_hello_that_names_another_session_to_take_over_makes_another_key(armed):
    """An attacker changes a second host's hello so that it would take the lease over; that host's frames fail then."""
    mine, identity = armed.greet(SESSION + 1, attach=0)
    key = secret.session_key(secret.prepared(KEY), mine, identity.nonce_a, identity.nonce_b, armed.crc)
    armed.greet(SESSION + 1, attach=SESSION)

    armed.attack(armed.sealed(messages.STATUS_REQUEST, 0, key, SESSION + 1))

    assert armed.core.session == SESSION
    assert armed.core.state == messages.ARMED


def test_a_hello_of_a_session_that_is_over_changes_nothing_of_the_one_on_offer():
    rig = PairedRig(begin=False)
    rig.begin(SESSION + 5)
    rig.begin(SESSION)
    rig.arm()
    mine, identity = rig.greet(SESSION + 1, attach=0)
    key = secret.session_key(secret.prepared(KEY), mine, identity.nonce_a, identity.nonce_b, rig.crc)
    rig.greet(SESSION + 5, attach=SESSION)

    rig.attack(rig.sealed(messages.STATUS_REQUEST, 0, key, SESSION + 1))

    assert rig.core.session == SESSION


def test_a_second_host_with_the_key_takes_over_only_if_it_asks_to(armed):
    armed.begin(SESSION + 1)
    assert armed.core.session == SESSION

    armed.begin(SESSION + 2, attach=SESSION)

    assert armed.core.session == SESSION + 2
    assert armed.core.state == messages.ARMED


def test_a_viewer_without_the_key_reads_telemetry_and_may_stop(armed):
    armed.say(messages.SUBSCRIBE, slot=0, period_ms=20, on_change=0, variables=b"")
    viewer = Link(armed.crc)

    heard = [received.kind for line in armed.heard[-1:] for received in viewer.receive(line, 0)]
    armed.run(100)
    heard += [received.kind for line in armed.heard for received in viewer.receive(line, 0)]
    armed.attack(frames.STOP)

    assert heard.count(messages.TELEMETRY.number) >= 4
    assert armed.core.state == messages.TRIPPED
    assert armed.core.code == codes.STOP


def test_a_robot_that_was_stopped_is_cleared_only_with_the_key(armed):
    armed.attack(frames.STOP)

    armed.attack(armed.closed(frames.head(messages.CLEAR.number, 0, 0, frames.RELIABLE)))
    assert armed.core.state == messages.TRIPPED
    armed.say(messages.CLEAR)

    assert armed.core.state == messages.IDLE


def test_a_host_with_another_key_is_told_by_the_robots_proof_and_cannot_begin():
    rig = PairedRig(begin=False)

    with pytest.raises(NotPaired, match="wrong key"):
        rig.begin(key=bytes(32))

    assert rig.core.session == 0


def test_the_same_hello_said_again_before_its_session_began_is_answered_alike():
    rig = PairedRig(begin=False)

    first, again = rig.greet(), rig.greet()
    other = rig.greet(nonce=(8, 10))

    assert first[1]._replace(uptime_ms=0) == again[1]._replace(uptime_ms=0)
    assert other[1].nonce_a != first[1].nonce_a


def test_the_same_hello_said_again_after_its_session_began_makes_another_key():
    rig = PairedRig(begin=False)
    before = rig.greet()
    rig.begin()

    after = rig.greet()

    assert (after[1].nonce_a, after[1].proof_a) != (before[1].nonce_a, before[1].proof_a)


def test_forgers_cannot_make_a_robot_look_at_more_tags_than_a_line_brings_in_a_step(armed, monkeypatch):
    looked = []
    genuine = secret.tag
    monkeypatch.setattr(secret, "tag", lambda *arguments: looked.append(1) or genuine(*arguments))
    seed = frames.session_seed(armed.crc, armed.core.session)
    flags = frames.SEALED
    forged = [frames.encode(frames.seal(messages.ALIVE.number, i, 0, bytes(15), seed, flags)) for i in range(200)]

    before = armed.core.link.forged
    armed.core.step(armed.now_ms, b"".join(forged), 0)

    assert armed.core.link.forged - before == 200
    assert len(looked) <= 24
