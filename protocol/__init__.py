"""The wire format that the robot and its host share: bytes, frames, messages, link, programs and codes.

Everything here runs unchanged under MicroPython, opens no port and reads no clock.
"""
