"""Ears on a bench: what goes over its line, what its coils get, what is done to it. Costs next to nothing until asked.

witness = Witness(bench)
bench.run(2)
witness.broken()        # sentences about the invariants that did not hold
"""

from zlib import crc32

from hil_sim.bench import Bench
from hil_sim.devices.canframe import Frame
from hil_sim.devices.mcp2515filters import choose
from hil_sim.journal import FAULT
from host.definitions import dictionary_of
from host.errors import SoftrigError
from host.limits import Joint
from host.profile import Profile, read_profile
from protocol.canbus import Assembler
from tests.invariants import Excuse, Run, broken, excuse_of, spells_of
from tests.orders import Ledger
from tests.pulses import Pulses
from tests.ways import Way

HEARD, TOLD, RESET = range(3)
FELT_N = 1.0  # what is less is taken down once


class Witness:
    """Notes what happens on one bench, from its first moment on."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.asked_us = -1  # bench's time of the last question
        self._line: list[tuple[int, int, bytes]] = []
        self._energy_j: list[tuple[int, list[float]]] = []
        self._excuses: list[tuple[int, Excuse]] = []
        self._forces: list[tuple[int, float]] = []
        self._at_line()
        self._at_can()
        self._pulses = {pin: Pulses(bench, pin) for pin in bench.board.servos}
        self._at_parts()
        self._at_load()

    def excuse(self, excuse: Excuse) -> None:
        """Ask less of the rest of the run."""
        self._excuses.append((self.bench.clock.now_us, excuse))

    def broken(self) -> list[str]:
        """Return a sentence for each invariant that did not hold so far; none for firmware that is not ours."""
        self.asked_us = self.bench.clock.now_us
        run = self.run()
        return [] if run is None else list(broken(run))

    def driven(self) -> list[list[tuple[int, float]]]:
        """Return of each coil and each servo from when on it was on (coils: the duty) or off."""
        return [coil.history for coil in self.bench.coils] + [each.history for each in self._pulses.values()]

    def run(self) -> Run | None:
        """Return the run so far, or None when the flash holds no robot of ours."""
        bench = self.bench
        text = profile_text(bench)
        profile = _profile(text)
        if profile is None:
            return None
        ledger = Ledger(profile, crc32(dictionary_of(text)))
        for time_us, kind, data in self._line:
            if kind == RESET:
                ledger.reset(time_us)
            elif kind == HEARD:
                ledger.heard(data, time_us)
            else:
                ledger.told(data, time_us)
        now_us = bench.clock.now_us
        pulses = [self._pulses[joint.pin] for joint in profile.channels if isinstance(joint, Joint)]
        driven = [coil.history for coil in bench.coils] + [each.history for each in pulses]
        spells = [spells_of(history, now_us) for history in driven]
        energies = [*self._energy_j, (now_us, bench._energy_j.tolist())]
        joints = zip(pulses, spells[len(bench.coils) :], strict=True)
        ways = [Way(each.positions(profile.servo), each.found, of) for each, of in joints]
        peaks = bench._peak_degc.tolist()
        return Run(profile, ledger, spells, peaks, energies, self._excuses, ways, self._forces)

    def _at_line(self) -> None:
        """Listen at the device's end of the line."""
        line, uart = self._line, self.bench.board.uart
        read, write, tune = uart.read, uart.write, uart.open

        def opens(baud: int, now_us: int, *buffers: int) -> None:
            line.append((now_us, HEARD, b"\x00"))  # no frame goes on over another rate
            tune(baud, now_us, *buffers)

        def reads(count: int, now_us: int) -> bytes:
            data = read(count, now_us)
            if data:
                line.append((now_us, HEARD, data))
            return data

        def writes(data: bytes, now_us: int) -> int:
            count = write(data, now_us)
            line.append((now_us, TOLD, data[:count]))
            return count

        uart.read, uart.write, uart.open = reads, writes, opens

    def _at_can(self) -> None:
        """Listen at the device's end of the CAN bus: what its controller lets pass, and what it sends."""
        line, clock, chip = self._line, self.bench.clock, self.bench.board.can.can
        passed, inward, outward = chip._passed, Assembler(False), Assembler(True)

        def passes(frame: Frame, sent: bool) -> None:
            passed(frame, sent)
            if sent or choose(chip.registers, frame, (False, False)):
                assembler = outward if sent else inward
                body = assembler.feed(frame.id, frame.extended, frame.data, clock.now_us // 1000)
                if body:
                    line.append((clock.now_us, TOLD if sent else HEARD, body.line))

        chip._passed = passes

    def _at_parts(self) -> None:
        """Listen at reset, gates and the journal's faults."""
        bench, board, line, energy_j = self.bench, self.bench.board, self._line, self._energy_j
        changed, reset, note = board.changed, board.reset_processor, bench.journal.note

        def changes() -> None:
            changed()
            energy_j.append((bench.clock.now_us, bench._energy_j.tolist()))

        def resets(cause: int) -> None:
            line.append((bench.clock.now_us, RESET, b""))
            reset(cause)

        def notes(time_us: int, kind: int, which: int, data: bytes) -> None:
            note(time_us, kind, which, data)
            if kind == FAULT:
                self._excuses.append((time_us, excuse_of(data.decode("latin-1"))))

        board.changed, board.reset_processor, bench.journal.note = changes, resets, notes

    def _at_load(self) -> None:
        """Feel what a load cell would, whenever the body has moved on."""
        bench, plant, forces = self.bench, self.bench.plant, self._forces
        if not hasattr(plant, "load_n"):
            return
        advance = plant.advance

        def advances(duration_us: int, coil_power_w: object) -> None:
            advance(duration_us, coil_power_w)
            force = float(plant.load_n)
            if abs(force) > FELT_N or (forces and abs(forces[-1][1]) > FELT_N):
                forces.append((bench.clock.now_us, force))

        plant.advance = advances


def profile_text(bench: Bench) -> bytes:
    """Return the robot's profile as it stands on the flash, nothing where there is none."""
    flash = bench.board.flash
    return next((flash.read(path) for path in flash.paths() if path.endswith("robot.json")), b"")


def _profile(text: bytes) -> Profile | None:
    try:
        return read_profile(text)
    except (SoftrigError, ValueError):
        return None
