"""Both ends over a line that loses, repeats, delays and flips a fifth of all frames each: once, in order, in time.

The rules are what may happen to two ends; `Ends` asserts of each order that is delivered that it is the next one of the
session that is in force, and that nothing has grown. When the line becomes good, all that was said arrives in time.
"""

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule

from protocol import flight
from protocol.link import QUEUE_MAX, LinkFull
from protocol.messages import FIRE
from tests.two_ends import Ends

SHARE = 0.2
counts = st.sampled_from([1, 1, 3, 20, QUEUE_MAX])
times_ms = st.sampled_from([5, 20, 100])


class TwoEnds(RuleBasedStateMachine):
    """A robot, its host, and the hosts that come after."""

    @initialize(
        seed=st.integers(0, 2**32), node=st.sampled_from([0, 5]), keyed=st.booleans(), share=st.sampled_from([0, SHARE])
    )
    def begin(self, seed, node, keyed, share):
        self.ends = Ends(seed, share, node, keyed)
        self.share = share

    @rule(count=counts, ms=times_ms)
    def the_host_gives_orders(self, count, ms):
        self.ends.host_says(count)
        self.ends.run(ms)

    @rule(count=counts, ms=times_ms)
    def the_robot_tells(self, count, ms):
        self.ends.robot_says(count)
        self.ends.run(ms)

    @rule(count=counts, ms=times_ms)
    def both_speak(self, count, ms):
        self.ends.host_says(count)
        self.ends.robot_says(count)
        self.ends.run(ms)

    @rule()
    def a_full_queue_takes_no_more(self):
        self.ends.host_says(QUEUE_MAX)
        if self.ends.host.open:
            with pytest.raises(LinkFull):
                self.ends.host.link.send(FIRE.number, b"", self.ends.now_ms)

    @rule(ms=times_ms)
    def time_passes(self, ms):
        self.ends.run(ms)

    @rule(there=st.booleans(), back=st.booleans(), ms=st.sampled_from([50, 500, 1500]))
    def a_wire_is_off(self, there, back, ms):
        self.ends.there.cut, self.ends.back.cut = there, back
        self.ends.run(ms)
        self.ends.there.cut = self.ends.back.cut = False

    @rule()
    def another_host_comes(self):
        self.ends.new_session()

    @rule(may=st.booleans())
    def the_lease_is_taken_or_free(self, may):
        self.ends.robot.may_adopt = may

    @rule(count=st.integers(1, 20))
    def what_was_heard_comes_again(self, count):
        self.ends.replay(count)

    @rule(octets=st.sampled_from([0, 100, 448, flight.BYTES_ANY]))
    def the_robot_grants_other_credit(self, octets):
        self.ends.robot.grant_bytes = octets

    @rule()
    def the_line_becomes_good_for_a_while(self):
        self.ends.clear_up()
        self.ends.there.share = self.ends.back.share = self.share

    def teardown(self):
        if hasattr(self, "ends"):
            self.ends.clear_up()


TwoEnds.TestCase.settings = settings(max_examples=80, stateful_step_count=40, deadline=None)
TestTwoEnds = TwoEnds.TestCase


@pytest.mark.parametrize(("node", "keyed"), [(0, False), (5, True)], ids=["plain", "node and tags"])
def test_thousands_of_orders_go_both_ways_exactly_once_while_numbers_wrap(node, keyed):
    ends = Ends(1, SHARE, node, keyed)
    ends.run(2000)

    while min(ends.host.said, ends.said.get(1, 0)) < 2000:
        ends.host_says(ends.chance.randrange(8))
        ends.robot_says(ends.chance.randrange(8))
        if keyed:
            ends.replay(ends.chance.randrange(2))
        ends.run(20)
    ends.clear_up()

    assert ends.host.session == 1
    assert (ends.taken[1], ends.host.got) == (ends.host.said, ends.said[1])
    assert ends.robot.resent + ends.host.link.resent < 1.5 * (ends.taken[1] + ends.host.got)


@pytest.mark.parametrize("seed", range(4))
def test_sessions_that_change_all_the_time_never_mix(seed):
    """Each gives a few orders, and goes on sending them while the next one begins."""
    ends = Ends(seed, SHARE, keyed=seed % 2 == 1)

    for _ in range(60):
        ends.robot.may_adopt = ends.chance.random() < 0.8
        ends.new_session()
        for _ in range(ends.chance.randrange(1, 12)):
            ends.host_says(ends.chance.randrange(3))
            ends.robot_says(ends.chance.randrange(3))
            ends.run(30)
        ends.replay(ends.chance.randrange(30))
    ends.clear_up()

    assert len(ends.taken) > 10


@pytest.mark.parametrize("seed", range(4))
def test_queues_that_fill_at_both_ends_are_empty_soon_after_the_line_is_good(seed):
    ends = Ends(seed, SHARE, keyed=seed % 2 == 1)

    for _ in range(10):
        for _ in range(10):
            ends.host_says(QUEUE_MAX)
            ends.robot_says(QUEUE_MAX)
            ends.run(20)
        share = ends.there.share
        assert ends.clear_up() < 1500
        ends.there.share = ends.back.share = share

    assert ends.host.session == 1


def test_of_what_was_recorded_in_a_session_with_tags_nothing_is_taken_again():
    ends = Ends(2, 0.0, keyed=True)
    for _ in range(100):
        ends.host_says(3)
        ends.run(20)
    taken, heard_ms = ends.taken[1], ends.robot.heard_ms
    ends.host.link.begin(0, 0)

    for _ in range(50):
        ends.replay(20)
        ends._robot_hears(ends.there.land(ends.now_ms + 1000))

    assert (ends.taken[1], ends.robot.heard_ms) == (taken, heard_ms)
    assert ends.robot.forged + ends.robot.duplicates > 900
