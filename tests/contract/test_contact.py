"""Particles of a solid touch a mesh of finite elements: momentum, energy, friction, order, step."""

import laboratory
import numpy as np
import pytest

from quintet.components.shared.contact.stable_step import highest_square
from quintet.coupler.coupling.links import maker
from quintet.coupler.coupling.participant import ComponentFailed
from quintet.interfaces.component import outputs_of
from quintet.interfaces.errors import SceneError

SOFT = {"density": 1000.0, "youngs_modulus": 1e5, "poissons_ratio": 0.0}  # waves of 10 m/s
SPACING, SPEED = 0.1, 0.02  # m, m/s
GAP = 1e-4  # m
REST = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}


def _block(low, high, **keys):
    body = {"lowest": low, "highest": high, "material": SOFT, "velocity": keys.pop("velocity")}
    return {
        "kind": "sph_solid",
        "spacing": SPACING,
        "contact_with_faces": True,
        "bodies": [body],
        **keys,
    }


def _slab(low, high, **keys):
    count = [max(1, round((b - a) / SPACING)) for a, b in zip(low, high, strict=True)]
    part = {"lowest": low, "highest": high, "elements": count, "material": SOFT}
    return {"kind": "fe_plate", "parts": [part], **REST, **keys}


def _couple(folder, block, slab, end, order=("block", "slab"), window="auto", **link):
    table = {"kind": "contact", "between": ["slab", "block"], **link}
    settings = {"end": end, "order": list(order), "window": window}
    path = laboratory.scene(folder, {"block": block, "slab": slab}, table, **settings)
    return laboratory.couple(path)


def _impact(folder, end=0.35, side=0.0, courant=0.5, **link):
    """Two equal blocks, 0.5 m long; one strikes the other along z."""
    high = [0.3, 0.3, GAP + 0.5 + 0.5]
    velocity = [side, 0.0, -SPEED]
    block = _block([0.0, 0.0, GAP + 0.5], high, velocity=velocity, courant=courant)
    slab = _slab([0, 0, 0], [0.3, 0.3, 0.5], courant=max(courant, 0.9))
    return _couple(folder, block, slab, end, **link)


def test_an_impact_keeps_momentum_and_energy(tmp_path):
    trace = _impact(tmp_path, friction=0.3, side=0.5 * SPEED)
    block, slab = trace.components["block"], trace.components["slab"]
    mass = block.totals().mass
    start = np.array([0.5 * SPEED, 0.0, -SPEED]) * mass
    assert np.abs(trace.momentum() - start).max() < 1e-12 * np.abs(start).max()
    assert trace.account.momentum_residual < 1e-12
    energy = trace.energy() + block.totals().dissipated
    assert energy == pytest.approx(trace.energies[0], rel=0.01)
    assert block.totals().dissipated > 0.0
    assert slab.totals().momentum[2] < -0.8 * mass * SPEED  # it has got the motion
    assert block.faces.penalty.numbers.energy == 0.0  # they have parted
    # So few elements of one point each bend too easily, and say so.
    assert not [text for text in trace.warnings if "quadrature point" not in text]


def test_the_ledger_counts_the_same_work_on_both_sides(tmp_path):
    residuals = []
    for courant in (0.5, 0.25):
        folder = tmp_path / str(courant)
        folder.mkdir()
        account = _impact(folder, courant=courant).account
        assert account.turnover > 0.0
        residuals.append(account.energy_residual)
    # The particles know the faces at a step's begin: an error of first order in the step.
    assert residuals[0] < 0.06
    assert residuals[1] < 0.65 * residuals[0]


def test_a_block_slides_to_rest_by_friction(tmp_path):
    mu, gravity, end = 0.3, 1.0, 1.2
    mass_over_stiffness = 3 * 1000.0 * SPACING**3 / (0.5 * 1e5 * SPACING)
    depth = gravity * mass_over_stiffness  # m, under its own weight
    low, high = [0.2, 0.2, 0.2 - depth], [0.5, 0.5, 0.5 - depth]
    block = _block(low, high, velocity=[1.0, 0.0, 0.0], gravity=[0.0, 0.0, -gravity])
    clamp = [{"lowest": [0, 0, 0], "highest": [2, 1, 0], "directions": ["x", "y", "z"]}]
    slab = _slab([0, 0, 0], [1.6, 0.7, 0.2], fixed=clamp, integration="reduced")
    trace = _couple(tmp_path, block, slab, end, friction=mu)
    totals = trace.components["block"].totals()
    speed = totals.momentum / totals.mass
    assert (1.0 - speed[0]) / end == pytest.approx(mu * gravity, rel=0.02)
    impulse = gravity * end + speed[2]  # of the normal force, over the mass: the block bounces
    # Faces that deform under the block tilt their normals by up to a hundredth.
    assert 1.0 - speed[0] == pytest.approx(mu * impulse, rel=0.01)
    dissipated = 0.5 * totals.mass * (1.0 - speed[0] ** 2)
    assert totals.dissipated == pytest.approx(dissipated, rel=0.02)


