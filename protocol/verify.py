"""Verification of a program's code: what no robot may run is refused before any of it runs.

check = Check(code, coils=8, bytes_max=4096)
while not check.go_on(32):  # a piece of it in each control step
    ...
"""

from array import array

from protocol import program

ALL = (1 << program.DEPTH_MAX + 1) - 1


def check_code(code: bytes, coils: int, bytes_max: int, joints: int = 0, cells: int = 0) -> None:
    """Raise BadProgram unless the whole code may be run, see Check."""
    check = Check(code, coils, bytes_max, joints, cells)
    while not check.go_on(len(code)):
        pass


class Check:
    """Verifies a code piece by piece, so that a control step need not wait for all of it.

    Every op is whole and known, loops nest and take time, guards are few, a coil is aimed before it is used, a wait
    goes on at a label further down and outside all loops, and the code ends with HALT; else BadProgram. Limits of duty
    and time are not looked at here: the channels hold every order against them as it runs.
    What it has seen so far asks where down is: `needs_attitude`; asks how the gripped object lies: `needs_camera`;
    turns it by the camera: `needs_loop`; asks for the force on the load cell: `needs_load`; regulates it:
    `needs_press`. `labels` are the places of the labels, `fault_at` is that of ON_FAULT or -1.

    Of a streamed code, which has no loops, `code` is the buffer that it comes to and `end` how much of it is there.
    """

    def __init__(self, code: bytes, coils: int, bytes_max: int, joints: int = 0, cells: int = 0,
                 streamed: bool = False) -> None:  # fmt: skip
        if not streamed and not 0 < len(code) <= bytes_max:
            raise program.BadProgram(f"{len(code)} bytes of code, at most {bytes_max}")
        self.needs_attitude = self.needs_camera = self.needs_loop = self.needs_load = self.needs_press = False
        self.at = 0  # what is before this has been looked at
        self.end = 0 if streamed else len(code)
        self.labels = array("H", [0] * program.LABELS_MAX)
        self.fault_at = -1
        self._streamed = streamed
        self._code = code
        self._coils = (1 << coils) - 1
        self._joints = (1 << coils + joints) - 1 - self._coils
        self._cells = (1 << cells) - 1
        self._op = program.STEP
        self._depth = 0
        self._timed = 0  # mask of the loops, by their depth, in which time passes
        self._guards = 0
        self._aims = 0  # mask of the places that hold a coil from here on
        self._aims_at = array("B", [0xFF] * program.LABELS_MAX)  # of those that hold one whenever a wait goes on there
        self._seen = 0  # masks of labels: those that stand further up, and
        self._wanted = 0  # those that a wait goes on at and that are still to come

    def go_on(self, ops: int) -> bool:
        """Look at that many more ops; return whether all has been seen."""
        for _ in range(ops):
            if self.at == self.end:
                break
            self._one()
        if self.at < self.end or self._streamed:
            return self.at == self.end
        if self._op != program.HALT or self._depth or self._wanted:
            raise program.BadProgram("needs a halt at its end, closed loops and every label that is named", self.at)
        return True

    def _one(self) -> None:
        op, at = self._code[self.at], self.at
        if op >= len(program.SIZES) or at + program.SIZES[op] > self.end:
            raise program.BadProgram(f"op {op} unknown or cut short", at)
        self._nest(op, at)
        self._masks(op, at)
        _check_arguments(self._code, at)
        self.needs_loop = self.needs_loop or op == program.ORIENT
        self.needs_camera = self.needs_camera or self.needs_loop
        self.needs_press = self.needs_press or op == program.PRESS
        self.needs_load = self.needs_load or self.needs_press
        if op == program.AIM:
            self._aim(at)
        elif op == program.AIMED:
            self._chosen(self._code[at + 1], at)
        elif op == program.LABEL:
            self._label(self._code[at + 1], at)
        elif op in (program.WAIT, program.GUARD):
            self._condition(program.read_condition(self._code, at + 1), at)
        if op == program.WAIT:
            self._otherwise(self._code[at + 13], at)
        self._op = op
        self.at += program.SIZES[op]

    def _nest(self, op: int, at: int) -> None:
        """Raise BadProgram where loops do not nest, or one takes no time, or guards are too many."""
        if op == program.REPEAT:
            self._depth += 1
            self._timed &= ~(1 << self._depth)
        elif op == program.NEXT:
            if self._depth > 0 and not self._timed >> self._depth & 1:
                raise program.BadProgram("a loop that takes no time", at)
            self._depth -= 1
        elif op == program.WAIT or (op == program.DELAY and program.number(self._code, at + 1, 4)):
            self._timed = ALL
        self._guards += op == program.GUARD
        if self._depth < 0 or self._depth > program.DEPTH_MAX or (self._depth and self._streamed):
            raise program.BadProgram(f"loops nested {self._depth} deep, at most {program.DEPTH_MAX}, streamed 0", at)
        if self._guards > program.GUARDS_MAX:
            raise program.BadProgram(f"{self._guards} guards, at most {program.GUARDS_MAX}", at)

    def _otherwise(self, otherwise: int, at: int) -> None:
        """Take note of the label that a wait goes on at."""
        if otherwise < program.JUMP:
            return
        label = otherwise - program.JUMP
        if label >= program.LABELS_MAX or self._seen >> label & 1:
            raise program.BadProgram(f"label {label} is none that could come", at)
        self._wanted |= 1 << label
        self._aims_at[label] &= self._aims

    def _label(self, label: int, at: int) -> None:
        if label == program.ON_FAULT:
            if self._op != program.HALT or self.fault_at >= 0 or self._wanted:
                raise program.BadProgram("what runs after an abort does not stand by itself at the end", at)
            self.fault_at = at
            self._aims = 0
        elif label >= program.LABELS_MAX or self._seen >> label & 1 or self._depth:
            raise program.BadProgram(f"label {label} twice, or in a loop, or beyond {program.LABELS_MAX}", at)
        else:
            self._seen |= 1 << label
            self._wanted &= ~(1 << label)
            self.labels[label] = at
            self._aims &= self._aims_at[label]

    def _aim(self, at: int) -> None:
        place, ahead, circle = self._code[at + 1], self._code[at + 2], program.read_circle(self._code, at)
        count = len(circle)
        hole = bytes(circle) != self._code[at + 3 : at + 3 + count]
        if place >= program.AIMS_MAX or hole or count < 2 or ahead >= count or self._coils >> max(circle) == 0:
            raise program.BadProgram(f"a circle {circle} that place {place} cannot be aimed in", at)
        self._aims |= 1 << place
        self.needs_attitude = True

    def _chosen(self, place: int, at: int) -> None:
        if place >= program.AIMS_MAX or not self._aims >> place & 1:
            raise program.BadProgram(f"place {place} holds no coil yet", at)

    def _condition(self, condition, at: int) -> None:
        source, quantifier = condition.source, condition.quantifier
        if quantifier == program.CHOSEN and source in program.OF_COILS:
            self._chosen(condition.mask, at)
        elif not (program.TEMPERATURE <= source <= program.TIME and quantifier <= program.ALL):
            raise program.BadProgram("a condition this robot does not know", at)
        elif source in program.OF_COILS:
            _check_mask(condition.mask, self._coils, at)
        elif source in program.OF_JOINTS:
            _check_mask(condition.mask, self._joints, at)
        elif source in program.OF_CELLS:
            _check_mask(condition.mask, self._cells, at)
        elif source == program.TIME and condition.mask > program.TIME_MAX_MS:
            raise program.BadProgram(f"a time of {condition.mask} ms, at most {program.TIME_MAX_MS}", at)
        if condition.compare > program.ABOVE:
            raise program.BadProgram("a condition this robot does not know", at)
        self.needs_attitude = self.needs_attitude or source in program.OF_ATTITUDE
        self.needs_camera = self.needs_camera or source == program.ORIENTATION
        self.needs_load = self.needs_load or source == program.FORCE

    def _masks(self, op: int, at: int) -> None:
        """Raise BadProgram when an order is for channels that this robot has not, or that are of the other kind."""
        if op in (program.FIRE, program.RAMP, program.OFF):
            _check_mask(program.number(self._code, at + 1, 4), self._coils, at)
        elif op == program.MOVE:
            _check_mask(program.number(self._code, at + 1, 4), self._joints, at)
        elif op in (program.ORIENT, program.PRESS) and not self._joints:
            raise program.BadProgram("joints are to be regulated, and this robot has none", at)


