"""Volumes about bodies with clouds, weights at faces of the box, coefficients across fringe."""

import numpy as np
import pytest
from test_moving_clouds import (
    RADIUS,
    about_an_axis,
    gas_of,
    in_a_stream,
    params_of,
    scene,
    two_bodies,
)

from quintet.interfaces.errors import SceneError, StepError


def test_coefficients_are_written_anew_only_where_clouds_have_moved(monkeypatch):
    gas = gas_of(scene(bodies=two_bodies(0.5), gas=[0.0, 0.0, 0.0]))
    motion, fringe, fitted_rows = gas.motion, gas.motion.fringe, []
    before, region = motion.domain.stencils.coefficients.copy(), motion.domain.cloud.region
    fit = fringe.fit
    monkeypatch.setattr(fringe, "fit", lambda rows: (fitted_rows.append(rows), fit(rows)))
    motion.place(1, 1e-3)
    near = region[motion.domain.stencils.neighbours[fitted_rows[0]]]
    assert 0 < len(fitted_rows[0]) < len(fringe.across)
    assert ((near == 2).any(axis=1) | (region[fitted_rows[0]] == 2)).all()
    fit(fringe.across)
    refitted = motion.domain.stencils.coefficients.copy()
    assert not np.array_equal(refitted, before)
    motion.domain.stencils.coefficients[:] = before
    fit(fitted_rows[0])
    assert np.array_equal(motion.domain.stencils.coefficients, refitted)
    fitted_rows.clear()
    motion.place(1, 1e-3)
    assert not fitted_rows


def volume_of_gas(settings, *bodies):
    """Volume of a box less that of bodies; of whole rings about an axis."""
    low, high = (np.array(settings["box"][key])[[0, 2]] for key in ("lowest", "highest"))
    if settings["moving"].get("axisymmetric"):
        return np.pi * high[1] ** 2 * (high[0] - low[0]) - sum(bodies)
    return np.prod(high - low) - sum(bodies)


def test_volumes_of_nodes_about_bodies_fill_the_box():
    disc, ball = np.pi * RADIUS**2, 4.0 / 3.0 * np.pi * RADIUS**3
    for settings, volume, steps in (
        (plane := scene(share=1.0), volume_of_gas(plane, disc), 12),
        (axis := about_an_axis(), volume_of_gas(axis, ball), 0),
        (cut := in_a_stream(sector=0.5 * np.pi), volume_of_gas(cut, 0.5 * ball), 0),
        (pair := scene(bodies=two_bodies(0.5)), volume_of_gas(pair, 0.25 * disc, 0.25 * disc), 0),
    ):
        gas = gas_of(settings)
        for _ in range(steps):
            gas.step(gas.stable_dt())
        assert gas.motion.domain.cloud.volumes.sum() == pytest.approx(volume, rel=2e-3)
        left_out = ~gas.motion.holes.active[: gas.motion.domain.cloud.nodes]
        assert not gas.motion.domain.cloud.volumes[: len(left_out)][left_out].any()


def beside_a_face(room):
    """A body whose cloud leaves room [m] to a face of a coarser box."""
    settings = scene(gas=[0.0, 0.0, 0.0])
    body = settings["moving"]["bodies"][0]
    rim = RADIUS + params_of(settings).moving.bodies[0].heights[-1]
    settings["box"] |= {"spacing": 0.25, "lowest": [-rim - room, 0.0, -2.5]}
    settings["box"]["highest"] = [2.6, 0.0, 2.5]
    body["velocity"] = [0.0, 0.0, 0.0]
    return settings


def test_weights_of_boundaries_are_of_the_neighbours_that_clouds_leave():
    gas = gas_of(beside_a_face(0.34))
    domain, edges, active = gas.motion.domain, gas.motion.domain.edges, gas.motion.holes.active
    home = gas.motion.layout.home[edges]
    moved = (domain.stencils.neighbours[edges] != home).any(axis=1)
    assert moved.any()
    assert not active[home[moved]].all()
    for row, weights in zip(domain.stencils.neighbours[edges], domain.weights, strict=True):
        assert active[row[weights > 0.0]].all()
        assert weights.sum() == pytest.approx(1.0)
    saved_state, weights = gas.save(), domain.weights.copy()
    domain.weights[:] = 0.0
    gas.load(saved_state)
    assert np.array_equal(domain.weights, weights)


def test_clouds_that_cover_what_is_beside_a_wall_that_holds_the_gas_are_refused():
    settings = beside_a_face(0.34) | {"viscous": True}
    settings["boundaries"]["x-"] = {"kind": "isothermal", "temperature": 1.0}
    settings["gas"] |= {"viscosity": 1e-3, "reference_temperature": 1.0, "sutherland": 1.0}
    settings["moving"]["bodies"][0]["temperature"] = 1.0
    with pytest.raises(StepError, match="beside a wall of the box free"):
        gas_of(settings)


def test_adiabatic_walls_of_bodies_are_refused_without_friction():
    settings = scene()
    settings["moving"]["bodies"][0]["is_adiabatic"] = True
    with pytest.raises(SceneError, match="Say viscous = true"):
        gas_of(settings)
