"""Play between the screw of a press and its tool.

The tool hangs at the lower end of the play while the block carries less than its weight, and is at the upper end when
it is pressed with more; in between it floats, and the block carries just its weight. The load cell is below the play
and reads 0 while the tool hangs free. So depth 0 is where the hanging tool touches.

    state = follow(press, state, dt=0.010, at=0.001, play=1e-4, weight=0.5)
"""

from hil_sim.physics.block.press import Press, Pressed


def follow(press: Press, state: Pressed, dt: float, at: float, play: float, weight: float) -> Pressed:
    """Return press and block after a step of `dt` [s] that ends with the screw `at` [m]; play in m, weight in N."""
    if not play:
        return press.advance(state, dt, depth=at)
    ends = ((at, False), (at - play, True))
    for depth, lifted in ends if state.force < weight else ends[::-1]:
        there = press.advance(state, dt, depth=depth)
        if there.force >= weight if lifted else there.force <= weight:
            return there
    return press.advance(state, dt, force=weight)
