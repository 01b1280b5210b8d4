"""Two chains of masses and springs, glued: exactly one long chain, when both make equal steps."""

import laboratory
import numpy as np
import pytest
from toy_chains import chain_force, chain_masses, hump

WINDOW, LAYERS = 0.2, 20
CENTRED = [[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.8]]
LOPSIDED = [[0.1, 0.3], [0.9, 0.2], [0.7, 0.7]]


def _run(folder, end, ratio=1, scheme="serial", places=CENTRED):
    components = {
        "column": {"kind": "toy_chains:Column", "dt": WINDOW, "height": 0.1, "layers": LAYERS},
        "rods": {"kind": "toy_chains:Rods", "dt": WINDOW / ratio, "places": places},
    }
    link = {"kind": "glue", "name": "glue", "between": ["column", "rods"]}
    path = laboratory.scene(folder, components, link, end=end, window=WINDOW, scheme=scheme)
    return laboratory.couple(path)


def _one_chain(steps):
    """One chain of both lengths, stepped by the same rule; displacements and velocities."""
    mass = chain_masses(2 * LAYERS - 1, 1.0)[None]
    u, v = np.zeros_like(mass), np.zeros_like(mass)
    u[0, :LAYERS] = hump(LAYERS, 0.1)
    for _ in range(steps):
        v = v + WINDOW * chain_force(u, 1.0) / mass
        u = u + WINDOW * v
    return u[0], v[0]


def test_glued_chains_are_one_chain(tmp_path):
    """The wave passes: after 25 s half the hump has crossed the glue without an echo."""
    trace = _run(tmp_path, 25.0)
    column, rods = trace.components["column"], trace.components["rods"]
    u, v = _one_chain(125)
    for row in range(4):
        np.testing.assert_allclose(column.u[row], u[:LAYERS], atol=1e-14)
        np.testing.assert_allclose(rods.u[row], u[LAYERS - 1 :], atol=1e-14)
        np.testing.assert_allclose(rods.v[row], v[LAYERS - 1 :], atol=1e-14)
    assert np.abs(rods.u).max() > 0.03


@pytest.mark.parametrize("places", [CENTRED, LOPSIDED])
@pytest.mark.parametrize("ratio", [1, 7, 50])
@pytest.mark.parametrize("scheme", ["serial", "parallel"])
def test_glue_conserves_momentum(tmp_path, scheme, ratio, places):
    trace = _run(tmp_path, 12.0, ratio, scheme, places)
    assert trace.account.momentum_residual <= 1e-12
    assert trace.account.kinematic_residual <= 1e-12
    # In transit is the last window's impulse, but for the force of which the rods, too, will
    # feel the reaction in their next step only.
    late = laboratory.in_transit(trace, "rods", "glued_load.force")
    force = trace.components["rods"].give()["glued_load.force"].sum(axis=0)
    rest = trace.momentum() + late - WINDOW / ratio * force
    if scheme == "serial":
        np.testing.assert_allclose(rest, 0.0, atol=1e-13)


def test_glued_masses_hang_on_their_nodes(tmp_path):
    trace = _run(tmp_path, 1.0, places=LOPSIDED)
    column = trace.components["column"]
    from toy_chains import Column

    free = Column(Column.Params(layers=LAYERS)).mass
    assert (column.mass - free)[:, -1].sum() == pytest.approx(3 * 0.5, rel=1e-14)
    np.testing.assert_array_equal((column.mass - free)[:, :-1], 0.0)


def test_energy_of_glued_chains_stays(tmp_path):
    """Thirty transits: what leapfrog's energy oscillates by, and no more."""
    energies = np.array(_run(tmp_path, 1200.0).energies)
    whole = energies[0]
    assert np.abs(energies - whole).max() < 0.06 * whole
    late, early = energies[-500:].mean(), energies[:500].mean()
    assert abs(late - early) < 5e-3 * whole
