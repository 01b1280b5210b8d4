"""A cube that is pushed through a fluid, on the processor and on a device."""

import numpy as np
from fluid_params import fluid_params

from quintet.components.shared.geometry.surface_samples_solid import box_images, fill_box
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Resources

JOINED = frozenset({"surface", "surface_load"})
DEVICE = Resources(device="opencl")
SPACING, EDGE, WIDTH, DEPTH = 0.05, 0.2, 0.5, 0.4  # m
START = np.array([0.25, 0.25, 0.25])  # m, centre of the cube
SPEED = np.array([0.1, 0.05, -0.4])  # m/s
LOADS = frozenset({"surface_load.force"})


def params_of(**changes):
    return fluid_params(
        **{
            "spacing": SPACING,
            "sound_speed": 20.0,
            "density_diffusion": 0.1,
            "fluid": (((0.0, 0.0, 0.0), (WIDTH, WIDTH, DEPTH)),),
            "viscosity__artificial": 0.1,
            "boundary__walls": ((0.0, 0.0, 0.0), (WIDTH, WIDTH, 0.7)),
            "boundary__lubrication_films": False,
        }
        | changes
    )


class Cube:
    """A cube of samples that moves through the fluid."""

    def __init__(self, share=1.0, start=START, speed=SPEED):
        size = np.full(3, EDGE)
        self.arm, self.normal, volume = fill_box(size, SPACING, 0.2)
        self.image = box_images(size, self.arm, self.normal)
        self.place, self.speed = start.copy(), speed
        self.static = {
            "surface.normal": self.normal,
            "surface.volume": share * volume,
            "surface.body": np.zeros(len(volume)),
        }

    def fields(self):
        return {
            "surface.position": self.place + self.arm,
            "surface.velocity": np.tile(self.speed, (len(self.arm), 1)),
            "surface.mirror": self.place + self.image,
        }

    def push(self, fluid, steps, dt=4e-4):
        """Advance a fluid with the cube; return the mean forces of all steps."""
        forces = []
        for _ in range(steps):
            fluid.take(self.fields())
            fluid.step(dt)
            forces.append(fluid.give(LOADS)["surface_load.force"])
            self.place = self.place + dt * self.speed
        return np.array(forces)


def join_cube(fluid, cube):
    fluid.bind(cube.static, JOINED)
    fluid.take(cube.fields())
    return fluid


def around(start=START, **changes):
    """Parameters of a fluid in which the cube has room."""
    (x, y, z), (u, v, w) = start - 0.5 * EDGE, start + 0.5 * EDGE
    boxes = (
        ((0.0, 0.0, 0.0), (x, WIDTH, DEPTH)),
        ((u, 0.0, 0.0), (WIDTH, WIDTH, DEPTH)),
        ((x, 0.0, 0.0), (u, y, DEPTH)),
        ((x, v, 0.0), (u, WIDTH, DEPTH)),
        ((x, y, w), (u, v, DEPTH)),
    )
    below = ((x, y, 0.0), (u, v, z))
    return params_of(fluid=(*boxes, below) if z > SPACING else boxes, **changes)


MIRRORED, DYNAMIC = {"boundary__method": "mdbc"}, {"boundary__method": "dbc"}


def pair(changes, start=START, share=1.0, resources=DEVICE):
    """The same fluid on the processor and on a device, each with a cube."""
    # Loads pyopencl.
    from quintet.components.sph_fluid.opencl.device_fluid import DeviceFluid

    params = around(start, **changes)
    fluids = SphFluid(params), DeviceFluid(params, resources)
    return tuple(
        (join_cube(fluid, cube), cube)
        for fluid, cube in ((fluid, Cube(share, start)) for fluid in fluids)
    )


def require_close(processor, device, limit=1e-11):
    first, second = processor.save(), device.save()
    assert first.keys() == second.keys()
    assert np.array_equal(first["sample"], second["sample"])  # sorted alike
    for key in ("position_density", "reference", "mirror_point", "film"):
        largest = np.abs(first[key]).max(initial=1e-300)
        assert np.abs(first[key] - second[key]).max(initial=0.0) <= limit * largest, key
