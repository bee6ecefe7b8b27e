"""Worlds in which the firmware's files run on the bench's board."""
