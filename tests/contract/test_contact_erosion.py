"""Contact goes on with the faces that erosion opens: forces, momentum, energy, resumed states."""

import laboratory
import numpy as np
import pytest

SOFT = {"density": 1000.0, "youngs_modulus": 1e5, "poissons_ratio": 0.3}  # waves of 10 m/s
# It fails by what no test reaches, so that its elements may erode.
TOUGH = {**SOFT, "johnson_cook": {"a": 1e9, "b": 0.0, "n": 1.0, "c": 0.0}, "failure_strain": 10.0}
WEAK = {**SOFT, "johnson_cook": {"a": 2e3, "b": 0.0, "n": 1.0, "c": 0.0}, "failure_strain": 0.4}
SPACING, SPEED, GAP = 0.1, 0.02, 1e-4  # m, m/s, m
WIDE = 6  # spacings
SLOW = (1e5 * 0.7 / (1.3 * 0.4) / 1000.0) ** 0.5  # m/s, of longitudinal waves
STILL = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}


def _bar(length, **keys):
    """A bar above z = 0 that nothing strains sideways; it falls."""
    edge = WIDE * SPACING
    return {
        "kind": "sph_solid", "dimensions": 2, "spacing": SPACING, "contact_with_faces": True,
        "bodies": [{
            "lowest": [0.0, 0.0, GAP], "highest": [edge, 1.0, GAP + length], "material": SOFT,
            "velocity": [0.0, 0.0, -SPEED],
        }],
        "symmetry": [
            {"axis": "x", "position": place, "side": side}
            for side, place in (("+", 0.0), ("-", edge))
        ],
        **keys,
    }  # fmt: skip


def _slab(top, length, across, layers, **keys):
    """A slab below a height that nothing strains sideways, touched at its upper face."""
    edge = WIDE * SPACING
    low, high = [0.0, 0.0, top - length], [edge, 1.0, top]
    middles = (np.arange(across) + 0.5) * edge / across
    part = {"lowest": low, "highest": high, "elements": [across, 1, layers], "material": TOUGH}
    return {
        "kind": "toy_peeling:Peeling", "dimensions": 2, "integration": "reduced", "parts": [part],
        "fixed": [{"lowest": low, "highest": high, "directions": ["x"]}],
        "coupled_faces": [{"lowest": [0.0, 0.0, top], "highest": high}],
        "gauges": {"element_gauges": [[float(x), 0.5, -0.5 * SPACING] for x in middles]},
        **STILL, **keys,
    }  # fmt: skip


def _couple(folder, bar, slab, end, **link):
    folder.mkdir(exist_ok=True)
    table = {"kind": "contact", "between": ["slab", "bar"], **link}
    order = ["bar", "slab"]
    return laboratory.couple(
        laboratory.scene(folder, {"bar": bar, "slab": slab}, table, end=end, order=order)
    )


def test_freshly_opened_faces_bear_the_same_pressure_as_a_surface_of_the_start(tmp_path):
    # Twenty layers of a spacing below z = 0, bare from the start, and below others that erode.
    length = 20 * SPACING  # m
    end = GAP / SPEED + 1.8 * length / SLOW
    bare = _slab(0.0, length, 4, 20, above=1.0)
    peeled = _slab(1.25 * length, 2.25 * length, 4, 45, above=0.0)
    pressures, speeds = [], []
    for name, slab in (("bare", bare), ("peeled", peeled)):
        trace = _couple(tmp_path / name, _bar(length), slab, end, points_across=3)
        late = trace.times > GAP / SPEED + 0.3 * length / SLOW
        pressures.append(trace.history("slab", "element_gauge.pressure")[late].mean(axis=0))
        falling = trace.history("bar", "bodies.velocity")[:, 0, 2]
        speeds.append(np.interp(np.linspace(0.0, end, 50), trace.times, falling))
        assert not [text for text in trace.warnings if "quadrature point" not in text]
    for pressure in pressures:
        assert np.abs(pressure / pressure.mean() - 1.0).max() < 0.01
    assert pressures[1].mean() == pytest.approx(pressures[0].mean(), rel=0.01)
    # Half of the eroded layer's mass stays at the nodes of the new surface: 1/40 of the bar's.
    assert np.abs(speeds[1] - speeds[0]).max() < 0.02 * SPEED


def test_contact_goes_on_below_a_layer_that_erodes_while_it_is_pressed(tmp_path):
    # The bar has been pressing for half a transit when the layer goes.
    length, layer = 10 * SPACING, 0.1 * SPACING  # m
    touch, transit = GAP / SPEED, length / SLOW
    slab = _slab(0.0, length, 6, 100, above=-layer, peeled=touch + 0.5 * transit)
    trace = _couple(tmp_path, _bar(length), slab, touch + 5.0 * transit, friction=0.3)
    bar, slab = trace.components["bar"], trace.components["slab"]
    start = -SPEED * bar.totals().mass
    assert np.abs(trace.momentum()[2] - start) < 1e-12 * abs(start)
    assert trace.account.momentum_residual < 1e-12
    energy = trace.energy() + bar.totals().dissipated
    assert energy == pytest.approx(trace.energies[0], rel=0.01)
    assert bar.totals().dissipated > 0.0


def digging(folder, layers=20, end=0.25, **settings):
    """Write the scene of a rod that digs into a plate of layers of 0.05 m."""
    stiff = {**SOFT, "density": 4000.0, "youngs_modulus": 1e6}
    rod = {
        "kind": "sph_solid", "dimensions": 2, "spacing": 0.05, "contact_with_faces": True,
        "courant": 0.25,
        "bodies": [{"lowest": [-0.1, 0.0, 0.001], "highest": [0.1, 1.0, 0.601],
                    "material": stiff, "velocity": [0.0, 0.0, -3.0]}],
    }  # fmt: skip
    part = {"lowest": [-1.0, 0.0, -0.05 * layers], "highest": [1.0, 1.0, 0.0],
            "elements": [40, 1, layers], "material": WEAK}  # fmt: skip
    plate = {"kind": "fe_plate", "dimensions": 2, "integration": "reduced", "parts": [part],
             "gauges": {"part_gauge": True}}  # fmt: skip
    table = {"kind": "contact", "between": ["plate", "rod"], "friction": 0.1}
    order = ["rod", "plate"]
    components = {"rod": rod, "plate": plate}
    return laboratory.scene(folder, components, table, end=end, order=order, **settings)


def test_a_rod_digs_through_layers_of_a_plate(tmp_path):
    trace = laboratory.couple(digging(tmp_path))
    rod, plate = (trace.components[name].totals() for name in ("rod", "plate"))
    assert np.abs(trace.momentum()[2] + 3.0 * rod.mass) < 1e-12 * 3.0 * rod.mass
    assert trace.account.momentum_residual < 1e-12
    # Strains of eroded elements stay part of the plate's energy; springs on them are dissipated.
    assert trace.energy() + rod.dissipated == pytest.approx(trace.energies[0], rel=0.003)
    assert not [text for text in trace.warnings if "quadrature point" not in text]
    eroded = trace.history("plate", "part_gauge.eroded")[-1, 0]
    assert 0.05 * trace.energies[0] < eroded < plate.internal
    # Four layers and more are pierced; below the second the plate still slows the rod down.
    tip = trace.history("rod", "bodies.lowest")[:, 0, 2]
    assert tip[-1] < -4.0 * 0.05
    below = tip < -2.0 * 0.05
    speed = -trace.history("rod", "bodies.velocity")[below, 0, 2]
    assert speed[0] - speed[-1] > 0.1 * speed[0]