def _check_mask(mask: int, known: int, at: int) -> None:
    if not mask or mask & ~known:
        raise program.BadProgram(f"channels {mask:#x}, this robot has {known:#x} of that kind", at)


def _check_arguments(code: bytes, at: int) -> None:
    op = code[at]
    duty_at = 5 if op in (program.FIRE, program.RAMP) else 2 if op == program.AIMED else 0
    duty_permille = program.number(code, at + duty_at, 2) if duty_at else 0
    if duty_permille > 1000:
        raise program.BadProgram(f"duty {duty_permille} permille, at most 1000", at)
    if duty_at and program.number(code, at + duty_at + 4, 2) == program.KEEP:
        raise program.BadProgram("a coil that is to be kept at no temperature", at)
    time_at = 1 if op == program.DELAY else 9 if op == program.WAIT else 0
    if time_at and program.number(code, at + time_at, 4) > program.TIME_MAX_MS:
        raise program.BadProgram(f"a time beyond {program.TIME_MAX_MS} ms", at)
    if op == program.REPEAT and program.number(code, at + 1, 2) == 0:
        raise program.BadProgram("a loop of no turns", at)
    if op == program.PRESS and program.number(code, at + 3, 2) > program.number(code, at + 5, 4):
        raise program.BadProgram("a force that is to be reached after the end of its order", at)
