"""What a host that takes over must find: all that the robot had promised to the one before it."""

import pytest

from protocol import messages, program
from tests.firmware_bench import SESSION, Rig

CODE = program.fire(1, 300, 100) + program.delay(100) + program.halt()
OTHER = SESSION + 1


@pytest.fixture
def rig():
    """A robot that is armed and has a program."""
    rig = Rig()
    rig.upload(CODE, program.header(CODE, rig.profile.crc))
    rig.arm()
    return rig


def test_a_program_that_waits_for_its_time_is_handed_over_with_the_lease(rig):
    at_ms = rig.now_ms + 500
    rig.say(messages.START, paused=0, at_ms=at_ms)

    rig.hello(OTHER, attach=SESSION)
    rig.run(1000)

    assert rig.core.session == OTHER
    assert [event.now_ms for event in rig.events("started")] == [at_ms]
    assert rig.events("finished")


def test_a_program_that_waits_for_a_sync_is_handed_over_with_the_lease(rig):
    rig.say(messages.START, paused=0, at_ms=messages.AT_SYNC)

    rig.hello(OTHER, attach=SESSION)
    rig.run(100)
    rig.say(messages.SYNC)
    rig.run(300)

    assert rig.events("started")
    assert rig.events("finished")


@pytest.mark.parametrize("word", [b"", messages.SYNC])
def test_a_program_that_waits_does_not_start_for_a_host_that_did_not_take_it_over(rig, word):
    rig.say(messages.START, paused=0, at_ms=messages.AT_SYNC if word else rig.now_ms + 500)
    rig.core.lease_ms = 1  # so short that the next host finds it over

    rig.hello(OTHER)
    if word:
        rig.host.post(word.number, b"")
    rig.run(1000)

    assert rig.core.session == OTHER
    assert rig.core.state == messages.IDLE
    assert not rig.events("started")
