"""The circular robot's file."""

import pytest

from hil_sim.robots.file import load, names

BODY = load("circular")


def test_the_bench_knows_the_circular_robot():
    assert "circular" in names()
    assert BODY.labels == tuple("ABCDEFGH")


def test_its_sizes_are_in_si_units():
    found = [BODY.ring.R, BODY.ring.m, BODY.coil.G_A, BODY.coil.c_tau, BODY.coil.H, BODY.coil.rho_A]

    assert found == pytest.approx([0.020, 1.6e-3, 22e9, 6.9e6, 24.2e3, 0.88e-6])
