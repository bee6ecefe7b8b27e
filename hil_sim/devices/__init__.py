"""Chips and wires as byte-level models: what a driver would see on the bench table, fault for fault."""