def test_contact_in_a_plane_keeps_momentum(tmp_path):
    block = _block(
        [0.0, 0.0, GAP + 0.3], [0.3, 1.0, GAP + 0.6], velocity=[0.0, 0.0, -SPEED], dimensions=2
    )
    slab = _slab([0, 0, 0], [0.3, 1.0, 0.3], dimensions=2)
    slab["parts"][0]["elements"] = [3, 1, 3]
    trace = _couple(tmp_path, block, slab, 0.2)
    start = -SPEED * trace.components["block"].totals().mass
    assert trace.momentum()[2] == pytest.approx(start, rel=1e-12)
    assert trace.components["slab"].totals().momentum[2] < 0.5 * start


def test_a_saved_contact_goes_on_with_the_same_bits(tmp_path):
    trace = _impact(tmp_path, end=0.05, friction=0.3, side=SPEED)
    block = trace.components["block"]
    saved = {key: np.array(array) for key, array in block.save().items()}
    assert saved["contact/reaction"].any() and saved["contact/slip"].any()
    steps = []
    for _ in range(2):
        block.load(saved)
        steps.append(block.stable_dt())
        block.step(1e-3)
        steps.append(outputs_of(block))
    assert steps[0] == steps[2]
    for key, array in steps[1].items():
        np.testing.assert_array_equal(array, steps[3][key])


def test_the_window_is_the_predicted_step_once_contact_is_near(tmp_path):
    trace = _impact(tmp_path, end=0.05)
    block, slab = trace.components["block"], trace.components["slab"]
    penalty = block.faces.penalty
    squares = (2.0 / block.state.bound) ** 2, (2.0 / penalty.step_of_faces) ** 2
    square = highest_square(squares, (penalty.numbers.points, penalty.numbers.nodes))
    predicted = 0.9 * 2.0 / np.sqrt(square)
    assert block.stable_dt() == pytest.approx(min(predicted, 0.5 * block.state.bound))
    assert np.diff(trace.times)[2:].max() <= min(block.stable_dt(), slab.stable_dt()) * 1.0001


@pytest.mark.parametrize("stiffness", [1.0, 4.0])
def test_energy_is_kept_at_the_predicted_step(tmp_path, stiffness):
    # Both sides bear the step of contact.
    settings = {"friction": 0.3, "side": SPEED, "courant": 0.47}
    trace = _impact(tmp_path, safety=1.0, stiffness=stiffness, **settings)
    energy = trace.energy() + trace.components["block"].totals().dissipated
    assert energy == pytest.approx(trace.energies[0], rel=0.03)


def test_contact_breaks_down_beyond_the_predicted_step(tmp_path):
    # The prediction adds bounds of both solids and of contact: a bit less than the true limit.
    with pytest.raises(ComponentFailed, match="must"):
        _impact(tmp_path, safety=2.5, courant=9.0)


def test_the_particles_must_step_before_the_mesh(tmp_path):
    block = _block([0, 0, 0.6], [0.3, 0.3, 0.9], velocity=[0.0, 0.0, 0.0])
    with pytest.raises(SceneError, match="order must have block before slab for link slab-block"):
        _couple(tmp_path, block, _slab([0, 0, 0], [0.3, 0.3, 0.5]), 1.0, order=("slab", "block"))


