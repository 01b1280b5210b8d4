"""The ports of a fluid: surfaces that move in it, the loads on them, and its gauges."""

import math
from dataclasses import replace

import numpy as np

from quintet.components.sph_fluid.boundary.planar import planar_surface
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.component import Array, Field, Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import (
    MIRRORED_SURFACE,
    STILL_WATER,
    SURFACE,
    SURFACE_LOAD,
    VELOCITY,
)

PRESSURE = Port("pressure_gauge", (Field("pressure", (), "Pa"),))
LEVEL = Port("level_gauge", (Field("height", (), "m"),))
VELOCITY_GAUGE = Port("velocity_gauge", (Field("velocity", (3,), "m/s"),))
DISCHARGE = Port("discharge_gauge", (Field("discharge", (), "m3/s"),))
FRONT = Port("front_gauge", (Field("position", (), "m"),))
MOTION = Port(
    "motion_gauge",
    (
        Field("speed", (), "m/s"),  # of the fastest particle
        Field("kinetic", (), "J"),
        Field("potential", (), "J"),  # of gravity, zero at the origin
        Field("centre", (3,), "m"),  # of mass
    ),
)
MASS = Port(
    "mass_gauge",
    (
        Field("mass", (), "kg"),  # there now
        Field("entered", (), "kg"),  # by inflows
        Field("left", (), "kg"),  # by outflows, or back into inflows
        Field("lost", (), "kg"),  # far outside of the tank, or removed inside bodies
        Field("imbalance", (), "kg"),  # there, less what that at the start and these come to
    ),
)
# Static field of the samples of surfaces, from links that choose what presses on them: 0 what does
# at walls, 1 a contact potential.
CONTACT = Field("contact", (), "1")
# Of the view: the fluid's particles.
SHOWS = (VELOCITY, Field("density", (), "kg/m3"), Field("pressure", (), "Pa"))


def ports(params: SphFluidParams) -> Ports:
    """Ports that a fluid takes, and those that it gives."""
    return (surface(params),), (SURFACE_LOAD, *gauges(params))


def surface(params: SphFluidParams) -> Port:
    """Port as the boundary asks for it; it lets links choose their contact where that can be.

    Dynamic boundary particles know no other contact; films know no potential.
    """
    port = MIRRORED_SURFACE if params.mirrored else SURFACE
    if params.dimensions == 2:
        port = planar_surface(port)
    fixed = params.boundary.method == "dbc" or params.boundary.lubrication_films is True
    return port if fixed else replace(port, static=(*port.static, CONTACT))


def gauges(params: SphFluidParams) -> tuple[Port, ...]:
    """Ports of the gauges that are switched on."""
    switched = (
        (PRESSURE, bool(params.gauges.pressure_gauges)),
        (LEVEL, bool(params.gauges.level_gauges)),
        (VELOCITY_GAUGE, bool(params.gauges.velocity_gauges)),
        (DISCHARGE, bool(params.gauges.discharge_gauges)),
        (FRONT, params.gauges.front_gauge is not None),
        (MOTION, params.gauges.motion_gauge),
        (MASS, params.gauges.mass_gauge),
    )
    return tuple(port for port, on in switched if on)


def requests(params: SphFluidParams) -> dict[str, Array]:
    """How the port `surface` is to be sampled: spacing, depth and inset of samples."""
    values = {
        "spacing": params.spacing,
        "depth": sample_reach(params),
        "inset": params.boundary.sample_depth * params.spacing,
    }
    if params.dimensions == 2:
        values["dimensions"] = 2.0
    return {f"surface.{name}": np.array([value]) for name, value in values.items()}


def still_water(params: SphFluidParams) -> dict[str, Array]:
    """The box of water that is removed inside bodies, and its density; nothing of other water."""
    x, y, z = params.hydrostatic_gravity
    is_box = params.dimensions == 3 and len(params.fluid) == len(params.boxes) == 1
    if not (params.remove_inside_bodies and is_box and x == y == 0.0 and z < 0.0):
        return {}
    values = (*params.boxes[0], params.density)
    return {
        field.name: np.array([value], np.float64)
        for field, value in zip(STILL_WATER, values, strict=True)
    }


def sample_reach(params: SphFluidParams) -> float:
    """How far [m] samples reach below the outermost: as the kernel does, or all through a body."""
    reach = 2.0 * params.smoothing_length
    if not params.remove_inside_bodies:
        return reach
    # The volume of the samples says how much fluid the body displaces.
    return max(reach, *(math.dist(low, high) for low, high in params.extents))
