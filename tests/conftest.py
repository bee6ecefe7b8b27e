"""Fixtures of all tests."""

import pytest

from tests.hil_rig import HilRig


@pytest.fixture
def rig():
    """A circular robot on the bench, connected and idle."""
    rig = HilRig()
    yield rig
    rig.link.close()
