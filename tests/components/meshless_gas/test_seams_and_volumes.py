"""Volumes about bodies with clouds, weights at faces of the box, coefficients across fringe."""

import numpy as np
import pytest
from test_moving_clouds import RADIUS, about_an_axis, in_a_stream, made, params_of, scene, two

from quintet.interfaces.errors import SceneError, StepError


def test_coefficients_are_written_anew_only_where_clouds_have_moved(monkeypatch):
    gas = made(scene(bodies=two(0.5), gas=[0.0, 0.0, 0.0]))
    one, fringe, written = gas.motion, gas.motion.fringe, []
    before, region = one.domain.stencils.coefficients.copy(), one.domain.cloud.region
    fit = fringe.fit
    monkeypatch.setattr(fringe, "fit", lambda rows: (written.append(rows), fit(rows)))
    one.place(1, 1e-3)
    near = region[one.domain.stencils.neighbours[written[0]]]
    assert 0 < len(written[0]) < len(fringe.across)
    assert ((near == 2).any(axis=1) | (region[written[0]] == 2)).all()
    fit(fringe.across)
    every = one.domain.stencils.coefficients.copy()
    assert not np.array_equal(every, before)
    one.domain.stencils.coefficients[:] = before
    fit(written[0])
    assert np.array_equal(one.domain.stencils.coefficients, every)
    written.clear()
    one.place(1, 1e-3)
    assert not written


def of_box(settings, *bodies):
    """Volume of a box less that of bodies; of whole rings about an axis."""
    low, high = (np.array(settings["box"][key])[[0, 2]] for key in ("lowest", "highest"))
    if settings["moving"].get("axisymmetric"):
        return np.pi * high[1] ** 2 * (high[0] - low[0]) - sum(bodies)
    return np.prod(high - low) - sum(bodies)


def test_volumes_of_nodes_about_bodies_fill_the_box():
    disc, ball = np.pi * RADIUS**2, 4.0 / 3.0 * np.pi * RADIUS**3
    for settings, whole, steps in (
        (plane := scene(share=1.0), of_box(plane, disc), 12),
        (axis := about_an_axis(), of_box(axis, ball), 0),
        (cut := in_a_stream(sector=0.5 * np.pi), of_box(cut, 0.5 * ball), 0),
        (both := scene(bodies=two(0.5)), of_box(both, 0.25 * disc, 0.25 * disc), 0),
    ):
        gas = made(settings)
        for _ in range(steps):
            gas.step(gas.stable_dt())
        assert gas.motion.domain.cloud.volumes.sum() == pytest.approx(whole, rel=2e-3)
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
    gas = made(beside_a_face(0.34))
    own, edges, active = gas.motion.domain, gas.motion.domain.edges, gas.motion.holes.active
    home = gas.motion.layout.home[edges]
    moved = (own.stencils.neighbours[edges] != home).any(axis=1)
    assert moved.any()
    assert not active[home[moved]].all()
    for row, weights in zip(own.stencils.neighbours[edges], own.weights, strict=True):
        assert active[row[weights > 0.0]].all()
        assert weights.sum() == pytest.approx(1.0)
    kept, weights = gas.save(), own.weights.copy()
    own.weights[:] = 0.0
    gas.load(kept)
    assert np.array_equal(own.weights, weights)


def test_clouds_that_cover_what_is_beside_a_wall_that_holds_the_gas_are_refused():
    settings = beside_a_face(0.34) | {"viscous": True}
    settings["boundaries"]["x-"] = {"kind": "isothermal", "temperature": 1.0}
    settings["gas"] |= {"viscosity": 1e-3, "reference_temperature": 1.0, "sutherland": 1.0}
    settings["moving"]["bodies"][0]["temperature"] = 1.0
    with pytest.raises(StepError, match="beside a wall of the box free"):
        made(settings)


def test_adiabatic_walls_of_bodies_are_refused_without_friction():
    settings = scene()
    settings["moving"]["bodies"][0]["is_adiabatic"] = True
    with pytest.raises(SceneError, match="Say viscous = true"):
        made(settings)
