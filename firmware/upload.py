"""The program that a host uploads: taken in pieces, verified in pieces, so that no control step waits for it.

A streamed program comes while it runs. Its code lies in a buffer of the size of the largest program; what the sequencer
has passed is dropped when a piece finds no room.
"""

from array import array
from binascii import crc32

from firmware.channels import Refused
from protocol import codes, program
from protocol.verify import Check

OPS_PER_STEP = 32
MOVED_AT_ONCE = 64  # bytes


class Upload:
    """One program on its way; the first `checked` bytes of `code` may run once `go_on` has said so."""

    def __init__(self, profile) -> None:
        self.code = bytearray(0)
        self.outlives_host = False  # it runs on when the lease runs out
        self.streamed = False
        self.needs_attitude = self.needs_camera = self.needs_loop = False  # as the verification found
        self.needs_load = self.needs_press = False
        self.waits = False  # there may be something to verify
        self.request = -1  # number of the start that waits for the verification, -1: none
        self._profile = profile
        self._header = None
        self._check = None
        self._gone = 0  # bytes of a stream that were dropped

    @property
    def checked(self) -> int:
        """Return how much of the code has been verified."""
        return self._check.at

    @property
    def labels(self) -> array:
        """Return where in the code its labels stand."""
        return self._check.labels

    @property
    def fault_at(self) -> int:
        """Return where in the code stands what runs after an abort, below 0: nowhere; of a stream 0: it may come."""
        if self.streamed:
            return 0 if self._header.flags & program.CATCHES else -1
        return self._check.fault_at

    def begin(self, header: bytes) -> None:
        """Make room for a program, or raise Refused when it is not for this robot."""
        try:
            read = program.read_header(header)
        except program.BadProgram:
            raise Refused(codes.BAD_HEADER) from None
        if read.robot_crc != self._profile.crc:
            raise Refused(codes.OTHER_ROBOT)
        if read.length > self._profile.program_bytes_max:
            raise Refused(codes.TOO_LARGE, 255, read.length, self._profile.program_bytes_max)
        self._header = read
        self.outlives_host = read.flags & program.OUTLIVES_HOST != 0
        self.streamed = read.flags & program.STREAMED != 0
        self._check = None
        self._gone = 0
        self.code = bytearray(0)  # else there would have to be room for both
        self.code = bytearray(self._profile.program_bytes_max if self.streamed else read.length)
        if self.streamed:
            self._check = self._new_check()

    def piece(self, offset: int, code: bytes, player=None) -> None:
        """Take a piece of the code; of a stream the next one, while `player` runs what came before."""
        if self._header is None:
            raise Refused(codes.NO_PROGRAM)
        if self.streamed:
            self._append(offset, code, player)
            return
        end = offset + len(code)
        if end > len(self.code):
            raise Refused(codes.TOO_LARGE, 255, end, len(self.code))
        self.code[offset:end] = code

    def verify(self, request: int) -> None:
        """Begin the verification that a start asked for."""
        if self._header is None or (self.streamed and (self._gone or self._check.end == 0)):
            raise Refused(codes.NO_PROGRAM)
        if not self.streamed:
            if crc32(self.code) != self._header.crc:
                raise Refused(codes.BAD_CODE, 255, len(self.code))
            self._check = self._new_check()
        self.request = request
        self.waits = True

    def go_on(self) -> bool:
        """Verify some more; return whether all that is there may run, or raise Refused."""
        try:
            done = self._check.go_on(OPS_PER_STEP)
        except program.BadProgram as bad:
            raise Refused(codes.BAD_CODE, 255, self._gone + bad.at) from None
        self.needs_attitude = self._check.needs_attitude
        self.needs_camera = self._check.needs_camera
        self.needs_loop = self._check.needs_loop
        self.needs_load = self._check.needs_load
        self.needs_press = self._check.needs_press
        return done

    def _new_check(self) -> Check:
        profile = self._profile
        counts = len(profile.joints), len(profile.cells)
        try:
            return Check(self.code, len(profile.coils), profile.program_bytes_max, *counts, self.streamed)
        except program.BadProgram as bad:
            raise Refused(codes.BAD_CODE, 255, bad.at) from None

    def _append(self, offset: int, code: bytes, player) -> None:
        check = self._check
        if offset != (self._gone + check.end) & 0xFFFF:
            raise Refused(codes.BAD_CODE, 255, offset, (self._gone + check.end) & 0xFFFF)
        if player and check.end + len(code) > len(self.code):
            self._drop(min(player.at, check.at), player)
        room = len(self.code) - check.end
        if len(code) > room:
            raise Refused(codes.TOO_LARGE, 255, len(code), room)
        self.code[check.end : check.end + len(code)] = code
        check.end += len(code)
        self.waits = True

    def _drop(self, count: int, player) -> None:
        """Move the code to the front, over what the sequencer has passed, a little at a time for want of memory."""
        for at in range(count, self._check.end, MOVED_AT_ONCE):
            piece = self.code[at : min(at + MOVED_AT_ONCE, self._check.end)]
            self.code[at - count : at - count + len(piece)] = piece
        self._check.at -= count
        self._check.end -= count
        self._gone += count
        player.shift(count)
