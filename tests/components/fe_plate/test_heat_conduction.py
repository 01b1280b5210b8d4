"""Conduction of heat against exact solutions, another code, and its own account."""

import json
import math
import subprocess
import sys

import numpy as np
import pytest
from skfem import Basis, ElementHex1, MeshHex, asm, condense, solve
from skfem.models.poisson import laplace

from quintet.components.fe_plate.heat.component import FeHeat
from quintet.components.fe_plate.heat.params import (
    ConductingPart,
    FeHeatParams,
    FixedTemperature,
    Flux,
)
from quintet.components.fe_plate.meshes.selections import Faces
from quintet.interfaces.errors import SceneError

K, RHO_C = 2.0, 3.0  # W/(m K), J/(m3 K)
HOT, COLD, BEYOND = (0.0, 0.01, 0.01), (0.03, 0.0, 0.0), (0.03, 0.0, 0.01)  # m, of Arinchev's bar
# Mean temperature [K] by elements across, 10 mm, of another solver: exact, by cosine transforms.
MEANS = {1: 179.05, 2: 183.32, 3: 177.47, 4: 175.15, 6: 172.45, 8: 171.05, 12: 169.62, 24: 168.16}


def block(size, elements, temperature=0.0, **keys):
    part = ConductingPart(
        lowest=(0.0, 0.0, 0.0), highest=size, elements=elements, temperature=temperature,
        conductivity=K, density=RHO_C, specific_heat=1.0,
    )  # fmt: skip
    return FeHeat(FeHeatParams(parts=(part,), **keys))


def face(at, size, temperature):
    """Nodes across x held at a temperature."""
    return FixedTemperature(lowest=(at, 0.0, 0.0), highest=(at, *size[1:]), temperature=temperature)


def bar_with_points(n):
    points = [(HOT, 500.0), (COLD, 0.0), (BEYOND, 0.0)]
    fixed = tuple(FixedTemperature(point=point, temperature=kelvin) for point, kelvin in points)
    return block((0.03, 0.01, 0.01), (3 * n, n, n), 170.0, steady=True, fixed_temperatures=fixed)


def test_temperatures_held_at_points_depend_on_the_mesh():
    """The mean is that of the table; the heat that enters goes to nothing with the elements."""
    flow = {}
    for n, mean in MEANS.items():
        body = bar_with_points(n)
        body.step(1.0)
        outputs = body.give({"parts.temperature", "held.heat_flow"})
        assert outputs["parts.temperature"][0] == pytest.approx(mean, rel=2e-3)
        assert abs(outputs["held.heat_flow"].sum()) < 1e-8 * outputs["held.heat_flow"][0]
        flow[n] = outputs["held.heat_flow"][0] / K
    assert flow[24] == pytest.approx(95.1 * 0.01 / 24, rel=0.01)
    assert flow[12] / flow[24] == pytest.approx(2.0, rel=0.02)


def test_temperatures_are_those_of_another_code():
    """scikit-fem, trilinear elements, the same mesh, to the residual of conjugate gradients."""
    n = 4
    body = bar_with_points(n)
    body.step(1.0)
    lines = [np.linspace(0.0, 0.01 * k, k * n + 1) for k in (3, 1, 1)]
    mesh = MeshHex.init_tensor(*lines)
    nodes = [int(np.argmin(((mesh.p.T - point) ** 2).sum(axis=1))) for point in (HOT, COLD, BEYOND)]
    x = np.zeros(mesh.p.shape[1])
    x[nodes[0]] = 500.0
    reference = solve(*condense(asm(laplace, Basis(mesh, ElementHex1())), x=x, D=np.array(nodes)))
    order = np.lexsort(np.round(mesh.p[::-1], 9))
    assert body.state.temperature == pytest.approx(reference[order], abs=1e-6)


def test_a_linear_temperature_is_exact_in_any_mesh():
    """Along a cylinder, whose elements are squares that were made round."""
    part = ConductingPart(
        shape="cylinder",
        base=(0.0, 0.0, 0.0),
        top=(0.0, 0.0, 2.0),
        radius=0.5,
        elements=(2, 2, 3),
        conductivity=K,
    )
    ends = [
        FixedTemperature(lowest=(-1, -1, z), highest=(1, 1, z), temperature=t)
        for z, t in ((0, 9), (2, 5))
    ]
    body = FeHeat(FeHeatParams(parts=(part,), fixed_temperatures=tuple(ends), steady=True))
    body.step(1.0)
    mesh = body.model.mesh
    assert body.state.temperature == pytest.approx(9.0 - 2.0 * mesh.node[:, 2], abs=1e-8)
    area = body.model.volume.sum() / 2.0
    flow = body.give({"held.heat_flow"})["held.heat_flow"]
    assert flow == pytest.approx([2.0 * K * area, -2.0 * K * area], rel=1e-8)


