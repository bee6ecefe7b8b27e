"""The host side: library and command line that check scripts, send them, watch, record and report."""