def test_contact_says_what_is_missing(tmp_path):
    slab = _slab([0, 0, 0], [0.3, 0.3, 0.5])
    block = _block([0, 0, 0.6], [0.3, 0.3, 0.9], velocity=[0.0, 0.0, 0.0], contact_with_faces=False)
    with pytest.raises(
        SceneError, match="must take a port contact_faces: set contact_with_faces = true"
    ):
        _couple(tmp_path, block, slab, 1.0)
    flat = _block([0, 0, 0.6], [0.3, 1.0, 0.9], velocity=[0.0, 0.0, 0.0], dimensions=2)
    with pytest.raises(SceneError, match="two dimensions or both three; block has two, slab has"):
        _couple(tmp_path, flat, slab, 1.0)
    selection = {"lowest": [0, 0, 0], "highest": [1, 1, 0.7]}
    glued_block = _block([0, 0, 0.6], [0.3, 0.3, 0.9], velocity=[0.0, 0.0, 0.0], glued=[selection])
    with pytest.raises(SceneError, match="neither glued nor axisymmetric; found glued particles"):
        _couple(tmp_path, glued_block, slab, 1.0)
    with pytest.raises(SceneError, match=r"links.0.friction .* found -1"):
        maker("contact")(0, {"kind": "contact", "between": ["a", "b"], "friction": -1.0}, {})


def _sphere(height, velocity, **keys):
    body = {
        "shape": "sphere", "radius": SPACING, "centre": [0.3, 0.2, height], "density": 1000.0,
        "material": "rubber", "velocity": velocity,
    }  # fmt: skip
    rubber = {"youngs_modulus": 1e5, "poissons_ratio": 0.0, "restitution": 1.0, "friction": 0.0}
    materials = {"rubber": rubber}
    return {
        "kind": "dem_bodies", "bodies": [body], "materials": materials, "contact_with_faces": True,
        "gravity": [0.0, 0.0, 0.0], **keys,
    }  # fmt: skip


def test_a_sphere_bounces_off_elements_with_momentum_and_energy(tmp_path):
    sphere = _sphere(0.2 + SPACING + GAP, [0.3 * SPEED, 0.0, -SPEED])
    slab = _slab([0, 0, 0], [0.6, 0.4, 0.2], integration="reduced")
    trace = _couple(tmp_path, sphere, slab, 0.3, friction=0.3)
    mass = trace.components["block"].totals().mass
    start = mass * np.array([0.3 * SPEED, 0.0, -SPEED])
    assert np.abs(trace.momentum() - start).max() < 1e-12 * np.abs(start).max()
    assert trace.energy() == pytest.approx(trace.energies[0], rel=0.03)
    assert trace.components["block"].totals().momentum[2] > 0.0
    assert trace.components["block"].state.angular_velocity[0, 1] > 0.0  # it begins to roll


def test_a_sphere_that_slides_goes_on_to_roll(tmp_path):
    # Friction takes two sevenths of the velocity of a stiff sphere, whatever its coefficient. Of a
    # soft one v0 / (1 + 2/5 R²/L²) is left, with L from its centre to the face.
    weight = 1000.0 * 4.0 / 3.0 * np.pi * SPACING**3
    indentation = (weight / (4.0 / 3.0 * 0.5e5 * SPACING**0.5)) ** (2.0 / 3.0)  # m, by Hertz
    sphere = _sphere(0.2 + SPACING - indentation, [0.3, 0.0, 0.0], gravity=[0.0, 0.0, -1.0])
    clamp = [{"lowest": [0, 0, 0], "highest": [2, 1, 1], "directions": ["x", "y", "z"]}]
    slab = _slab([0, 0, 0], [1.2, 0.4, 0.2], fixed=clamp, integration="reduced")
    trace = _couple(tmp_path, sphere, slab, 1.2, friction=0.3)
    speed = trace.history("block", "motion.velocity")[:, 0, 0]
    spin = trace.history("block", "motion.angular_velocity")[:, 0, 1]
    lever, shear = SPACING - indentation, 0.125 * 1e5  # m; Pa, G* of both
    # It goes on to rock on its spring; two whole periods are averaged.
    stiffness = 8.0 * shear * (SPACING * indentation) ** 0.5
    rocking = stiffness * (1.0 + 2.5 * (lever / SPACING) ** 2) / weight  # weight: of 1 m/s2
    late = trace.times > 1.2 - 2.0 * 2.0 * np.pi / rocking**0.5
    rolling = 0.3 / (1.0 + 0.4 * (SPACING / lever) ** 2)
    assert speed[late].mean() == pytest.approx(rolling, rel=0.01)
    assert (spin[late] * lever).mean() == pytest.approx(rolling, rel=0.01)
