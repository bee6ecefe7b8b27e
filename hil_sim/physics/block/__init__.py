"""Stress and strain of a rheological block of two dimensions, and a rigid shape that is pressed on it."""
