"""The program that a host uploads: taken in pieces, verified in pieces, so that no control step waits for it."""

from binascii import crc32

from firmware.channels import Refused
from protocol import codes, program
from protocol.verify import Check

OPS_PER_STEP = 32


class Upload:
    """One program on its way; `code` may run once `go_on` has said so."""

    def __init__(self, profile) -> None:
        self.code = bytearray(0)
        self.outlives_host = False  # it runs on when the lease runs out
        self.needs_attitude = self.needs_camera = self.needs_loop = False  # as the verification found
        self.needs_load = self.needs_press = False
        self.request = -1  # number of the start that waits for the verification, -1: none
        self._profile = profile
        self._header = None
        self._check = None

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
        self._check = None
        self.code = bytearray(0)  # else there would have to be room for both
        self.code = bytearray(read.length)

    def piece(self, offset: int, code: bytes) -> None:
        """Take a piece of the code."""
        end = offset + len(code)
        if self._header is None:
            raise Refused(codes.NO_PROGRAM)
        if end > len(self.code):
            raise Refused(codes.TOO_LARGE, 255, end, len(self.code))
        self.code[offset:end] = code

    def verify(self, request: int) -> None:
        """Begin the verification that a start asked for."""
        if self._header is None:
            raise Refused(codes.NO_PROGRAM)
        if crc32(self.code) != self._header.crc:
            raise Refused(codes.BAD_CODE, 255, len(self.code))
        try:
            profile = self._profile
            counts = len(profile.joints), len(profile.cells)
            self._check = Check(self.code, len(profile.coils), profile.program_bytes_max, *counts)
        except program.BadProgram as bad:
            raise Refused(codes.BAD_CODE, 255, bad.at) from None
        self.request = request

    def go_on(self) -> bool:
        """Verify some more; return whether the whole may run, or raise Refused."""
        try:
            done = self._check.go_on(OPS_PER_STEP)
        except program.BadProgram as bad:
            raise Refused(codes.BAD_CODE, 255, bad.at) from None
        self.needs_attitude = self._check.needs_attitude
        self.needs_camera = self._check.needs_camera
        self.needs_loop = self._check.needs_loop
        self.needs_load = self._check.needs_load
        self.needs_press = self._check.needs_press
        return done
