"""A program as the sequencer takes it, verified, but without the line that it came over; for both interpreters."""

from protocol.verify import Check


class Loaded:
    """The code of one program, for a robot with so many coils, joints and force cells."""

    streamed = False

    def __init__(self, code, coils=8, joints=0, cells=0):
        check = Check(code, coils, len(code), joints, cells)
        while not check.go_on(64):
            pass
        self.code, self.checked, self.labels, self.fault_at = code, check.at, check.labels, check.fault_at
