"""The program of the robot's core microprocessor, in the subset of Python that MicroPython runs."""
