"""Bodies in a fluid on an OpenCL device move and are pushed as on the processor."""

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.shared.geometry.surface_samples_solid import box_images, fill_box
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import OrderError, SceneError

pytest.importorskip("pyopencl")
from quintet.components.shared.opencl.devices import Device
from quintet.components.sph_fluid.opencl.device_fluid import DeviceFluid

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
LOW = np.array([0.25, 0.25, 0.12])  # m, with a narrow gap below it
FILMS = MIRRORED | {"boundary__lubrication_films": True}


def pair(changes, start=START, share=1.0, resources=DEVICE):
    """The same fluid on the processor and on a device, each with a cube."""
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


CASES = [
    (MIRRORED, START, 1.0),
    (DYNAMIC, START, 1.0),
    (MIRRORED | {"kernel": "quintic"}, START, 0.8),
    (FILMS, LOW, 1.0),
    (FILMS | {"boundary__lubrication_films": "auto"}, LOW, 1.0),
    (FILMS | {"integration": "symplectic"}, LOW, 1.0),
    (MIRRORED | {"viscosity__kinematic": 0.05}, START, 1.0),
]


@pytest.mark.parametrize(("changes", "start", "share"), CASES)
def test_a_body_is_pushed_as_on_the_processor(changes, start, share):
    (processor, first), (device, second) = pair(changes, start, share)
    expected, computed = first.push(processor, 80), second.push(device, 80)
    assert np.abs(computed - expected).max() < 1e-9 * np.abs(expected).max()
    require_close(processor, device)
    assert (processor.state.film != 0.0).any() == ("lubrication_films" in str(changes))
    assert processor.state.moved < 80 * 4e-4 * np.linalg.norm(SPEED)  # lists were made again


def test_a_device_that_is_no_processor_pushes_bodies_too(monkeypatch):
    monkeypatch.setattr(Device, "is_processor", property(lambda self: False))
    (processor, first), (device, second) = pair(MIRRORED, share=0.8)
    expected, computed = first.push(processor, 30), second.push(device, 30)
    assert np.abs(computed - expected).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("changes", [MIRRORED, DYNAMIC])
def test_bodies_gain_the_momentum_that_the_fluid_loses(changes):
    no_weight = {"boundary__walls": None, "gravity": [0.0, 0.0, 0.0]}
    params, cube = around(**(changes | no_weight)), Cube()
    device = join_cube(DeviceFluid(params, DEVICE), cube)
    cube.push(device, 5)
    before, dt = device.totals().momentum, 4e-4
    impulse = dt * cube.push(device, 20, dt).sum(axis=(0, 1))
    gained = device.totals().momentum - before
    assert np.abs(impulse).max() > 1e-3
    assert np.abs(impulse + gained).max() < 1e-13 * np.abs(before).max()


def test_bodies_are_pushed_with_the_same_bits_on_any_number_of_threads():
    params, results = around(**FILMS), []
    for threads in (1, 2):
        cube = Cube()
        fluid = join_cube(DeviceFluid(params, Resources(threads, device="opencl:0")), cube)
        cube.push(fluid, 30)
        results.append(fluid.save())
    for key, array in results[0].items():
        assert np.array_equal(array, results[1][key], equal_nan=True), key


def test_snapshots_of_fluids_with_bodies_go_on_elsewhere():
    fluids = pair(FILMS, LOW)
    (processor, cube), (device, _) = fluids
    for fluid, pushed_cube in fluids:
        pushed_cube.push(fluid, 25)
    params = around(LOW, **FILMS)
    restarts = {}
    for name, restarted, source in (
        ("out", SphFluid(params), device),
        ("in", DeviceFluid(params, DEVICE), processor),
        ("on", DeviceFluid(params, DEVICE), device),
    ):
        restarted_cube = Cube(start=LOW)
        restarts[name] = join_cube(restarted, restarted_cube)
        restarted.load(source.save())
        restarted_cube.place = cube.place.copy()
        restarted_cube.push(restarted, 25)
    for fluid, pushed_cube in fluids:
        pushed_cube.push(fluid, 25)
    require_close(processor, restarts["out"])
    require_close(processor, restarts["in"])
    first, second = device.save(), restarts["on"].save()
    for key, array in first.items():
        assert np.array_equal(array, second[key], equal_nan=True), key


def test_fluid_inside_a_body_is_removed():
    params = params_of(remove_inside_bodies=True, **MIRRORED)
    forces = []
    for fluid in (SphFluid(params), DeviceFluid(params, DEVICE)):
        cube = Cube()
        fluid.bind(cube.static, JOINED)
        fluid.prime(cube.fields())
        forces.append(cube.push(fluid, 10))
    assert np.abs(forces[1] - forces[0]).max() < 1e-9 * np.abs(forces[0]).max()


def test_single_precision_rounds_forces_on_bodies():
    exact, cube = pair(MIRRORED)[0]
    rounded, rounded_cube = pair(MIRRORED | {"precision": "float32"})[1]
    expected, computed = cube.push(exact, 20), rounded_cube.push(rounded, 20)
    assert 0.0 < np.abs(computed - expected).max() < 1e-3 * np.abs(expected).max()


def test_samples_must_be_placed_before_a_step():
    fluid = DeviceFluid(around(**DYNAMIC), DEVICE)
    fluid.bind(Cube().static, JOINED)
    with pytest.raises(OrderError, match=r"samples must be placed first"):
        fluid.step(1e-4)


def test_links_that_choose_the_contact_potential_are_refused():
    static = Cube().static
    fluid = DeviceFluid(around(**MIRRORED), DEVICE)
    with pytest.raises(SceneError, match=r"on a device, samples.*chooses the contact potential"):
        fluid.bind(static | {"surface.contact": np.ones(len(static["surface.body"]))}, JOINED)
