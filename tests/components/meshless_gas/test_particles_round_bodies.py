"""Point particles among nodes in layers; about an axis each stands for a ring of grains."""

import numpy as np
import pytest

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.point_particles.half_plane import (
    azimuths_of,
    from_half_plane,
    to_half_plane,
)
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

WIND = {"density": 1.0, "pressure": 1.0 / 1.4, "velocity": [3.0, 0.0, 0.0]}
INFLOW = {"kind": "inflow", "state": WIND}
ROUND = {"wall": {"kind": "slip"}, "far": INFLOW, "exit": {"kind": "outflow"}}
SPHERE = {"radius": 1.0, "points_around": 12, "layers": {"count": 10}, "outer_radius": 2.0}
CLOUDS = {
    "axis": {"axisymmetric": True, "sphere": SPHERE, "boundaries": ROUND},
    "space": {"dimensions": 3, "sphere": SPHERE | {"points_around": 8}, "boundaries": ROUND},
    "plate": {
        "plate": {
            "length": 2.0, "ahead": 0.5, "height": 1.0, "points_along": 10, "finest": 0.1,
            "layers": {"count": 10},
        },
        "boundaries": {
            "wall": {"kind": "slip"}, "ahead": {"kind": "slip"}, "inlet": INFLOW,
            "far": {"kind": "outflow"}, "exit": {"kind": "outflow"},
        },
    },
}  # fmt: skip
PLACES = {"axis": [-1.06, 0.0, 0.5], "space": [-1.1, 0.02, 0.3], "plate": [0.8, 0.0, 0.5]}
MASS, SIZE = 1e-4, 1e-3  # kg, m: of a grain that is light, so that it is dragged much


def gas_of(cloud, places, parcel=5.0, reaction=True, **moving):
    """A gas with the particles of a partner."""
    table = CLOUDS[cloud] | {"gas": {"gas_constant": 1.0, "viscosity": 0.1}, "initial": WIND}
    table |= {"particles": {"drag": "stokes", "reaction": reaction}}
    params, mistakes = read(MeshlessGasParams, table, "gas")
    assert not mistakes, mistakes
    gas, count = MeshlessGas(params), len(places)
    properties = {"mass": MASS, "heat_capacity": 1e-4, "number": 1.0}
    gas.bind(
        {
            f"particles.{name}": np.full(count, parcel * amount)
            for name, amount in properties.items()
        },
        frozenset(),
    )
    particles = {
        "position": np.array(places),
        "velocity": np.zeros((count, 3)),
        "acceleration": np.zeros((count, 3)),
        "temperature": np.full(count, 0.5),
        "diameter": np.full(count, SIZE),
        "launched": np.ones(count),
    } | moving
    fields = {f"particles.{name}": values for name, values in particles.items()}
    gas.prime(fields)
    gas.take(fields)
    return gas


def loads(gas):
    """Forces [N] and heat [W] on particles."""
    outputs = gas.give(frozenset({"particle_load.force", "particle_heat.heat_flow"}))
    return outputs["particle_load.force"], outputs["particle_heat.heat_flow"]


def test_turned_vectors_come_back():
    rng = np.random.default_rng(2)
    places, vectors = rng.normal(size=(2, 6, 3))
    places[0, 1:] = 0.0  # on the axis
    azimuths = azimuths_of(places, np.zeros(3))
    turned = to_half_plane(azimuths, places)
    assert turned[:, 1] == pytest.approx(0.0, abs=1e-15)
    assert turned[:, 2] == pytest.approx(np.hypot(places[:, 1], places[:, 2]))
    assert from_half_plane(azimuths, to_half_plane(azimuths, vectors)) == pytest.approx(vectors)


@pytest.mark.full  # kernels in space
@pytest.mark.parametrize("cloud", CLOUDS)
def test_what_particles_get_nodes_in_layers_lose(cloud):
    two_way = gas_of(cloud, [PLACES[cloud]])
    volumes = two_way.motion.domain.cloud.volumes[: two_way.items()]
    one_way = gas_of(cloud, [PLACES[cloud]], reaction=False)
    dt = 0.2 * min(two_way.stable_dt(), one_way.stable_dt())
    before = two_way.state.conservative.copy()
    for gas in (two_way, one_way):
        gas.parts[-1].begin(dt, gas.fluxes.primitive, gas.state.conservative)
        gas.scheme.write_rates(dt, (0.0, 1.0, 1.0))
    rates = [gas.fluxes.residual[: gas.items()] for gas in (two_way, one_way)]
    lost = (volumes[:, None] * (rates[0] - rates[1])).sum(axis=0)
    force, heat = loads(two_way)
    assert np.array_equal(before, two_way.state.conservative)
    assert force[0, 0] > 0.0 and heat[0] > 0.0
    assert lost[1] == pytest.approx(-force[0, 0], rel=1e-12)
    assert lost[4] == pytest.approx(-heat[0], rel=1e-12)  # the particle rests
    if cloud != "axis":
        assert lost[1:4] == pytest.approx(-force[0], rel=1e-12)


@pytest.mark.full
def test_a_ring_of_grains_is_the_same_at_every_angle():
    turn, x, radius = 1.1, *np.array(PLACES["axis"])[[0, 2]]
    aside = [x, radius * np.sin(turn), radius * np.cos(turn)]
    gas = gas_of("axis", [PLACES["axis"], aside])
    dt = 0.5 * gas.stable_dt()
    gas.step(dt)
    force, heat = loads(gas)
    assert np.hypot(*force[1, 1:]) == pytest.approx(force[0, 2], rel=1e-9)
    assert force[1, 1] == pytest.approx(force[0, 2] * np.sin(turn), rel=1e-9)
    assert force[1, 0] == pytest.approx(force[0, 0], rel=1e-12)
    assert heat[1] == pytest.approx(heat[0], rel=1e-12)
    # Two halves of the grains are those of one particle with all of them.
    single = gas_of("axis", [PLACES["axis"]], parcel=10.0)
    single.step(dt)
    assert loads(single)[0][0] == pytest.approx(2.0 * force[0], rel=1e-9)
    assert single.state.conservative == pytest.approx(gas.state.conservative, rel=1e-9, abs=1e-12)
    saved_state = gas.save()
    after = loads(gas)[0]
    gas.step(dt)
    gas.load(saved_state)
    assert np.array_equal(loads(gas)[0], after)


def test_particles_larger_than_the_spacing_are_refused():
    size = {"diameter": np.array([1e-3, 3.0])}
    pattern = r"smaller than the spacing of nodes, .* found particle 1 of 3 m. Make nodes coarser"
    with pytest.raises(SceneError, match=pattern):
        gas_of("axis", [PLACES["axis"]] * 2, **size)
