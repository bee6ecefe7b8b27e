"""Verification of a program's code: what no robot may run is refused before any of it runs.

check = Check(code, coils=8, bytes_max=4096)
while not check.go_on(32):  # a piece of it in each control step
    ...
"""

from protocol import program


def check_code(code: bytes, coils: int, bytes_max: int, joints: int = 0, cells: int = 0) -> None:
    """Raise BadProgram unless the whole code may be run, see Check."""
    check = Check(code, coils, bytes_max, joints, cells)
    while not check.go_on(len(code)):
        pass


class Check:
    """Verifies a code piece by piece, so that a control step need not wait for all of it.

    Every op is whole and known, loops nest, guards are few, a coil is aimed before it is used, and the code ends with
    HALT; else BadProgram. Limits of duty and time are not looked at here: the channels hold every order against them
    as it runs. What it has seen so far asks where down is: `needs_attitude`; asks how the gripped object lies:
    `needs_camera`; turns it by the camera: `needs_loop`; asks for the force on the load cell: `needs_load`; regulates
    it: `needs_press`.
    """

    def __init__(self, code: bytes, coils: int, bytes_max: int, joints: int = 0, cells: int = 0) -> None:
        if not 0 < len(code) <= bytes_max:
            raise program.BadProgram(f"{len(code)} bytes of code, at most {bytes_max}")
        self.needs_attitude = self.needs_camera = self.needs_loop = self.needs_load = self.needs_press = False
        self._code = code
        self._coils = (1 << coils) - 1
        self._joints = (1 << coils + joints) - 1 - self._coils
        self._cells = (1 << cells) - 1
        self._at = 0
        self._op = program.HALT
        self._depth = 0
        self._guards = 0
        self._aims = 0  # mask of the places that hold a coil from here on: code only jumps back

    def go_on(self, ops: int) -> bool:
        """Look at that many more ops; return whether all has been seen."""
        for _ in range(ops):
            if self._at == len(self._code):
                break
            self._one()
        if self._at < len(self._code):
            return False
        if self._op != program.HALT or self._depth or self._guards > program.GUARDS_MAX:
            raise program.BadProgram(
                f"needs a halt at its end, closed loops and at most {program.GUARDS_MAX} guards", self._at
            )
        return True

    def _one(self) -> None:
        op, at = self._code[self._at], self._at
        if op >= len(program.SIZES) or at + program.SIZES[op] > len(self._code):
            raise program.BadProgram(f"op {op} unknown or cut short", at)
        self._depth += (op == program.REPEAT) - (op == program.NEXT)
        self._guards += op == program.GUARD
        if self._depth < 0 or self._depth > program.DEPTH_MAX:
            raise program.BadProgram(f"loops nested {self._depth} deep, at most {program.DEPTH_MAX}", at)
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
        elif op in (program.WAIT, program.GUARD):
            self._condition(program.read_condition(self._code, at + 1), at)
        self._op = op
        self._at += program.SIZES[op]

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
        elif not (program.TEMPERATURE <= source <= program.PRESSURE and quantifier <= program.ALL):
            raise program.BadProgram("a condition this robot does not know", at)
        elif source in program.OF_COILS:
            _check_mask(condition.mask, self._coils, at)
        elif source in program.OF_JOINTS:
            _check_mask(condition.mask, self._joints, at)
        elif source in program.OF_CELLS:
            _check_mask(condition.mask, self._cells, at)
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
    if op == program.REPEAT and program.number(code, at + 1, 2) == 0:
        raise program.BadProgram("a loop of no turns", at)
    if op == program.PRESS and program.number(code, at + 3, 2) > program.number(code, at + 5, 4):
        raise program.BadProgram("a force that is to be reached after the end of its order", at)
    if op == program.WAIT and code[at + 13] not in (program.ABORT, program.CONTINUE):
        raise program.BadProgram(f"a wait that ends in {code[at + 13]}", at)
