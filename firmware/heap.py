"""When garbage is collected: never by itself in the middle of a step, but where a step has time left.

A collection takes about 1 ms on an RP2040. What must not come late allocates nothing; what does, as a frame that is
served, leaves some hundred bytes behind.
"""

import gc

EVERY = 8  # steps between two collections, where there is time
AT_LATEST = 32
ENOUGH_MS = 2


class Heap:
    """Takes the collecting over from the interpreter, which is left the one before an allocation that would fail.

    A burst of orders can leave more behind between two collections than a small heap has.
    """

    def __init__(self) -> None:
        self._steps = 0
        gc.collect()
        gc.threshold(-1)

    def collect(self, left_ms: int) -> bool:
        """Collect if it is due and the step has that much time left, or if it cannot wait; return whether it did."""
        self._steps += 1
        if self._steps < (EVERY if left_ms >= ENOUGH_MS else AT_LATEST):
            return False
        self._steps = 0
        gc.collect()
        return True
