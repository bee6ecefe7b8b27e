"""The robot files, and how they are read and checked."""
