"""The CAN bus of a bench: its ports, its python-can plug-in, and the desk at which several robots share it."""
