"""What the core answers to messages that are wrong, foreign, too many, or its own."""

from binascii import crc32

import pytest

from protocol import codes, messages
from protocol.frames import RELIABLE, STOP, encode, seal
from tests.firmware_bench import Rig, refusal, usual


@pytest.fixture
def rig():
    return Rig()


def test_unknown_and_misshapen_messages_are_refused_not_raised(rig):
    rig.host.send(0x7F, b"", rig.now_ms)
    rig.host.send(messages.FIRE.number, b"short", rig.now_ms)
    answers = rig.run(10)
    rig.host.post(0x0E, b"")
    rig.host.post(messages.HELLO.number, b"")
    answers += rig.run(10)

    assert [body.code for name, body in answers if name == "refused"] == [codes.UNKNOWN_MESSAGE, codes.BAD_PAYLOAD]
    assert [body.code for name, body in answers if name == "nak"] == [codes.UNKNOWN_MESSAGE, codes.BAD_PAYLOAD]


def test_a_figure_greater_than_an_answer_can_carry_is_refused_all_the_same(rig):
    rig.arm()

    said = refusal(rig.fire(0xFFFFFFFF))

    assert (said.code, said.value) == (codes.UNKNOWN_CHANNEL, 0x7FFFFFFF)


def test_a_hello_of_another_version_is_told_so_whatever_it_carries(rig):
    """The frame says version 7 in its head, and its payload is shorter than ours."""
    body = bytes((0x78, messages.HELLO.number, 0, 0)) + bytes((7, 1, 2, 3, 4, 5, 6, 7))
    answer = rig.core.step(rig.now_ms, encode(body + crc32(body).to_bytes(4, "little")), 1024)

    ((kind, _, payload),) = rig.host.receive(answer, 0)

    nak = messages.NAK.unpack(payload)
    assert (kind, nak.code, nak.version) == (messages.NAK.number, codes.OTHER_VERSION, 2)


def test_its_own_words_coming_back_are_not_answered(rig):
    """A loopback plug, or a line that echoes, must not make the robot talk to itself for ever."""
    rig.host.post(0x0E, b"")
    echo = rig.core.step(rig.now_ms, rig.host.poll(0), 1024)
    assert echo

    again = rig.core.step(rig.now_ms + 5, echo, 1024)

    assert again == b""


def test_a_host_that_acknowledges_nothing_goes_without_answers(rig):
    rig.arm()

    for number in range(200):
        body = seal(messages.FIRE.number, (number + 1) & 255, 0, b"", rig.host.decoder.seed, RELIABLE)
        rig.core.step(rig.now_ms, encode(body), 1024)
        rig.now_ms += 5

    assert rig.core.state == messages.ARMED
    rig.run(5, line=STOP)
    assert rig.core.code == codes.STOP


def test_telemetry_comes_at_its_period_with_every_channel(rig):
    rig.arm()
    rig.fire(1)
    rig.say(messages.SUBSCRIBE, slot=0, period_ms=50, on_change=0, variables=b"")

    records = [body for name, body in rig.run(1000) if name == "telemetry"]

    assert len(records) in (19, 20)
    duty_permille, coil_decidegc, *of_others = usual(records[0])[8:]
    assert duty_permille == (500, 0, 0, 0, 0, 0, 0, 0)
    assert len(coil_decidegc) == 8
    assert of_others == [()] * 6


def test_nothing_is_armed_any_more_once_the_console_was_asked_for(rig):
    rig.say(messages.SERVICE)

    assert refusal(rig.arm()).code == codes.BUSY
    assert not rig.board.powered
