"""The components that the contract is tried on, and what each needs to be tried."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.files.recording import Instant, Recorder
from quintet.interfaces.component import Array, Component, Fields, Resources, make
from quintet.interfaces.manifest import find
from quintet.interfaces.params import read
from quintet.interfaces.ports import MOTION

SQUARE = np.array([[0.1 * i, 0.1 * j, 0.0] for i in range(3) for j in range(3)])
STILL = np.zeros_like(SQUARE)


@dataclass
class Case:
    """A component, how it is joined, and inputs under which nothing happens."""

    kind: str  # an installed kind, or module:Class
    params: dict[str, Any] | Callable[[Path], dict[str, Any]]
    static: dict[str, Array] = field(default_factory=dict)  # of the partner, as bind gets it
    rest: dict[str, Array] = field(default_factory=dict)  # inputs under which it stays as it is
    scale: dict[str, float] = field(default_factory=dict)  # inputs that move it, per field
    dt: float = 1e-3  # s
    still: bool = True  # whether it stays as it is at rest
    smooth: bool = True  # whether two half steps come ever nearer to one
    any_time: bool = True  # whether it can give after any step

    def build(self, tmp_path: Path) -> Component:
        """Make one, and join it."""
        manifest = find(self.kind)
        table = self.params(tmp_path) if callable(self.params) else self.params
        params, mistakes = read(manifest.params, table, self.kind)
        assert not mistakes
        component = make(manifest.load(), params, Resources(folder=tmp_path))
        assert (component.takes, component.gives) == tuple(manifest.ports(params))
        component.describe()
        joined = frozenset(port.name for port in (*component.takes, *component.gives))
        component.bind(frozen(self.static), joined)
        return component

    def inputs(self, seed: int | None = None) -> Fields:
        """Inputs at rest, or with something random on top."""
        random = np.random.default_rng(seed or 0)
        fields = {key: np.array(array) for key, array in self.rest.items()}
        for key, scale in self.scale.items() if seed is not None else ():
            fields[key] += scale * random.normal(size=fields[key].shape)
        return frozen(fields)


def frozen(fields: Fields) -> dict[str, Array]:
    """Copies that cannot be written to, as they come over a line."""
    copies = {key: np.array(array) for key, array in fields.items()}
    for array in copies.values():
        array.flags.writeable = False
    return copies


def _recorded(tmp_path):
    random = np.random.default_rng(3)
    with Recorder(tmp_path / "recording.h5", "run", "", 0.01) as recorder:
        recorder.component("cubes", (MOTION,), {"motion.mass": np.ones(2)})
        for row in range(8):
            fields = {f"motion.{f.name}": random.normal(size=(2, *f.shape)) for f in MOTION.fields}
            recorder.add("cubes", Instant(0.01 * row, row, 0.01), fields)
    return {"recording": str(tmp_path), "component": "cubes"}


BODY = {"shape": "box", "size": [0.1, 0.1, 0.1], "position": [1.0, 2.0, 3.0]}
SPRING = {"mass": 2.0, "stiffness": 50.0, "arm": [0.0, 0.0, 1.0], "start": [0.0, 0.0, 1.0]}
ONE, TWO = np.zeros((1, 3)), np.zeros((2, 3))

# A drop without weight, with two samples at its side.
DROP = {
    "spacing": 0.05,
    "sound_speed": 20.0,
    "gravity": [0.0, 0.0, 0.0],
    "fluid": [[[0.0, 0.0, 0.0], [0.2, 0.2, 0.2]]],
}
BESIDE = np.array([[0.1, 0.1, -0.05], [0.15, 0.1, -0.05]])
# Two boxes without weight that hover over a floor.
STUFF = {"youngs_modulus": 1e7, "poissons_ratio": 0.3, "restitution": 0.5, "friction": 0.4}
FLOAT = {**BODY, "density": 500.0, "material": "wood"}
BALL = {"shape": "sphere", "diameter": 0.1, "density": 500.0, "material": "wood"}
BOXES = {
    "gravity": [0.0, 0.0, 0.0],
    "materials": {"wood": STUFF},
    "bodies": [FLOAT, {**FLOAT, "position": [1.0, 2.0, 3.2]}],
    "planes": [{"point": [0.0, 0.0, 2.9], "normal": [0.0, 0.0, 1.0], "material": "wood"}],
}

# A wedge that hovers there in two dimensions, and a wheel over it.
WEDGE = {
    "shape": "polygon",
    "corners": [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]],
    "density": 500.0,
    "material": "wood",
    "position": [1.0, 2.0, 3.0],
}
WHEEL = {**BALL, "shape": "disc"}

CASES = {
    "sph_fluid": Case(
        "sph_fluid",
        DROP,
        static={
            "surface.normal": np.tile([0.0, 0.0, 1.0], (2, 1)),
            "surface.volume": np.full(2, 1.25e-4),
            "surface.body": np.zeros(2),
        },
        rest={"surface.position": BESIDE, "surface.velocity": TWO},
        scale={"surface.velocity": 1.0},
        dt=1e-4,
    ),
    "sph_fluid, mirrored": Case(
        "sph_fluid",
        {
            **DROP,
            "boundary": {"method": "mdbc", "lubrication_films": True},
            "density_diffusion": 0.1,
            "negative_pressure": True,
        },
        static={
            "surface.normal": np.tile([0.0, 0.0, 1.0], (2, 1)),
            "surface.volume": np.full(2, 1.25e-4),
            "surface.body": np.array([0.0, 1.0]),
        },
        rest={"surface.position": BESIDE, "surface.velocity": TWO, "surface.mirror": BESIDE},
        scale={"surface.velocity": 1.0},
        dt=1e-4,
    ),
    "sph_fluid, two dimensions": Case(
        "sph_fluid",
        {**DROP, "dimensions": 2, "fluid": [[[0.0, 0.0, 0.0], [0.2, 1.0, 0.2]]]},
        static={
            "surface.normal": np.tile([0.0, 0.0, 1.0], (2, 1)),
            "surface.volume": np.full(2, 2.5e-3),
            "surface.body": np.zeros(2),
        },
        rest={"surface.position": BESIDE, "surface.velocity": TWO},
        scale={"surface.velocity": 1.0},
        dt=1e-4,
    ),
    "dem_bodies, spheres": Case(
        "dem_bodies",
        {**BOXES, "bodies": [{**BALL, "position": [1.0, 2.0, z]} for z in (3.0, 3.15)]},
        rest={"load.force": TWO, "load.torque": TWO},
        scale={"load.force": 1.0, "load.torque": 0.1},
        dt=1e-4,
    ),
    "dem_bodies": Case(
        "dem_bodies",
        BOXES,
        rest={"load.force": TWO, "load.torque": TWO},
        scale={"load.force": 1.0, "load.torque": 0.1},
        dt=1e-4,
    ),
    "dem_bodies, contact forces": Case(
        "dem_bodies",
        {**BOXES, "contact_forces": True},
        rest={"load.force": TWO, "load.torque": TWO},
        scale={"load.force": 1.0, "load.torque": 0.1},
        dt=1e-4,
    ),
    "dem_bodies, two dimensions": Case(
        "dem_bodies",
        {**BOXES, "dimensions": 2, "bodies": [WEDGE, {**WHEEL, "position": [1.0, 2.0, 3.12]}]},
        rest={"load.force": TWO, "load.torque": TWO},
        scale={"load.force": 1.0, "load.torque": 0.1},
        dt=1e-4,
    ),
    "echo": Case(
        "echo", {"items": 4}, rest={"passed.value": np.zeros((4, 3))}, scale={"passed.value": 1.0}
    ),
    "prescribed": Case("prescribed", {"bodies": [BODY]}),
    "prescribed, moving": Case(
        "prescribed",
        {"bodies": [{**BODY, "velocity": [1.0, 0.0, 0.0], "angular_velocity": [0.0, 2.0, 1.0]}]},
        still=False,
    ),
    "replay": Case("replay", _recorded, dt=0.01, still=False, any_time=False),
    "spring": Case(
        "quintet.scenarios.two_springs.springs:Mass",
        SPRING,
        rest={"load.force": ONE, "foot.position": ONE, "foot.velocity": ONE},
        scale={"load.force": 5.0, "foot.position": 0.1},
    ),
    "column": Case(
        "toy_chains:Column",
        {"layers": 5},
        static={"node_load.added_mass": np.full(20, 0.1)},
        rest={"node_load.force": np.zeros((20, 3))},
        scale={"node_load.force": 1.0},
    ),
    "rods": Case(
        "toy_chains:Rods",
        {"count": 5},
        rest={"glued.velocity": np.zeros((4, 3))},
        scale={"glued.velocity": 1.0},
    ),
    "plate": Case(
        "toy_plates:Plate",
        {},
        rest={"node_load.force": np.zeros((12, 3))},
        scale={"node_load.force": 1.0},
    ),
    "gust": Case(
        "toy_plates:Gust",
        {"pressure": 0.0},
        static={
            "surface.normal": np.tile([0.0, 0.0, 1.0], (9, 1)),
            "surface.volume": np.full(9, 1e-3),
            "surface.body": np.zeros(9),
        },
        rest={"surface.position": SQUARE, "surface.velocity": STILL},
        scale={"surface.velocity": 1.0},
    ),
    "pucks": Case(
        "toy_points:Pucks",
        {"velocities": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]},
        rest={"breath.force": TWO, "breath.heat": np.zeros(2)},
        scale={"breath.force": 1.0, "breath.heat": 1.0},
    ),
    "air": Case(
        "toy_points:Air",
        {"count": 2},
        rest={"flight.position": TWO, "flight.velocity": TWO},
        scale={"flight.velocity": 1.0},
    ),
    "swing": Case(
        "toy_points:Swing", {"start": 0.0}, rest={"lump.force": ONE}, scale={"lump.force": 1.0}
    ),
    "burden": Case(
        "toy_points:Burden",
        {},
        rest={"carried.velocity": ONE},
        scale={"carried.velocity": 1.0},
        smooth=False,  # a velocity that jumps is a force without end
    ),
    "membrane": Case(
        "toy_tubes:Membrane",
        {"count": 2, "height": 0.0},
        rest={"pressure.force": TWO},
        scale={"pressure.force": 0.1},
    ),
    "channel": Case(
        "toy_tubes:Channel",
        {"count": 2},
        rest={"wall.velocity": TWO},
        scale={"wall.velocity": 1.0},
        smooth=False,  # as of the burden
    ),
    "balls": Case(
        "toy_bodies:Balls",
        {"velocities": [[0.0, 0.0, 0.0]] * 2, "spins": [[0.0, 0.0, 0.0]] * 2},
        rest={"load.force": TWO, "load.torque": TWO},
        scale={"load.force": 1.0, "load.torque": 1.0},
    ),
}
