"""What the laws of the contract are tried on: a drop without weight, two samples at its side."""

from typing import Any

import numpy as np

from quintet.interfaces.component import Fields
from quintet.interfaces.manifest import ConformCase

DROP: dict[str, Any] = {
    "boundary": {"method": "dbc"},
    "spacing": 0.05,
    "sound_speed": 20.0,
    "gravity": [0.0, 0.0, 0.0],
    "fluid": [{"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [0.2, 0.2, 0.2]}],
}
ROLLING = {
    "method": "mdbc",
    "walls": {"shape": "box", "lowest": [-0.1, -0.1, -0.1], "highest": [0.3, 0.3, 0.3]},
    "motion": {"period": 0.5, "angle_amplitude": 0.2, "ramp": 0.1, "axis": [0.0, 1.0, 0.0]},
}
PUSH = {"times": [0.0, 10.0], "displacement": [[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]]}
PUSHED = {
    "method": "mdbc",
    "walls": ROLLING["walls"],
    "pistons": [{"part": "walls.x-", "motion": PUSH}],
}
MIRRORED = {
    "boundary": {"method": "mdbc", "lubrication_films": True},
    "density_diffusion": 0.1,
    "negative_pressure": True,
}
GAUGES = {"motion_gauge": True, "front_gauge": "x", "pressure_gauges": [[0.1, 0.1, 0.1]]}
CHANNEL: dict[str, Any] = {
    "spacing": 0.05,
    "sound_speed": 20.0,
    "dimensions": 2,
    "gravity": [0.0, 0.0, 0.0],
    "negative_pressure": True,
    "fluid": [{"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [1.5, 1.0, 0.4]}],
    "boundary": {
        "walls": {"lowest": [0.0, 0.0, 0.0], "highest": [1.5, 1.0, 0.4]},
        "open_faces": ["x-", "x+"],
        "inflow": [{"face": "x-", "speed": 2.0}],
        "outflow": [{"face": "x+"}],
    },
    "initial": {"velocity": [2.0, 0.0, 0.0]},
    "gauges": {
        "mass_gauge": True,
        "velocity_gauges": [[0.75, 0.5, 0.2]],
        "discharge_gauges": [0.75],
    },
}
REPEATED = DROP | {
    "boundary": {
        "method": "dbc",
        "walls": DROP["fluid"][0] | {"highest": [0.4, 0.4, 0.4]},
        "periodic": ["x"],
        "open_faces": ["y-", "y+", "z-", "z+"],
    }
}
FLUME: dict[str, Any] = {
    "spacing": 0.02,
    "sound_speed": 14.1,
    "dimensions": 2,
    "fluid": [{"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [0.4, 1.0, 0.2]}],
    "boundary": {
        "walls": {"lowest": [-0.2, 0.0, 0.0], "highest": [0.4, 1.0, 0.4]},
        "obstacles": [{"lowest": [-0.1, 0.0, 0.0], "highest": [0.0, 1.0, 0.4]}],
        "pistons": [
            {
                "part": "obstacles.0",
                "waves": {
                    "paddle": "piston",
                    "depth": 0.2,
                    "height": 0.08,
                    "period": 1.0,
                    "ramp": 0.01,
                    "absorption": True,
                },
            }
        ],
        "damping": [{"lowest": [0.2, 0.0, 0.0], "highest": [0.4, 1.0, 0.4], "towards": "x+"}],
    },
}
PLACES = np.array([[0.1, 0.1, -0.05], [0.15, 0.1, -0.05]])  # (2, 3) m, of the samples


def cases() -> tuple[ConformCase, ...]:
    """Walls of either kind, both integrators, gauges, two dimensions, pistons, waves, flows."""
    twice = {**DROP, "integration": "symplectic"}
    box = {"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [0.2, 1.0, 0.2]}
    slab = {**DROP, "dimensions": 2, "fluid": [box]}
    return (
        _case("drop", DROP),
        _case("drop, mirrored walls and films", {**DROP, **MIRRORED}, mirror=True),
        _case("drop, symplectic, with gauges", {**twice, "gauges": GAUGES}),
        _case("drop in two dimensions", slab, volume=2.5e-3),
        ConformCase("drop in a tank that rolls", {**DROP, "boundary": ROLLING}, dt=1e-4),
        ConformCase("drop beside a piston", {**DROP, "boundary": PUSHED}, dt=1e-4),
        _case("drop in a tank that repeats", REPEATED | {"gauges": {"mass_gauge": True}}),
        ConformCase("channel with inflow and outflow", CHANNEL, dt=1e-4, still=False),
        ConformCase("flume with a wave maker", FLUME, dt=1e-4, still=False),
        *on_devices(),
    )


def on_devices() -> tuple[ConformCase, ...]:
    """Kinds of walls on a device, where there is one, with and without samples; flows."""
    # Loads pyopencl where it is installed; these cases alone ask for it.
    from quintet.components.shared.opencl.devices import is_any_there

    if not is_any_there():
        return ()
    walls = {"walls": ROLLING["walls"]}
    mirrored = DROP | MIRRORED | {"boundary": walls | {"method": "mdbc"}, "gauges": GAUGES}
    dynamic = DROP | {"boundary": walls | {"method": "dbc"}}
    potential = DROP | {"boundary": {"method": "potential"}}
    tables = {"mirrored": mirrored, "dynamic": dynamic}
    walls_alone = (
        ConformCase(f"drop between {name} walls, OpenCL", table, dt=1e-4, device="opencl")
        for name, table in tables.items()
    )
    return (
        *walls_alone,
        ConformCase(
            "channel with inflow and outflow, OpenCL",
            CHANNEL,
            dt=1e-4,
            still=False,
            device="opencl",
        ),
        _case("drop in a tank that repeats, OpenCL", REPEATED, device="opencl"),
        _case("drop, contact potential, OpenCL", potential, device="opencl"),
        _case("drop, OpenCL", DROP, device="opencl"),
        _case("drop, mirrored walls and films, OpenCL", DROP | MIRRORED, True, device="opencl"),
    )


def _case(
    name: str,
    params: dict[str, Any],
    mirror: bool = False,
    volume: float = 1.25e-4,
    device: str = "cpu",
) -> ConformCase:
    static: Fields = {
        "surface.normal": np.tile([0.0, 0.0, 1.0], (2, 1)),
        "surface.volume": np.full(2, volume),
        "surface.body": np.arange(2.0) if mirror else np.zeros(2),
    }
    rest = {"surface.position": PLACES, "surface.velocity": np.zeros((2, 3))}
    return ConformCase(
        name,
        params,
        static=static,
        rest=rest | ({"surface.mirror": PLACES} if mirror else {}),
        scale={"surface.velocity": 1.0},
        dt=1e-4,
        forces=("surface_load.force",),
        device=device,
    )
