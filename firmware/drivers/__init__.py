"""Drivers of the chips on the board: bytes on a bus, nothing of the robot."""
