"""Pure physics in SI units and the symbols of its sources; knows nothing of chips or robots."""


def warm() -> None:
    """Compile the kernels and leave them on disk, so that the first bench starts at once."""
    import numpy as np  # noqa: PLC0415  (heavy)

    from hil_sim.physics.circuit import circuit_of, mean_current, mean_voltage, solve  # noqa: PLC0415
    from hil_sim.plant import RingPlant  # noqa: PLC0415
    from hil_sim.robotfile import load  # noqa: PLC0415

    plant = RingPlant(load("circular"))
    off = np.zeros(len(plant.labels))
    plant.advance(5000, off)
    plant.observe()
    plant.energies()
    circuit = circuit_of(off, 0.0, 0.0)
    solve(circuit, off, off, plant.resistance, off)
    mean_current(circuit, 0.0, 1.0)
    mean_voltage(circuit, 0.0, 1.0)