def test_steady_heat_through_half_a_side_follows_its_series():
    """A square plate, heated on half of one side and held on the opposite: within 0.5 %."""
    n, flux = 16, 5.0
    heated = Faces(lowest=(0.0, 0.0, 0.0), highest=(0.0, 0.5, 0.1))
    body = block(
        (1.0, 1.0, 0.1), (n, n, 1), steady=True,
        fixed_temperatures=(face(1.0, (1.0, 1.0, 0.1), 0.0),),
        fluxes=(Flux(faces=heated, flux=flux),),
    )  # fmt: skip
    body.step(1.0)
    x, y, _ = body.model.mesh.node.T
    exact = 0.5 * flux / K * (1.0 - x)
    for m in range(1, 200, 2):
        w = m * math.pi
        # cosh is taken out, so that nothing overflows
        ratio = (np.exp(-w * x) - np.exp(-w * (2.0 - x))) / (1.0 + math.exp(-2.0 * w))
        exact += 2.0 * flux / (K * w * w) * math.sin(0.5 * w) * np.cos(w * y) * ratio
    assert np.abs(body.state.temperature - exact).max() < 5e-3 * exact.max()


def temperatures_in_slab(dt, n=32, seconds=0.15):
    """Temperatures and places in a slab, at first of 1 K, whose ends are held at 0 K."""
    size = (1.0, 1.0 / n, 1.0 / n)
    ends = (face(0.0, size, 0.0), face(1.0, size, 0.0))
    body = block(size, (n, 1, 1), 1.0, fixed_temperatures=ends)
    for _ in range(round(seconds / dt)):
        body.step(dt)
    return body.state.temperature, body.model.mesh.node[:, 0]


def test_a_slab_cools_as_its_series_says():
    """Within 0.5 % of the highest temperature; at second order in the step."""
    temperatures, x = temperatures_in_slab(0.01)
    exact = np.zeros_like(x)
    for m in range(1, 40, 2):
        fading = math.exp(-K / RHO_C * (m * math.pi) ** 2 * 0.15)
        exact += 4.0 / (m * math.pi) * np.sin(m * math.pi * x) * fading
    assert np.abs(temperatures - exact).max() < 5e-3 * exact.max()
    fine, _ = temperatures_in_slab(0.15 / 128)
    errors = [np.abs(temperatures_in_slab(0.15 / steps)[0] - fine).max() for steps in (8, 16)]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.25)


def test_a_flux_heats_as_its_series_says():
    """One end of an insulated slab (Carslaw & Jaeger 1959, section 3.8): within 0.5 %."""
    n, flux, seconds = 32, 5.0, 0.3
    size = (1.0, 0.1, 0.1)
    heated = Faces(lowest=(0.0, 0.0, 0.0), highest=(0.0, 0.1, 0.1))
    body = block(
        size, (n, 1, 1), fluxes=(Flux(faces=heated, flux=flux),), node_gauges=((0.0, 0.0, 0.0),)
    )
    for _ in range(60):
        body.step(seconds / 60)
    time = K / RHO_C * seconds
    series = sum(
        math.exp(-((m * math.pi) ** 2) * time) / m**2 for m in range(1, 40)
    ) * 2.0 / math.pi**2  # fmt: skip
    exact = flux / K * (time + 1.0 / 3.0 - series)
    assert body.give({"node_gauge.temperature"})["node_gauge.temperature"][0] == pytest.approx(
        exact, rel=5e-3
    )
    assert body.totals().internal == pytest.approx(flux * 0.01 * seconds, rel=1e-12)


@pytest.mark.parametrize("is_held", [True, False])
def test_heat_is_conserved_whatever_the_tolerance(is_held):
    """Heat of partners and of held temperatures is the body's gain, to rounding."""
    size = (0.3, 0.2, 0.2)
    fixed = (face(0.0, size, 7.0),) if is_held else ()
    body = block(size, (3, 2, 2), 3.0, tolerance=1e-3, fixed_temperatures=fixed)
    heat = np.random.default_rng(1).normal(size=len(body.surface))
    before, dt = body.totals().internal, 0.02
    body.take({"node_heat.heat_flow": heat})
    body.step(dt)
    heat_flow = heat.sum()
    if is_held:
        heat_flow += body.give({"held.heat_flow"})["held.heat_flow"].sum()
    assert body.totals().internal - before == pytest.approx(dt * heat_flow, rel=1e-10)


@pytest.mark.parametrize(("size", "step"), [((1.0, 1.0, 1e-3), 1e9), ((1.0, 1e-3, 1e-3), 1e-9)])
def test_very_long_and_very_short_steps_stay_in_bounds_in_flat_elements(size, step):
    """Temperatures stay between those that are held."""
    ends = (face(0.0, size, 400.0), face(1.0, size, 300.0))
    body = block(size, (10, 10, 3), 300.0, fixed_temperatures=ends)
    for _ in range(3):
        body.step(step)
    assert body.state.temperature.min() > 300.0 - 1e-6
    assert body.state.temperature.max() < 400.0 + 1e-6


