"""Clouds round bodies, as a scene describes them."""

import math

import numpy as np

from quintet.components.meshless_gas.clouds.cap import sphere_cap
from quintet.components.meshless_gas.clouds.layers import LayeredCloud, Sides
from quintet.components.meshless_gas.clouds.meridian import Reach, SphereInStream, sphere_meridian
from quintet.components.meshless_gas.clouds.mirrored import as_slip, mirrored
from quintet.components.meshless_gas.clouds.params import Layers, PlateCloud, SphereCloud
from quintet.components.meshless_gas.clouds.plane import plate
from quintet.components.meshless_gas.params import MeshlessGasParams


def layered_cloud(params: MeshlessGasParams, sides: Sides) -> LayeredCloud:
    """Nodes in layers over a sphere or a plate."""
    if sides.kinds["wall"] == "symmetry":
        slipping = layered_cloud(params, sides._replace(kinds=as_slip(sides.kinds)))
        return mirrored(slipping, sides.patches["wall"])
    if params.plate is not None:
        return _plate(params.plate, sides)
    assert params.sphere is not None
    far = params.boundaries["far"].state
    assert far is not None
    make = sphere_cap if params.dimensions == 3 else sphere_meridian
    keys = params.sphere
    sphere = SphereInStream(np.array(keys.centre), keys.radius, far.mach(params.gas))
    return make(sphere, _reach(keys), sides)


def _reach(sphere: SphereCloud) -> Reach:
    return _of(
        sphere.layers,
        sphere.points_around,
        min(sphere.sector, math.pi),
        sphere.margin,
        sphere.reach,
    )


def _plate(keys: PlateCloud, sides: Sides) -> LayeredCloud:
    reach = _of(keys.layers, keys.points_along, 0.0, 1.0, 0.0)
    return plate(reach, keys.length, keys.ahead, keys.height, keys.finest, sides)


def _of(layers: Layers, rays: int, sector: float, margin: float, farthest: float) -> Reach:
    return Reach(
        rays=rays,
        layers=layers.count,
        first=layers.first_spacing or math.inf,
        sector=sector,
        margin=margin,
        farthest=farthest,
        jitter=layers.jitter,
        seed=layers.seed,
        weight=layers.weight,
        is_cross=layers.line_stencils,
    )
