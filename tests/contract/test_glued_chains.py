"""Two chains of masses and springs, glued: exactly one long chain, when both make equal steps."""

import laboratory
import numpy as np
import pytest
from toy_chains import chain_force, chain_masses, hump

from quintet.interfaces.component import outputs_of
from quintet.interfaces.errors import SceneError

WINDOW, LAYERS = 0.2, 20
CENTRED = [[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.8]]
LOPSIDED = [[0.1, 0.3], [0.9, 0.2], [0.7, 0.7]]


TRANSIT = 38.0  # s, of a wave through both chains


def _scene(folder, end, rods=None, order=("column", "rods"), places=CENTRED, **settings):
    components = {
        "column": {"kind": "toy_chains:Column", "dt": WINDOW, "height": 0.1, "layers": LAYERS},
        "rods": {"kind": "toy_chains:Rods", "dt": WINDOW, "places": places, **(rods or {})},
    }
    link = {"kind": "glue", "name": "glue", "between": ["column", "rods"]}
    settings = {"window": WINDOW, "order": list(order), **settings}
    return laboratory.scene(folder, components, link, end=end, **settings)


def _run(folder, end, **settings):
    return laboratory.couple(_scene(folder, end, **settings))


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
        np.testing.assert_allclose(column.u[row], u[:LAYERS], atol=1e-13)
        np.testing.assert_allclose(rods.u[row], u[LAYERS - 1 :], atol=1e-13)
        np.testing.assert_allclose(rods.v[row], v[LAYERS - 1 :], atol=1e-13)
    assert np.abs(rods.u).max() > 0.03


@pytest.mark.parametrize("places", [CENTRED, LOPSIDED])
@pytest.mark.parametrize("order", [("column", "rods"), ("rods", "column")])
def test_glue_conserves_momentum(tmp_path, order, places):
    trace = _run(tmp_path, 12.0, order=order, places=places)
    assert trace.account.momentum_residual <= 1e-12
    assert trace.account.kinematic_residual <= 1e-12
    if order[0] == "rods":
        return
    # In transit is the last window's impulse, but for the force of which the rods, too, will
    # feel the reaction in their next step only.
    in_transit = laboratory.in_transit(trace, "rods", "glued_load.force")
    force = outputs_of(trace.components["rods"])["glued_load.force"].sum(axis=0)
    momentum = trace.momentum() + in_transit - WINDOW * force
    np.testing.assert_allclose(momentum, 0.0, atol=1e-13)


def test_glued_masses_hang_on_their_nodes(tmp_path):
    trace = _run(tmp_path, 1.0, places=LOPSIDED)
    column = trace.components["column"]
    from toy_chains import Column

    free_mass = Column(Column.Params(layers=LAYERS)).mass
    assert (column.mass - free_mass)[:, -1].sum() == pytest.approx(3 * 0.5, rel=1e-14)
    np.testing.assert_array_equal((column.mass - free_mass)[:, :-1], 0.0)


def _gain(trace):
    """Energy over the last transit of a wave over that in the first, both means over time."""
    times, energies = trace.times, np.array(trace.energies)
    late, early = times > times[-1] - TRANSIT, times < TRANSIT
    spans = np.diff(times, append=times[-1])
    return np.average(energies[late], weights=spans[late] + 1e-9) / np.average(
        energies[early], weights=spans[early]
    )


@pytest.mark.parametrize(
    "order",
    [("column", "rods"), pytest.param(("rods", "column"), marks=pytest.mark.full)],
)
def test_energy_of_glued_chains_stays_over_thirty_transits(tmp_path, order):
    trace = _run(tmp_path, 30 * TRANSIT, order=order)
    assert abs(_gain(trace) - 1.0) < 0.01
    energies = np.array(trace.energies)
    assert np.abs(energies - energies[0]).max() < 0.06 * energies[0]  # leapfrog's energy swings


STIFFER = [[2.5 * TRANSIT, 0.125], [7.5 * TRANSIT, 1.0], [11 * TRANSIT, 0.3]]


CHANGES, HOVERS = {"stiffer": STIFFER}, {"hover": 0.08}


@pytest.mark.parametrize(
    ("rods", "window"),
    [
        pytest.param(CHANGES, "auto", id="changes-auto"),
        pytest.param(HOVERS, 0.9, id="hovers-0.9"),
        pytest.param(CHANGES, 0.9, id="changes-0.9", marks=pytest.mark.full),
        pytest.param(HOVERS, "auto", id="hovers-auto", marks=pytest.mark.full),
    ],
)
def test_windows_follow_the_state_and_energy_stays(tmp_path, rods, window):
    """Both sides make one equal step in every window, whatever the stable step does."""
    trace = _run(tmp_path, 15 * TRANSIT, rods=rods, window=window)
    assert abs(_gain(trace) - 1.0) < 0.03
    assert trace.times[-1] == 15 * TRANSIT
    windows = np.diff(trace.times)
    allowed = np.array([min(limits.values()) for limits in trace.stable])[:-1]
    assert (windows <= allowed * (1 + 1e-9)).all()
    steps = {name: component.timing.steps for name, component in trace.coupling.components.items()}
    assert steps == {"column": len(windows), "rods": len(windows)}
    growth = windows[1:] / windows[:-1]
    assert growth.max() <= 2.0 and (growth[:-3] > 1.0).sum() < 8
    if "stiffer" in rods:
        assert windows.min() < 0.13 * WINDOW and windows.max() > 0.8 * WINDOW


@pytest.mark.parametrize("scheme", ["parallel", "iterated"])
def test_glue_refuses_schemes_that_gain_or_lose_energy(tmp_path, scheme):
    with pytest.raises(
        SceneError, match=r"scene.scheme must be serial for link glue; .*without bo"
    ):
        _run(tmp_path, 1.0, scheme=scheme)


@pytest.mark.parametrize("ratio", [2, 4, 64])
def test_glue_refuses_ratios_that_gain_energy(tmp_path, ratio):
    path = _scene(tmp_path, 1.0)
    path.write_text(path.read_text().replace('kind = "glue"', f'kind = "glue"\nsubsteps = {ratio}'))
    pattern = r"links.0: substeps must be 1; found .*at a ratio of 2 it gains 28 % .* at 4 66 %"
    with pytest.raises(SceneError, match=pattern):
        laboratory.couple(path)