def test_a_long_step_overshoots_by_a_quarter_at_most():
    for dt in (0.5, 1.25, 5.0):
        assert -0.26 < temperatures_in_slab(dt, seconds=dt)[0].min() < 0.0


def test_heat_that_comes_from_outside_is_counted():
    size = (1.0, 0.5, 0.5)
    body = block(
        size, (3, 2, 2), 3.0, fixed_temperatures=(face(0.0, size, 400.0), face(1.0, size, 300.0))
    )
    start = body.totals()
    for _ in range(4):
        body.step(0.02)
    end = body.totals()
    assert end.internal - start.internal == pytest.approx(end.work - start.work, rel=1e-10)
    assert end.work > 0.0


def test_conduction_and_mechanics_import_nothing_of_each_other():
    code = (
        "import importlib, json, sys; importlib.import_module(sys.argv[1]); "
        "print(json.dumps([n for n in sys.modules if n.startswith('quintet.components.fe_plate')]))"
    )
    modules = {}
    for name in ("fe_plate.component", "fe_plate.heat.component"):
        line = [sys.executable, "-c", code, f"quintet.components.{name}"]
        text = subprocess.run(line, capture_output=True, text=True, check=True).stdout
        modules[name] = set(json.loads(text))
    assert not any(".heat" in module for module in modules["fe_plate.component"])
    mechanics = {"component", "kernels", "state", "build", "laws"}
    parts = [module.split(".")[3:] for module in modules["fe_plate.heat.component"]]
    assert not any(part and part[0] in mechanics for part in parts)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"steady": True}, "needs a fixed temperature somewhere"),
        (
            {
                "fixed_temperatures": (
                    FixedTemperature(lowest=(9, 9, 9), highest=(9, 9, 9), temperature=1),
                )
            },
            "holds none",
        ),
        ({"coupled_faces": (Faces(lowest=(9, 9, 9), highest=(9, 9, 9)),)}, "must hold an outer"),
    ],
)
def test_what_cannot_be_built_is_refused(keys, words):
    with pytest.raises(SceneError, match=words):
        block((1.0, 1.0, 1.0), (1, 1, 1), **keys)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: FixedTemperature(temperature=1.0), "found none of these. Give one"),
        (
            lambda: FixedTemperature(point=(0, 0, 0), node_set="a", temperature=1.0),
            "found point and node_set. Give one",
        ),
        (lambda: FeHeatParams(parts=()), "at least one"),
        (
            lambda: FeHeatParams(
                parts=(
                    ConductingPart(
                        lowest=(0, 0, 0), highest=(1, 1, 1), elements=(1, 1, 1), conductivity=1
                    ),
                )
            ),
            "density and specific_heat",
        ),
    ],
)
def test_what_contradicts_itself_is_refused(make, words):
    with pytest.raises(ValueError, match=words):
        make()


@pytest.mark.parametrize(("share", "is_warned"), [(0.2, False), (2.0, True)])
def test_steps_that_pass_over_the_transient_are_warned_of(share, is_warned):
    """A step is long beside L²/(π² a), in which heat crosses a part of length L."""
    part = ConductingPart(
        lowest=(0.0,) * 3, highest=(0.03, 0.01, 0.01), elements=(6, 1, 1), conductivity=237.0,
        density=2700.0, specific_heat=900.0,
    )  # fmt: skip
    fixed = FixedTemperature(lowest=(0.03, 0.0, 0.0), highest=(0.03, 0.01, 0.01), temperature=400.0)
    body = FeHeat(FeHeatParams(parts=(part,), fixed_temperatures=(fixed,)))
    crossing = 0.03**2 * 2700.0 * 900.0 / (math.pi**2 * 237.0)
    for _ in range(3):
        body.step(share * crossing)
    assert bool(body.warnings()) == is_warned
    resumed = FeHeat(body.params)
    resumed.load(body.save())
    assert resumed.warnings() == body.warnings()


def test_a_run_from_the_state_of_another_has_its_own_fixed_temperatures():
    size, elements = (0.04, 0.01, 0.01), (4, 1, 1)
    first = block(size, elements, 300.0, fixed_temperatures=(face(0.0, size, 400.0),))
    first.step(1e-5)
    ends = face(0.0, size, 500.0), face(0.04, size, 200.0)
    second = block(size, elements, 0.0, fixed_temperatures=ends)
    second.begin_from(first.save())
    assert not second.state.judged.any()
    second.step(1e9)
    temperature, x = second.state.temperature, second.model.mesh.node[:, 0]
    np.testing.assert_allclose(temperature, 500.0 - 300.0 * x / 0.04, rtol=1e-6)
