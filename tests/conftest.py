"""Fixtures of all tests."""

import pytest
from hypothesis import settings

from hil_sim.physics import circuit, coil
from hil_sim.physics.compiled import prepare
from tests.hil_rig import HilRig

settings.register_profile("softrig", derandomize=True, deadline=None)  # the same examples on every machine
settings.load_profile("softrig")


@pytest.fixture(scope="session", autouse=True)
def fresh_kernels():
    """Machine code of older sources is dropped before any test calls a kernel by itself."""
    prepare(coil.advance)
    prepare(circuit.solve)


@pytest.fixture
def rig():
    """A circular robot on the bench, connected and idle."""
    rig = HilRig()
    yield rig
    rig.link.close()
