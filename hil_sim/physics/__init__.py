"""Pure physics in SI units and the symbols of its sources; knows nothing of chips or robots."""
