"""A line full of questions: the answer to a stop must not drown among those to strangers."""

from protocol import frames, messages
from protocol import link as links
from protocol.link import Link
from tests.firmware_bench import Rig

BUFFER_BYTES = 512  # that the robot's line keeps
STEP_BYTES = 57  # that it carries in a control step at 115200 baud


def test_what_goes_first_is_not_what_gives_way():
    link = Link()
    for _ in range(links.POSTS_MAX):
        link.post(messages.NAK.number, b"old")

    link.post(messages.STOPPED.number, b"first", first=True)
    for _ in range(links.POSTS_MAX):
        link.post(messages.NAK.number, b"new")

    told = [received.kind for received in Link().receive(link.poll(0), 0)]
    assert told[0] == messages.STOPPED.number
    assert len(told) == links.POSTS_MAX


def test_a_stop_is_answered_at_once_while_a_stranger_asks_for_page_after_page():
    """The questions fill the line to the robot, their answers are ten times as long as what it carries back."""
    rig, waiting = Rig(), 0
    asked = messages.DICTIONARY.pack(part=0, offset=0, count=200)
    question = frames.encode(frames.seal(messages.DICTIONARY.number, 0, 0, asked, 0, 0))
    told = []

    for step in range(400):
        line = question * (STEP_BYTES // len(question))
        stops = step % 50 == 49
        answer = rig.core.step(rig.now_ms, frames.STOP + line if stops else line, BUFFER_BYTES - waiting)
        rig.now_ms += 5
        waiting = max(0, waiting + len(answer) - STEP_BYTES)
        if stops:
            told.append([received.kind for received in Link().receive(answer, 0)][:1])

    assert told == [[messages.STOPPED.number]] * 8
