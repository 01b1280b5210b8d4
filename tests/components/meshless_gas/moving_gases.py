"""Gases that bodies with clouds of their own move through, small and fast."""

PRESSURE = 1.0 / 1.4  # Pa: the speed of sound is 1 m/s


def stream(speed):
    return {"density": 1.0, "pressure": PRESSURE, "velocity": [speed, 0.0, 0.0]}


AIR = {"gamma": 1.4, "gas_constant": PRESSURE}
STICKY = AIR | {"viscosity": 0.02, "reference_temperature": 1.0, "sutherland": 0.5}
LEAVES = {"kind": "outflow"}


def inflow(speed):
    return {"kind": "inflow", "state": stream(speed)}


CYLINDER = {
    "centre": [0.6, 0.0, 0.0],
    "radius": 0.4,
    "velocity": [-2.0, 0.0, 0.1],
    "points_around": 24,
    "thickness": 0.6,
    "spacing": 0.2,
}
# A cylinder flies through gas at rest.
IN_PLANE = {
    "gas": AIR,
    "neighbours": 8,
    "courant": 0.5,
    "box": {"lowest": [-2.4, 0.0, -1.6], "highest": [2.4, 0.0, 1.6], "spacing": 0.2},
    "boundaries": {"x-": inflow(0.0), "x+": inflow(0.0), "z-": {"kind": "slip"}, "z+": LEAVES},
    "initial": stream(0.0),
    "moving": {"bodies": [CYLINDER]},
}
# Two cylinders in a gas with friction: one turns and is warm, the other is adiabatic.
WARM = CYLINDER | {
    "centre": [-1.2, 0.0, 0.15], "velocity": [0.4, 0.0, 0.0], "angular_velocity": 0.7,
    "temperature": 1.2, "thickness": 0.5,
}  # fmt: skip
INSULATED = CYLINDER | {
    "centre": [1.2, 0.0, -0.15], "velocity": [-0.5, 0.0, 0.1], "is_adiabatic": True,
    "angular_velocity": -0.4, "thickness": 0.5,
}  # fmt: skip
STICKING = IN_PLANE | {
    "gas": STICKY,
    "viscous": True,
    "box": {"lowest": [-2.8, 0.0, -2.0], "highest": [2.8, 0.0, 2.0], "spacing": 0.2},
    "boundaries": {
        "x-": inflow(0.0), "x+": LEAVES, "z+": LEAVES,
        "z-": {"kind": "isothermal", "temperature": 1.1, "velocity": [0.2, 0.0, 0.0]},
    },
    "moving": {"bodies": [WARM, INSULATED]},
}  # fmt: skip
# The front of a sphere on an axis of symmetry, with friction; a smaller one flies towards it.
FRONT = {
    "centre": [0.0, 0.0, 0.0], "radius": 1.0, "points_around": 48, "sector": 1.5707963267948966,
    "thickness": 0.6, "spacing": 0.15, "first_spacing": 0.05, "first_spacing_at_sector": 0.06,
    "temperature": 2.0,
}  # fmt: skip
SMALL = {
    "centre": [-2.3, 0.0, 0.0], "radius": 0.2, "velocity": [1.0, 0.0, 0.0], "points_around": 24,
    "thickness": 0.3, "spacing": 0.15, "temperature": 2.0,
}  # fmt: skip
ON_AXIS = {
    "gas": STICKY,
    "viscous": True,
    "neighbours": 8,
    "courant": 0.5,
    "box": {"lowest": [-3.6, 0.0, 0.0], "highest": [0.0, 0.0, 2.4], "spacing": 0.15},
    "boundaries": {
        "x-": inflow(2.0),
        "x+": LEAVES,
        "z-": {"kind": "symmetry"},
        "z+": inflow(2.0),
    },
    "initial": stream(2.0),
    "moving": {"axisymmetric": True, "bodies": [FRONT, SMALL]},
}
# A sphere flies through a stream in space.
SPHERE_IN_SPACE = {
    "centre": [0.0, 0.0, 0.0], "radius": 0.4, "velocity": [-0.7, 0.1, 0.2], "points_around": 16,
    "thickness": 0.5, "spacing": 0.25,
}  # fmt: skip
THROUGH_SPACE = {
    "dimensions": 3,
    "gas": AIR,
    "courant": 0.4,
    "box": {"lowest": [-1.75, -1.5, -1.5], "highest": [1.5, 1.5, 1.5], "spacing": 0.25},
    "boundaries": {
        "x-": inflow(1.5), "x+": LEAVES,
        **{name: LEAVES for name in ("y-", "y+", "z-", "z+")},
    },
    "initial": stream(1.5),
    "moving": {"line_stencils": True, "fringe_order": 1, "bodies": [SPHERE_IN_SPACE]},
}  # fmt: skip
