"""A device fluid before its first step: what it compiles, and a return to that state."""

import numpy as np
import pytest
from device_bodies import DEVICE, JOINED, MIRRORED, Cube, around

pytest.importorskip("pyopencl")
from quintet.components.shared.opencl.devices import build
from quintet.components.sph_fluid.opencl import passes
from quintet.components.sph_fluid.opencl.device_fluid import DeviceFluid

START = np.array([0.3, 0.25, 0.25])  # m, centre of the cube
STEPS = 2


def joined_fluid(params, share, is_contact):
    """A device fluid and the cube in it."""
    fluid, cube = DeviceFluid(params, DEVICE), Cube(share, START)
    static = dict(cube.static)
    if is_contact:
        static["surface.contact"] = np.ones(len(cube.arm))
    fluid.bind(static, JOINED)
    return fluid, cube


def test_the_sums_over_pairs_are_compiled_once(monkeypatch):
    programs = []

    def counted_build(*arguments):
        programs.append(build(*arguments))
        return programs[-1]

    monkeypatch.setattr(passes, "build", counted_build)
    fluid, cube = joined_fluid(around(START, **MIRRORED), share=0.8, is_contact=True)
    cube.push(fluid, STEPS)
    assert len(programs) == 1


@pytest.mark.parametrize("images", ["symmetry", "periodic"])
@pytest.mark.parametrize(("share", "is_contact"), [(0.8, False), (1.0, True)])
def test_a_window_repeated_from_the_first_state_has_the_same_bits(images, share, is_contact):
    faces = {"symmetry": {"boundary__symmetry": ["x-"]}, "periodic": {"boundary__periodic": ["x"]}}
    params = around(START, **MIRRORED, **faces[images])
    fluid, cube = joined_fluid(params, share, is_contact)
    first = fluid.save()
    assert not len(first["reference"])  # before the first step
    loads = cube.push(fluid, STEPS)
    assert fluid.stepping.rows.copies.count > 0
    fluid.load(first)
    assert fluid.stepping.rows.copies.count == 0
    cube.place = START.copy()
    repeated_loads = cube.push(fluid, STEPS)
    assert np.abs(loads).max() > 0.0
    assert np.array_equal(repeated_loads, loads)
