"""A bench of simulated chips, wires, coils and bodies on which the firmware runs unchanged."""
