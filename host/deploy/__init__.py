"""Puts the firmware on a board: into the slot that does not run, proved by hashes, kept only once it is healthy."""
