"""Properties of material pairs, and the impacts that a scene expects, before any run."""

from collections.abc import Sequence
from itertools import product

import numpy as np

from quintet.components.dem_bodies.contact import materials
from quintet.components.dem_bodies.params import DemBodiesParams, Material
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.dem_bodies.shapes.solid import (
    Solid,
    contact_radii,
    largest_inverse_effective_mass,
)
from quintet.interfaces.component import Array


def material_pairs(params: DemBodiesParams) -> Array:
    """Table (materials, materials, 5) of E* [Pa], G* [Pa], ζ, μ and μ_r."""
    names = list(params.materials)
    table = np.zeros((len(names), len(names), 5))
    for (i, a), (j, b) in product(enumerate(params.materials.values()), repeat=2):
        table[i, j] = material_pair(a, b)
    for pair in params.pairs:
        i, j = (names.index(name) for name in pair.between)
        if pair.restitution is not None:
            table[i, j, 2] = table[j, i, 2] = materials.damping_ratio(pair.restitution)
        if pair.friction is not None:
            table[i, j, 3] = table[j, i, 3] = pair.friction
        if pair.rolling_friction is not None:
            table[i, j, 4] = table[j, i, 4] = pair.rolling_friction
    return table


def material_pair(a: Material, b: Material) -> Array:
    """E* [Pa], G* [Pa], ζ, μ and μ_r of two materials: the lower of both where they differ."""
    moduli, ratios = (a.youngs_modulus, b.youngs_modulus), (a.poissons_ratio, b.poissons_ratio)
    return np.array(
        [
            materials.effective_modulus(moduli, ratios),
            materials.effective_shear(moduli, ratios),
            materials.damping_ratio(min(a.restitution, b.restitution)),
            min(a.friction, b.friction),
            min(a.rolling_friction, b.rolling_friction),
        ]
    )


def expected_frequency(
    params: DemBodiesParams, bodies: Sequence[RigidBody], solids: Sequence[Solid]
) -> float:
    """Bound of √(S_n/m*) [rad/s] in impacts at the expected speed.

    For each material the lightest contact and the largest radius are taken, though they may be
    of different bodies.
    """
    table, names = material_pairs(params)[:, :, 0], list(params.materials)
    lightest, largest = np.zeros(len(names)), np.zeros(len(names))
    for body, solid in zip(bodies, solids, strict=True):
        k = names.index(body.material)
        lightest[k] = max(lightest[k], largest_inverse_effective_mass(solid))
        largest[k] = max(largest[k], contact_radii(body, solid).max())
    boxes = any(body.shape in ("box", "polygon") for body in bodies)
    frequencies, used = [], [int(k) for k in np.flatnonzero(lightest)]
    for i in used:
        impacts = [(names.index(plane.material), largest[i], 0.0) for plane in params.planes]
        for j in used:
            radius = 1.0 / (1.0 / largest[i] + 1.0 / largest[j])
            if boxes:  # a sphere on a box's face has its own radius
                radius = max(largest[i], largest[j])
            impacts.append((j, radius, lightest[j]))
        for j, radius, inverse_mass in impacts:
            mass = 1.0 / (lightest[i] + inverse_mass)
            frequencies.append(
                materials.impact_frequency(table[i, j], radius, mass, params.impact_speed)
            )
    return float(max(frequencies))
