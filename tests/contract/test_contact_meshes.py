"""Two meshes of finite elements in contact, face to face: patch test, impact, friction, step."""

import laboratory
import numpy as np
import pytest

from quintet.coupler.coupling.links.contact import widths
from quintet.interfaces.component import outputs_of
from quintet.interfaces.errors import SceneError

SOFT = {"density": 1000.0, "youngs_modulus": 1e5, "poissons_ratio": 0.3}
C = (1e5 * 0.7 / (1.3 * 0.4) / 1000.0) ** 0.5  # m/s, of longitudinal waves
SPEED, GAP = 0.02, 1e-4  # m/s, m
CALM = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}


def bar(low, high, count, planar=False, **keys):
    """A bar of elements along z that nothing strains sideways."""
    sides = ["x"] if planar else ["x", "y"]
    part = {"lowest": low, "highest": high, "elements": count, "material": SOFT}
    part |= {key: keys.pop(key) for key in ("velocity", "tetrahedra") if key in keys}
    return {
        "kind": "fe_plate", "dimensions": 2 if planar else 3, "integration": "reduced",
        "parts": [part], "fixed": [{"lowest": low, "highest": high, "directions": sides}],
        **CALM, **keys,
    }  # fmt: skip


def couple(folder, upper, lower, end, touching="upper", **link):
    components = {"upper": upper, "lower": lower}
    components[touching] = {**components[touching], "contact_with_faces": True}
    order = ["upper", "lower"] if touching == "upper" else ["lower", "upper"]
    table = {"kind": "contact", "between": ["lower", "upper"], **link}
    return laboratory.couple(laboratory.scene(folder, components, table, end=end, order=order))


def _gauges(edge, across, planar, z):
    middles = (np.arange(across) + 0.5) * edge / across
    along_y = [0.5] if planar else middles
    return {"element_gauges": [[float(x), float(y), z] for x in middles for y in along_y]}


def _pushing(folder, across, planar):
    """Two equal bars of unlike meshes that push each other with ρ c v/2."""
    edge, length, layers = 1.2, 2.0, 20
    deep, z = 1.0 if planar else edge, 0.5 * length / layers
    bars = []
    for bottom, count, speed in ((GAP, across[0], -SPEED), (-length, across[1], 0.0)):
        low, high = [0.0, 0.0, bottom], [edge, deep, bottom + length]
        gauges = _gauges(edge, count, planar, GAP + z if bottom > 0.0 else -z)
        elements = [count, 1 if planar else count, layers]
        velocity = [0.0, 0.0, speed]
        bars.append(bar(low, high, elements, planar, velocity=velocity, gauges=gauges))
    trace = couple(folder, *bars, end=GAP / SPEED + 1.8 * length / C)
    late = trace.times > GAP / SPEED + 0.3 * length / C
    return [
        trace.history(name, "element_gauge.pressure")[late].mean(axis=0)
        for name in ("upper", "lower")
    ]


@pytest.mark.parametrize(
    ("across", "planar"),
    [((12, 5), True), ((5, 12), True), ((4, 3), False), ((3, 5), False)],
)
def test_flat_meshes_press_every_element_alike(tmp_path, across, planar):
    longitudinal, bulk = 1000.0 * C**2, 1e5 / (3.0 * 0.4)
    exact = bulk / longitudinal * 1000.0 * C * SPEED / 2.0
    for pressure in _pushing(tmp_path, across, planar):
        assert np.abs(pressure / pressure.mean() - 1.0).max() < 0.01
        assert pressure.mean() == pytest.approx(exact, rel=0.01)


def test_the_width_of_an_elongated_face_is_its_shortest_side():
    node = np.array([[0, 0, 0], [10, 0, 0], [10, 1, 0], [0, 1, 0]], float)
    corner = np.array([[0, 1, 2, 3], [0, 1, 2, 2], [0, 1, 1, 0]])
    np.testing.assert_allclose(widths(node, corner), [1.0, 1.0, 10.0])


