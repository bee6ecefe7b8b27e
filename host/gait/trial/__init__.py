"""The worst case of a plan, played in the firmware's own arithmetic."""
