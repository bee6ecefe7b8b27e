"""What a press tells of the material that it pressed: its moduli and viscosities, from the force over time."""