def _impact(folder, end=0.35, side=0.0, courant=0.9, **link):
    """Two equal bars of unlike meshes; the upper one strikes the lower one, and moves aside."""
    still = {"courant": courant}
    upper = bar([0.0, 0.0, GAP], [0.3, 0.3, GAP + 0.5], [3, 3, 5], **still)
    lower = bar([0.0, 0.0, -0.5], [0.3, 0.3, 0.0], [2, 2, 4], **still)
    del upper["fixed"], lower["fixed"]
    upper["parts"][0]["velocity"] = [side, 0.0, -SPEED]
    return couple(folder, upper, lower, end, **link)


def test_an_impact_of_meshes_keeps_momentum_and_energy(tmp_path):
    trace = _impact(tmp_path, friction=0.3, side=0.5 * SPEED)
    upper, lower = trace.components["upper"], trace.components["lower"]
    mass = upper.totals().mass
    start = np.array([0.5 * SPEED, 0.0, -SPEED]) * mass
    assert np.abs(trace.momentum() - start).max() < 1e-12 * np.abs(start).max()
    assert trace.account.momentum_residual < 1e-12
    dissipated = upper.totals().dissipated
    assert trace.energy() + dissipated == pytest.approx(trace.energies[0], rel=0.01)
    assert dissipated > 0.0
    assert lower.totals().momentum[2] < -0.8 * mass * SPEED  # it has got the motion
    assert upper.touching.penalty.numbers.energy == 0.0  # they have parted
    # So few elements of one point each bend too easily, and say so.
    assert not [text for text in trace.warnings if "quadrature point" not in text]


def test_the_ledger_counts_the_same_work_on_both_meshes(tmp_path):
    residuals = []
    for courant in (0.9, 0.45):
        folder = tmp_path / str(courant)
        folder.mkdir()
        account = _impact(folder, courant=courant).account
        assert account.turnover > 0.0
        residuals.append(account.energy_residual)
    # The side that computes knows the other at a step's begin: an error of first order in the step.
    assert residuals[0] < 0.06
    assert residuals[1] < 0.65 * residuals[0]


def _sliding(folder, gravity, speed, end, mu=0.3):
    """Times [s] and velocities [m/s] along x of a block of elements on a clamped slab; the run.

    It is pressed in by its weight at the start; damping ends its bouncing.
    """
    stiff = {**SOFT, "poissons_ratio": 0.0}
    depth = 0.1 * 1000.0 * 0.2 / 1e5  # m, of the springs: p (h/M + h/M)
    block = bar([0.2, 0.0, -depth], [0.6, 1.0, 0.1 - depth], [4, 1, 1], planar=True)
    slab = bar([0.0, 0.0, -0.2], [1.6, 1.0, 0.0], [13, 1, 2], planar=True)
    block |= {"gravity": gravity, "fixed": [], "gauges": {"part_gauge": True}}
    block["parts"][0] |= {"velocity": [speed, 0.0, 0.0], "material": stiff}
    slab["parts"][0]["material"] = stiff
    slab["fixed"] = [{"lowest": [0.0, 0.0, -0.2], "highest": [1.6, 1.0, -0.2]}]
    for side in (block, slab):
        side["stiffness_damping"] = 3e-3
    trace = couple(folder, block, slab, end, friction=mu)
    return trace.times, trace.history("upper", "part_gauge.velocity")[:, 0, 0], trace


def test_a_block_of_elements_slides_to_rest_by_friction(tmp_path):
    mu, end = 0.3, 1.2
    times, velocity, trace = _sliding(tmp_path, [0.0, 0.0, -1.0], 1.0, end)
    assert -np.polyfit(times, velocity, 1)[0] == pytest.approx(mu, rel=0.01)
    totals = trace.components["upper"].totals()
    speed = totals.momentum / totals.mass
    # The impulse of the normal force, over the mass: the block bounces.
    assert 1.0 - speed[0] == pytest.approx(mu * (end + speed[2]), rel=0.01)
    dissipated = 0.5 * totals.mass * (1.0 - speed[0] ** 2)
    assert totals.dissipated == pytest.approx(dissipated, rel=0.02)


