"""Toys for the laws of the contract, and a case of each."""

import numpy as np

from quintet.interfaces.manifest import ConformCase

SQUARE = np.array([[0.1 * i, 0.1 * j, 0.0] for i in range(3) for j in range(3)])
STILL = np.zeros_like(SQUARE)
ONE, TWO = np.zeros((1, 3)), np.zeros((2, 3))
SPRING = {"mass": 2.0, "stiffness": 50.0, "arm": [0.0, 0.0, 1.0], "start": [0.0, 0.0, 1.0]}
UPRIGHT = np.tile([1.0, 0.0, 0.0, 0.0], (2, 1))

CASES = {  # kind -> case
    "quintet.scenarios.two_springs.springs:Mass": ConformCase(
        "mass",
        SPRING,
        rest={"load.force": ONE, "foot.position": ONE, "foot.velocity": ONE},
        scale={"load.force": 5.0, "foot.position": 0.1},
    ),
    "toy_chains:Column": ConformCase(
        "column",
        {"layers": 5},
        static={"node_load.added_mass": np.full(20, 0.1)},
        rest={"node_load.force": np.zeros((20, 3))},
        scale={"node_load.force": 1.0},
    ),
    "toy_chains:Rods": ConformCase(
        "rods",
        {"count": 5},
        rest={"glued.velocity": np.zeros((4, 3))},
        scale={"glued.velocity": 1.0},
    ),
    "toy_plates:Plate": ConformCase(
        "plate",
        {},
        rest={"node_load.force": np.zeros((12, 3))},
        scale={"node_load.force": 1.0},
    ),
    "toy_plates:Gust": ConformCase(
        "gust",
        {"pressure": 0.0},
        static={
            "surface.normal": np.tile([0.0, 0.0, 1.0], (9, 1)),
            "surface.volume": np.full(9, 1e-3),
            "surface.body": np.zeros(9),
        },
        rest={"surface.position": SQUARE, "surface.velocity": STILL},
        scale={"surface.velocity": 1.0},
    ),
    "toy_points:Pucks": ConformCase(
        "pucks",
        {"velocities": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]},
        rest={"breath.force": TWO, "breath.heat": np.zeros(2)},
        scale={"breath.force": 1.0, "breath.heat": 1.0},
        forces=("breath.force",),
    ),
    "toy_points:Air": ConformCase(
        "air",
        {"count": 2},
        rest={"flight.position": TWO, "flight.velocity": TWO},
        scale={"flight.velocity": 1.0},
        forces=("breath.force",),
    ),
    "toy_points:Swing": ConformCase(
        "swing", {"start": 0.0}, rest={"lump.force": ONE}, scale={"lump.force": 1.0}
    ),
    "toy_points:Burden": ConformCase(
        "burden",
        {},
        rest={"carried.velocity": ONE},
        scale={"carried.velocity": 1.0},
        smooth=False,  # a jump of velocity is an infinite force
        forces=("lump.force",),
    ),
    "toy_tubes:Membrane": ConformCase(
        "membrane",
        {"count": 2, "height": 0.0},
        rest={"pressure.force": TWO},
        scale={"pressure.force": 0.1},
    ),
    "toy_tubes:Channel": ConformCase(
        "channel",
        {"count": 2},
        rest={"wall.velocity": TWO},
        scale={"wall.velocity": 1.0},
        smooth=False,  # as of the burden
        forces=("pressure.force",),
    ),
    "toy_bodies:Balls": ConformCase(
        "balls",
        {"velocities": [[0.0, 0.0, 0.0]] * 2, "spins": [[0.0, 0.0, 0.0]] * 2},
        rest={"load.force": TWO, "load.torque": TWO},
        scale={"load.force": 1.0, "load.torque": 1.0},
        forces=("load.force",),
    ),
    "toy_bodies:Wind": ConformCase(
        "wind",
        {},
        rest={
            "body.position": TWO,
            "body.velocity": TWO,
            "body.orientation": UPRIGHT,
            "body.angular_velocity": TWO,
        },
        scale={"body.velocity": 1.0, "body.orientation": 1.0},
        still=False,  # it blows
    ),
    "toy_heat:Slab": ConformCase(
        "slab", {}, rest={"node_heat.heat_flow": np.zeros(4)}, scale={"node_heat.heat_flow": 10.0}
    ),
    "toy_heat:Wall": ConformCase(
        "wall",
        {"noise": 0.1},
        rest={"wall_temperature.temperature": np.full(4, 300.0)},
        scale={"wall_temperature.temperature": 10.0},
        smooth=False,  # noise of its own in every step
    ),
}
