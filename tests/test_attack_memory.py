"""What a stranger, or a host that keeps to no credit, can make a robot remember: little, and that much is there."""

import pytest

from hil_sim.link import open_link
from protocol import frames, messages, program
from protocol import link as links
from protocol.link import Link
from tests.firmware_bench import SESSION, Rig

CREDIT_BYTES = 960
QUESTION = frames.encode(
    frames.seal(messages.DICTIONARY.number, 0, 0, messages.DICTIONARY.pack(part=0, offset=0, count=200), 0, 0)
)


def order(crc: int, number: int, message=messages.CODE, **fields) -> bytes:
    """Return an order of the session as the wire has it."""
    seed = frames.session_seed(crc, SESSION)
    return frames.encode(frames.seal(message.number, number, 0, message.pack(**fields), seed, frames.RELIABLE))


def test_answers_to_strangers_do_not_pile_up():
    rig = Rig()

    for _ in range(50):
        rig.core.step(rig.now_ms, 20 * QUESTION, 0)
        rig.now_ms += 5

    assert len(rig.core.link._posts) <= links.POSTS_MAX
    assert 200 * links.POSTS_MAX < 4000


def test_what_came_before_its_turn_is_kept_only_within_the_credit():
    robot = Link(5, device=True)
    robot.grant_bytes = CREDIT_BYTES
    robot.begin(5, SESSION)

    for number in range(1, 32):
        robot.receive(order(5, number, offset=0, code=bytes(200)), 0)
    kept = sum(len(received.payload) for _, received in robot._ahead)
    delivered = robot.receive(order(5, 0, offset=0, code=b""), 0)

    assert 0 < kept <= CREDIT_BYTES
    assert [received.seq for received in delivered] == list(range(1 + kept // 202))
    assert robot.receive(order(5, len(delivered), offset=0, code=bytes(200)), 0)


@pytest.mark.parametrize("robot", ["circular"])
def test_a_flood_of_questions_and_programs_fits_into_the_memory_of_a_robot(robot):
    line = open_link(f"sim:{robot}?body=still&world=micropython")
    bench, rig = line.bench, Rig()
    crc = rig.core.link.decoder.dictionary_crc

    def say(data: bytes, ms: int = 20) -> None:
        line.write(data)
        bench.clock.run_until(bench.clock.now_us + 1000 * ms)

    greeted = messages.HELLO.pack(version=frames.VERSION, session=SESSION, attach=0, nonce_a=0, nonce_b=0)
    say(frames.encode(frames.seal(messages.HELLO.number, 0, 0, greeted, 0, 0)), 200)
    for slot in range(4):
        many = bytes([15, 16, 17, 18, 19, 20, 21])
        say(order(crc, slot, messages.SUBSCRIBE, slot=slot, period_ms=5, on_change=0, variables=many))
    for number in range(5, 20):
        say(order(crc, number, offset=0, code=bytes(230)))
    for _ in range(20):
        say(6 * QUESTION, 10)
    header = program.header(bytes(4096), rig.profile.crc)
    for number in range(4, 20):
        say(order(crc, number, messages.PROGRAM, header=header))

    assert bench.crashes == []
    line.close()
