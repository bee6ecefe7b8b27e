"""Hostile hosts at a press, seeded: whatever arrives, the firmware lives, nothing is pressed too hard, `stop` stops.

That it neither leaves its range nor presses on beyond the force that trips, the invariants of every bench see.
"""

import random

import pytest

from protocol import messages, program
from tests.test_hil_fuzz import Attacker, program_of

ADDRESS = "sim:press?set=block.columns_count:16&set=block.rows_count:8&set=material.youngs_modulus_kpa:150"
SOURCES = (program.POSITION, program.JOINT_CURRENT, program.FORCE, program.PRESSURE)


class Presser(Attacker):
    """A host that orders depths and forces, legal ones and others."""

    def __init__(self, seed: int) -> None:
        super().__init__(seed, ADDRESS)
        self._acts += 6 * (self._orders,) + 3 * (self._wait,)

    def _wait(self) -> None:
        for _ in range(10):
            self._say(messages.STATUS_REQUEST)
            self.listen(0.05)

    def _code(self) -> bytes:
        return program_of(self.random, piece_of)

    def _order(self) -> None:
        draw = self.random
        over_ms = draw.choice((0, *(draw.randrange(600, 3000) for _ in range(5)), 65_535))
        hold_ms = draw.choice((100, draw.randrange(600_000), draw.randrange(1 << 32)))
        if draw.random() < 0.5:
            target_centi = draw.choice((*(draw.randrange(0, 1100) for _ in range(5)), draw.randrange(-32_768, 32_768)))
            joints = draw.choice((1, 1, 1, 1, 1, draw.randrange(1 << 32)))
            self._say(messages.MOVE, joints=joints, target_centi=target_centi, over_ms=over_ms, hold_ms=hold_ms)
        else:
            target_mn = draw.choice((draw.randrange(19_000), draw.randrange(19_000), draw.randrange(1 << 16)))
            time_ms = draw.choice((over_ms, over_ms + draw.randrange(4000), draw.randrange(1 << 32)))
            fields = {"over_ms": over_ms, "time_ms": time_ms, "hold_ms": hold_ms}
            self._say(messages.PRESS, target_mn=target_mn, **fields)


def piece_of(draw: random.Random) -> bytes:
    """Return a piece of a program of a press."""
    source = draw.choice(SOURCES)
    mask = {program.FORCE: 0, program.PRESSURE: draw.randrange(1, 64)}.get(source, 1)
    below, value = draw.randrange(2), draw.randrange(-500, 20_000)
    condition = program.Condition(source, draw.randrange(2), below, value, mask)
    over_ms = draw.randrange(2000)
    return draw.choice((
        program.move(1, draw.randrange(-600, 1100), over_ms), program.delay(draw.randrange(900)),
        program.press(draw.randrange(19_000), over_ms, over_ms + draw.randrange(2000)),
        program.wait(condition, draw.randrange(800), draw.randrange(2)),
        program.guard(condition) if draw.random() < 0.2 else program.step(draw.randrange(1 << 16)),
    ))  # fmt: skip


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_whatever_arrives_the_firmware_lives_and_stop_lets_the_axis_go(seed):
    attacker = Presser(seed)
    bench = attacker.bench

    while bench.clock.now_us < 10_000_000:
        attacker.act()
        if attacker.random.random() < 0.05:
            attacker.stop()
            assert not bench.any_joint_driven
    attacker.stop()

    assert not bench.any_joint_driven
    assert bench.crashes == []
    assert bench.world.resets == 0
