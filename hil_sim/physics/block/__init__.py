"""A block of rheological material, deformed and stressed under what presses it: 2-D finite elements."""