@pytest.mark.parametrize(("slope", "slides"), [(0.2, False), (0.33, True)])
def test_a_block_sticks_below_the_angle_of_friction_and_slides_above(tmp_path, slope, slides):
    times, velocity, _ = _sliding(tmp_path, [slope, 0.0, -1.0], 0.0, 0.8)
    late = times > 0.4
    if slides:
        slope_of_velocity = np.polyfit(times[late], velocity[late], 1)[0]
        assert slope_of_velocity == pytest.approx(slope - 0.3, rel=0.1)
    else:
        # It swings on the springs of friction, by 0.1 p/κ = 20 µm and less.
        assert abs(np.trapezoid(velocity[late], times[late])) < 2e-5


def test_contact_goes_on_where_the_mesh_that_computes_erodes(tmp_path):
    tough = {**SOFT, "johnson_cook": {"a": 1e9, "b": 0.0, "n": 1.0, "c": 0.0}, "failure_strain": 10}
    upper = bar([0.0, 0.0, GAP], [0.6, 1.0, GAP + 1.0], [6, 1, 10], planar=True)
    lower = bar([0.0, 0.0, -1.0], [0.6, 1.0, 0.0], [4, 1, 100], planar=True)
    upper["parts"][0]["velocity"] = [0.0, 0.0, -SPEED]
    lower["parts"][0]["material"] = tough
    lower["coupled_faces"] = [{"lowest": [0.0, 0.0, 0.0], "highest": [0.6, 1.0, 0.0]}]
    lower |= {"kind": "toy_peeling:Peeling", "above": -0.01, "peeled": GAP / SPEED + 0.5 / C}
    trace = couple(tmp_path, upper, lower, GAP / SPEED + 4.0 / C, "lower", friction=0.3)
    start = -SPEED * trace.components["upper"].totals().mass
    assert np.abs(trace.momentum()[2] - start) < 1e-12 * abs(start)
    assert trace.account.momentum_residual < 1e-12
    dissipated = trace.components["lower"].totals().dissipated
    assert trace.energy() + dissipated == pytest.approx(trace.energies[0], rel=0.01)
    assert dissipated > 0.0


def test_a_saved_contact_of_meshes_goes_on_with_the_same_bits(tmp_path):
    upper = _impact(tmp_path, end=0.05, friction=0.3, side=SPEED).components["upper"]
    saved = {key: np.array(array) for key, array in upper.save().items()}
    assert saved["contact/reaction"].any() and saved["contact/slip"].any()
    steps = []
    for _ in range(2):
        upper.load(saved)
        steps.append(upper.stable_dt())
        upper.step(1e-3)
        steps.append(outputs_of(upper))
    assert steps[0] == steps[2]
    for key, array in steps[1].items():
        np.testing.assert_array_equal(array, steps[3][key])


def test_contact_of_meshes_says_what_is_missing(tmp_path):
    upper = bar([0.0, 0.0, GAP], [0.3, 0.3, 0.5], [3, 3, 5])
    lower = bar([0.0, 0.0, -0.5], [0.3, 0.3, 0.0], [2, 2, 4])
    components = {"upper": upper, "lower": lower}
    link = {"kind": "contact", "between": ["lower", "upper"]}
    rule = "contact needs: lower must take a port contact_faces: set contact_with_faces = true"
    with pytest.raises(SceneError, match=rule):
        laboratory.couple(laboratory.scene(tmp_path, components, link, end=1.0))
    itself = {"kind": "contact", "between": ["upper", "upper"]}
    with pytest.raises(SceneError, match="between must name two components; found"):
        laboratory.couple(laboratory.scene(tmp_path, components, itself, end=1.0))
    flat = bar([0.0, 0.0, GAP], [0.3, 1.0, 0.5], [3, 1, 5], planar=True)
    with pytest.raises(SceneError, match="two dimensions or both three; upper has two, lower has"):
        couple(tmp_path, flat, lower, 1.0)
