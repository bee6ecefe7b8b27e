"""The sequencer: runs an uploaded program, one bounded piece of it in each control step.

Times are counted from the program's own cursor, not from the step that happens to serve them, so that a long script
does not drift. Conditions are evaluated here, on every step; nothing waits for the host.
"""

from array import array

from firmware.resistance import UNKNOWN
from protocol import program

OPS_PER_STEP = 32
NOWHERE = -1
GONE = 0xFFFF  # where no op stands: what a stream has passed does not come back
BY_RESISTANCE = (program.RESISTANCE, program.MARTENSITE)
WAIT = program.GUARDS_MAX  # where the condition of the wait is kept, behind those of the guards
RUNNING, FINISHED, TIMED_OUT, GUARDED, LOST = 0, 1, 2, 3, 4  # LOST: it asked where down is, and nobody knows
UNSEEN = 5  # it asked how the object lies, and no camera sees it
STARVED = 6  # the next op of a streamed program was due and is not there


class Player:
    """One program and where it stands."""

    def __init__(self, channels, sense, attitude, limbs=None, resistance=None) -> None:
        self.step = 0  # number the program gave the step that runs, 0: none yet
        self.code = b""
        self.end = 0  # how much of the code is there and may run
        self.at = 0
        self.gone = 0  # bytes of a streamed code that were dropped before it
        self.failed = 0  # code of what has aborted the program that now runs its way after an abort
        self.paused = False
        self.news = False  # that the reports have to look at: a note, a pause or its end
        self.noted = array("H", [0] * OPS_PER_STEP)  # steps of the notes that were passed, for the reports
        self.notes = 0
        self.outcome = FINISHED
        self._channels = channels
        self._sense = sense
        self._attitude = attitude
        self._limbs = limbs
        self._resistance = resistance
        self._blind = False
        self._unseen = False
        self._now_ms = 0
        self._labels = array("H", [0] * program.LABELS_MAX)
        self._fault_at = -1
        self._streamed = False
        self._skips_to = NOWHERE  # label that a streamed program is on its way to
        self._steps_left = 0  # marks of steps until the pause that was asked for, 0: none was
        self._paused_ms = 0
        self._began_ms = 0
        self._cursor_ms = 0
        self._wait_until_ms = 0
        self._waiting = False
        self._depth = 0
        self._loop_at = array("H", [0] * program.DEPTH_MAX)
        self._loop_left = array("H", [0] * program.DEPTH_MAX)
        self._guards = array("H", [0] * program.GUARDS_MAX)  # where they stand in the code
        self._guard_count = 0
        self._sources = array("B", [0] * (WAIT + 1))  # of the conditions that are looked at on each step
        self._quantifiers = array("B", [0] * (WAIT + 1))
        self._compares = array("B", [0] * (WAIT + 1))
        self._values = array("i", [0] * (WAIT + 1))  # in the unit of the readings
        self._masks = array("i", [0] * (WAIT + 1))
        self._readings = [None] * (WAIT + 1)  # the coils' readings that it is about
        self._chosen = array("B", [0] * program.AIMS_MAX)
        self._acts = (
            self._halt, self._fire, self._fire, self._delay, self._repeat,
            self._next, self._wait, self._guard, self._name, self._off, self._aim, self._aimed,
            self._move, self._orient, self._press, self._label, self._note,
        )  # fmt: skip

    def load(self, upload, now_ms: int, paused: bool = False) -> None:
        """Stand at the beginning of a program that was checked."""
        self.code, self.end = upload.code, upload.checked
        self._labels, self._fault_at, self._streamed = upload.labels, upload.fault_at, upload.streamed
        self.step = self.at = self.gone = self.failed = self.notes = 0
        self.outcome = RUNNING
        self._cursor_ms = self._began_ms = self._paused_ms = now_ms
        self._waiting = False
        self._skips_to = NOWHERE
        self._depth = self._guard_count = self._steps_left = 0
        self.paused = self.news = paused

    def leave(self) -> None:
        """Stand in no step of any program."""
        self.step = 0
        self.news = self.news or self.paused
        self.paused = False
        self.code = b""  # else there would be no room for the next one

    def shift(self, count: int) -> None:
        """Follow the code of a stream, whose first bytes were dropped."""
        self.at -= count
        self.end -= count
        self.gone += count
        for i in range(self._guard_count):
            self._guards[i] = GONE

    def pause(self, now_ms: int) -> None:
        """Let the program's clock stand still."""
        if not self.paused:
            self.paused = self.news = True
            self._paused_ms = now_ms
        self._steps_left = 0

    def resume(self, now_ms: int, one_step: bool = False) -> None:
        """Go on where the program's clock stands, for good or up to the next mark of a step."""
        if self.paused:
            late_ms = now_ms - self._paused_ms
            self._cursor_ms += late_ms
            self._wait_until_ms += late_ms
            self._began_ms += late_ms
            self.paused = False
            self.news = True
        is_due = self.at < self.end and now_ms - self._cursor_ms >= 0
        stands_at_mark = self.step == 0 or (is_due and self.code[self.at] == program.STEP)
        self._steps_left = 0 if not one_step else 2 if stands_at_mark else 1

    def catch(self, code: int, now_ms: int) -> bool:
        """Go on with what the program does when it was aborted; return whether there is such a way."""
        if self._fault_at < 0 or self.failed:
            return False
        self.failed = code
        self.outcome = RUNNING
        if self.paused:  # its way begins when the pause ends
            self._began_ms += now_ms - self._paused_ms
            self._paused_ms = now_ms
        self._go_to(program.ON_FAULT, now_ms)
        return True

    def run(self, now_ms: int) -> int:
        """Go on as far as the time allows; return the outcome so far. Passes Refused on."""
        self._now_ms = now_ms
        self._blind = self._unseen = False
        outcome = GUARDED if self._guarded() else RUNNING if self.paused else self._run_ops(now_ms)
        if outcome != GUARDED:
            outcome = LOST if self._blind else UNSEEN if self._unseen else outcome
        self.outcome = outcome
        return outcome

    def _run_ops(self, now_ms: int) -> int:
        for _ in range(OPS_PER_STEP):
            if now_ms - self._cursor_ms < 0:
                return RUNNING
            if self._streamed:
                if self.at == self.end:
                    return STARVED if self._skips_to == NOWHERE else RUNNING
                if self._skips_to != NOWHERE:
                    self._skip(now_ms)
                    continue
            outcome = self._acts[self.code[self.at]](now_ms)
            if outcome >= 0:
                return outcome
        return RUNNING

    def _go_to(self, label: int, now_ms: int) -> None:
        """Go on at a label, which in a stream may still have to come."""
        self._cursor_ms = now_ms
        self._depth = 0
        self._waiting = False
        if self._streamed:
            self._skips_to = label
        else:
            self.at = self._fault_at if label == program.ON_FAULT else self._labels[label]

    def _skip(self, now_ms: int) -> None:
        """Pass an op on the way to a label."""
        if self.code[self.at] == program.LABEL and self.code[self.at + 1] == self._skips_to:
            self._skips_to = NOWHERE
            self._cursor_ms = now_ms
        self._go_on()

    def _halt(self, now_ms: int) -> int:
        busy = self._channels.busy(now_ms) or (self._limbs is not None and self._limbs.busy(now_ms))
        return RUNNING if busy else FINISHED

    def _fire(self, now_ms: int) -> int:
        code, at = self.code, self.at
        ramp_ms = program.number(code, at + 11, 2) if code[at] == program.RAMP else 0
        self._channels.fire(
            program.number(code, at + 1, 4),
            program.number(code, at + 5, 2),
            program.number(code, at + 7, 2),
            self._cursor_ms,
            program.number(code, at + 9, 2),
            ramp_ms,
        )
        return self._go_on()

    def _delay(self, now_ms: int) -> int:
        self._cursor_ms += program.number(self.code, self.at + 1, 4)
        return self._go_on()

    def _repeat(self, now_ms: int) -> int:
        self._loop_left[self._depth] = program.number(self.code, self.at + 1, 2)
        self._go_on()
        self._loop_at[self._depth] = self.at
        self._depth += 1
        return -1

    def _next(self, now_ms: int) -> int:
        loop = self._depth - 1
        self._loop_left[loop] -= 1
        if self._loop_left[loop]:
            self.at = self._loop_at[loop]
            return -1
        self._depth = loop
        return self._go_on()

    def _wait(self, now_ms: int) -> int:
        if not self._waiting:
            self._waiting = True
            self._wait_until_ms = self._cursor_ms + program.number(self.code, self.at + 9, 4)
            self._keep(WAIT, self.at + 1)
        met = self._holds(WAIT)
        if not met and now_ms - self._wait_until_ms < 0:
            return RUNNING
        otherwise = self.code[self.at + 13]
        if not met and otherwise == program.ABORT:
            return TIMED_OUT
        if not met and otherwise >= program.JUMP:
            self._go_to(otherwise - program.JUMP, now_ms)
            return -1
        self._waiting = False
        self._cursor_ms = now_ms
        return self._go_on()

    def _guard(self, now_ms: int) -> int:
        """Keep a guard, once: it may stand in a loop."""
        for i in range(self._guard_count):
            if self._guards[i] == self.at:
                return self._go_on()
        self._guards[self._guard_count] = self.at
        self._keep(self._guard_count, self.at + 1)
        self._guard_count += 1
        return self._go_on()

    def _name(self, now_ms: int) -> int:
        if self._steps_left:
            self._steps_left -= 1
            if not self._steps_left:
                self.pause(now_ms)
                return RUNNING
        self.step = program.number(self.code, self.at + 1, 2)
        return self._go_on()

    def _off(self, now_ms: int) -> int:
        self._channels.off(program.number(self.code, self.at + 1, 4), now_ms)
        return self._go_on()

    def _aim(self, now_ms: int) -> int:
        """Choose the coil that stands so many places after the one nearest to down in a circle."""
        if not self._attitude.known:
            return LOST
        code, circle = self.code, self.at + 3
        count = nearest = most = 0
        while count < program.CIRCLE_MAX and code[circle + count] != program.NO_COIL:
            nearness = self._attitude.nearness(code[circle + count])
            if count == 0 or nearness > most:
                most = nearness
                nearest = count
            count += 1
        self._chosen[code[self.at + 1]] = code[circle + (nearest + code[self.at + 2]) % count]
        return self._go_on()

    def _aimed(self, now_ms: int) -> int:
        code, at = self.code, self.at
        self._channels.fire(
            1 << self._chosen[code[at + 1]],
            program.number(code, at + 2, 2),
            program.number(code, at + 4, 2),
            self._cursor_ms,
            program.number(code, at + 6, 2),
            program.number(code, at + 8, 2),
        )
        return self._go_on()

    def _move(self, now_ms: int) -> int:
        code, at = self.code, self.at
        mask, over_ms = program.number(code, at + 1, 4), program.number(code, at + 7, 2)
        self._limbs.play_move(mask, program.signed(code, at + 5), over_ms, self._cursor_ms)
        return self._go_on()

    def _orient(self, now_ms: int) -> int:
        if not self._limbs.sees():
            return UNSEEN
        code, at = self.code, self.at
        self._limbs.play_turn(program.signed(code, at + 1), program.number(code, at + 3, 2), self._cursor_ms)
        return self._go_on()

    def _press(self, now_ms: int) -> int:
        code, at = self.code, self.at
        target_mn, over_ms = program.number(code, at + 1, 2), program.number(code, at + 3, 2)
        self._limbs.play_push(target_mn, over_ms, program.number(code, at + 5, 4), self._cursor_ms)
        return self._go_on()

    def _label(self, now_ms: int) -> int:
        return self._go_on()

    def _note(self, now_ms: int) -> int:
        if self.notes < OPS_PER_STEP:  # as many as a control step passes
            self.noted[self.notes] = program.number(self.code, self.at + 1, 2)
            self.notes += 1
            self.news = True
        return self._go_on()

    def _go_on(self) -> int:
        self.at += program.SIZES[self.code[self.at]]
        return -1

    def _guarded(self) -> bool:
        for i in range(self._guard_count):
            if self._holds(i):
                return True
        return False

    def _keep(self, place: int, at: int) -> None:
        """Keep the condition that stands at `at`, taken apart once for all the steps that look at it."""
        code, source = self.code, self.code[at]
        value = program.number(code, at + 2, 2)
        value = value - 0x10000 if value & 0x8000 else value
        self._sources[place] = source
        self._quantifiers[place] = code[at + 1] & 15
        self._compares[place] = code[at + 1] >> 4
        of_many = source in program.OF_COILS or source in program.OF_JOINTS or source in program.OF_CELLS
        self._masks[place] = program.number(code, at + 4, 4) if of_many or source == program.TIME else 0
        self._values[place] = value
        self._readings[place] = None
        if source == program.TEMPERATURE:
            self._keep_readings(place, self._sense.temperature_millidegc, 100)
        elif source == program.HEAT:
            self._keep_readings(place, self._sense.heat_uj, 1000)
        elif source in program.OF_JOINTS:
            joints = self._limbs.joints
            self._masks[place] >>= joints.first
            self._readings[place] = joints.measured_centi if source == program.POSITION else joints.current_ma
        elif source in program.OF_CELLS:
            self._readings[place] = self._limbs.cells.pressure_pa

    def _keep_readings(self, place: int, readings: array, unit: int) -> None:
        """Have a condition look at these; what is a fraction of a unit above its value does not count."""
        fraction = unit - 1 if self._compares[place] == program.ABOVE else 0
        self._readings[place] = readings
        self._values[place] = self._values[place] * unit + fraction

    def _holds(self, place: int) -> bool:
        """Evaluate the condition that is kept there."""
        readings, value = self._readings[place], self._values[place]
        above = self._compares[place] == program.ABOVE
        mask, quantifier = self._masks[place], self._quantifiers[place]
        if quantifier == program.CHOSEN:
            mask = 1 << self._chosen[mask]
        if readings is None:
            source = self._sources[place]
            if source in BY_RESISTANCE:
                return self._holds_by_resistance(source, quantifier, mask, value, above)
            return self._holds_for_robot(source, mask, value, above)
        want_all = quantifier == program.ALL
        channel = 0
        while mask:
            if mask & 1:
                reading = readings[channel]
                holds = reading > value if above else reading < value
                if holds != want_all:
                    return holds
            mask >>= 1
            channel += 1
        return want_all

    def _holds_by_resistance(self, source: int, quantifier: int, mask: int, value: int, above: bool) -> bool:
        """Evaluate a condition on what the resistance tells; where it was not measured yet, it does not hold."""
        resistance, want_all = self._resistance, quantifier == program.ALL
        channel = 0
        while mask:
            if mask & 1:
                if source == program.RESISTANCE:
                    reading = resistance.measured_mohm(channel) // 10
                    known = reading != 0
                else:
                    reading = resistance.martensite_permille(channel)
                    known = reading != UNKNOWN
                holds = known and (reading > value if above else reading < value)
                if holds != want_all:
                    return holds
            mask >>= 1
            channel += 1
        return want_all

    def _holds_for_robot(self, source: int, mask: int, value: int, above: bool) -> bool:
        if source == program.TIME:
            passed_ms = (self._paused_ms if self.paused else self._now_ms) - self._began_ms
            return passed_ms > mask if above else passed_ms < mask
        if source in program.OF_ATTITUDE and not self._attitude.known:
            self._blind = True
            return False
        if source == program.ORIENTATION and not self._limbs.camera.known:
            self._unseen = True
            return False
        if source == program.DOWN:
            return mask >> self._attitude.down_channel() & 1 == above  # IS is coded as ABOVE
        reading = self._reading(source)
        return reading > value if above else reading < value

    def _reading(self, source: int) -> int:
        if source == program.CURRENT:
            return self._sense.current_ma
        if source == program.VOLTAGE:
            return self._sense.supply_mv
        if source == program.ROLL:
            return self._attitude.roll_decideg()
        if source == program.PITCH:
            return self._attitude.pitch_decideg()
        if source == program.ORIENTATION:
            return self._limbs.camera.centideg
        if source == program.FORCE:
            return self._limbs.load.force_mn
        return self._sense.board_decidegc
