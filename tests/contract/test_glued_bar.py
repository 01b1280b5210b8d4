"""Chains of masses glued to a bar of finite elements: one bar, as long as the faces hold."""

import laboratory
import numpy as np
import pytest
from toy_chains import chain_force, chain_masses, hump

from quintet.interfaces.errors import LinkError

LAYERS, ROWS = 20, 20  # nodes of the bar along x, masses of a rod
WINDOW, HEIGHT = 0.2, 1e-7  # s; m/s, so small that strain changes no geometry
TRANSIT = 38.0  # s
# 1 m by 1 m, with Poisson's ratio 0: a rod on each corner has 1 kg/m, and 1 N per metre of strain.
MATERIAL = {"density": 4.0, "youngs_modulus": 4.0, "poissons_ratio": 0.0}


def _bar(**keys):
    part = {
        "lowest": [0.0, 0.0, 0.0],
        "highest": [LAYERS - 1.0, 1.0, 1.0],
        "elements": [LAYERS - 1, 1, 1],
        "material": MATERIAL | keys.pop("material", {}),
        "velocity": keys.pop("velocity", [0.0, 0.0, 0.0]),
    }
    end = {"lowest": [LAYERS - 1.0, 0.0, 0.0], "highest": [LAYERS - 1.0, 1.0, 1.0]}
    defaults = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0, "coupled_faces": [end]}
    return {"kind": "toy_bars:Bar", "parts": [part], "courant": 1.0, **defaults, **keys}


def _run(folder, end, bar, rods=None, order=("bar", "rods"), **settings):
    components = {
        "bar": _bar(**bar),
        "rods": {"kind": "toy_bars:LooseRods", "count": ROWS, "dt": WINDOW, **(rods or {})},
    }
    link = {"kind": "glue", "name": "glue", "between": ["bar", "rods"]}
    settings = {"window": WINDOW, "order": list(order), **settings}
    return laboratory.couple(laboratory.scene(folder, components, link, end=end, **settings))


def _one_chain(windows):
    """Velocities of one chain of both lengths at the middles of its steps."""
    mass = chain_masses(LAYERS + ROWS - 1, 1.0)[None]
    u, v = np.zeros_like(mass), np.zeros_like(mass)
    v[0, :LAYERS] = hump(LAYERS, HEIGHT)
    for dt in windows:
        v = v + dt * chain_force(u, 1.0) / mass
        u = u + dt * v
    return v[0]


@pytest.mark.parametrize("order", [("bar", "rods"), ("rods", "bar")])
def test_a_wave_passes_from_elements_to_what_is_glued_to_them_without_an_echo(tmp_path, order):
    trace = _run(tmp_path, 25.0, {"height": HEIGHT}, order=order)
    bar, rods = trace.components["bar"], trace.components["rods"]
    steps = np.diff(trace.times)
    # Where the bar steps first, its first step knows the same forces as those of one chain.
    late = 0 if order[0] == "bar" else 1
    v = _one_chain(steps)
    place = np.rint(bar.mesh.node[:, 0]).astype(int)
    np.testing.assert_allclose(bar.state.mean_velocity[:, 0], v[place], atol=1e-3 * HEIGHT)
    v = _one_chain(steps[: len(steps) - late])
    for row in range(4):
        np.testing.assert_allclose(rods.v[row], v[LAYERS - 1 :], atol=1e-3 * HEIGHT)
    assert np.abs(rods.v).max() > 0.3 * HEIGHT


def test_energy_of_a_glued_bar_stays_over_thirty_transits(tmp_path):
    trace = _run(tmp_path, 30 * TRANSIT, {"height": HEIGHT})
    energies = np.array(trace.energies)
    spans = len(energies) // 30
    # Rods know their velocities half a step before the bar does, so that means vary by some 0.5 %.
    assert abs(energies[-spans:].mean() / energies[:spans].mean() - 1.0) < 0.01
    assert np.abs(energies / energies[0] - 1.0).max() < 0.05  # leapfrog's energy swings


def _momentum(trace):
    """Momentum along x at the middle of the last step, in which both sides know each other."""
    bar, rods = trace.components["bar"], trace.components["rods"]
    return float(bar.built.mass @ bar.state.mean_velocity[:, 0] + (rods.mass * rods.v).sum())


TORN = {"material": {"spall_stress": 0.05}, "velocity": [-0.1, 0.0, 0.0]}


@pytest.mark.parametrize("end", [0.2, 1.0, 1.2, 4.0, 8.0])
def test_where_a_face_erodes_its_particles_are_freed_and_momentum_stays(tmp_path, end):
    trace = _run(tmp_path, end, TORN)
    bar, rods = trace.components["bar"], trace.components["rods"]
    start = -0.1 * (bar.built.mass.sum() + 4 * 0.5)  # what is glued moves with its nodes
    assert _momentum(trace) == pytest.approx(start, rel=1e-12)
    # Totals close at the end of every window: when an element erodes, a window later, when its
    # particles are freed and its nodes release them, and afterwards.
    totals = [component.totals() for component in (bar, rods)]
    assert sum(total.mass for total in totals) == pytest.approx(
        bar.built.mass.sum() + rods.mass.sum()
    )
    assert sum(total.momentum[0] for total in totals) == pytest.approx(start, rel=1e-12)
    assert (bar.places.active(bar.state).min() == 0.0) == (end > 0.9)
    is_torn = end > 1.1
    assert bool(rods.held.all()) is not is_torn
    # Glued particles add their mass to the nodes until they are freed.
    added_mass = 1.0 / bar.model.inverse_mass - bar.built.mass
    assert added_mass.sum() == pytest.approx(0.0 if is_torn else 4 * 0.5, abs=1e-12)
    assert trace.account.momentum_residual <= 1e-12
    assert trace.account.other_residual <= 1e-12


def test_what_hangs_on_nodes_is_part_of_their_saved_state(tmp_path):
    torn, intact = (_run(tmp_path, end, TORN).components["bar"] for end in (4.0, 0.2))
    state = torn.save()
    intact.load(state)
    np.testing.assert_array_equal(intact.model.inverse_mass, torn.model.inverse_mass)


@pytest.mark.parametrize(
    ("places", "pattern"),
    [
        ([[0.5, 0.5], [1.3, 0.5]], r"particle 1 of rods, at \[19\. +1\.3 +0\.5\] m, is 0\.3 m be"),
        ([[0.2, -0.4]], r"particle 0 of rods.* 0\.4 m beside the nearest one, face 0 of 1 m\. Let"),
    ],
)
def test_a_particle_beside_all_faces_is_refused(tmp_path, places, pattern):
    with pytest.raises(LinkError, match=pattern):
        _run(tmp_path, 1.0, {}, {"places": places})


def test_a_particle_too_far_above_its_face_is_refused(tmp_path):
    bar = {"coupled_faces": [{"lowest": [0.0, 0.0, 0.0], "highest": [0.0, 1.0, 1.0]}]}
    with pytest.raises(LinkError, match=r"particle 0 of rods.* is 19 m from .*or raise reach"):
        _run(tmp_path, 1.0, bar)
