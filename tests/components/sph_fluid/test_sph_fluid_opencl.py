"""A fluid on an OpenCL device is the fluid of the processor, to rounding."""

import subprocess
import sys
from dataclasses import fields

import numpy as np
import pytest
from device_fluids import DEVICE, DYNAMIC, MIRRORED, TWICE, advanced, difference, params_of

from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.pairs.interaction import relative_wall_volume
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.viscosity import Viscosity
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError

pytest.importorskip("pyopencl")
from quintet.components.shared.opencl.devices import Device
from quintet.components.sph_fluid.opencl.device_fluid import DeviceFluid


@pytest.mark.parametrize(
    ("table", "steps"),
    [(MIRRORED, 200), (DYNAMIC, 60), (MIRRORED | TWICE, 100), (DYNAMIC | TWICE, 40)],
)
def test_a_device_computes_as_the_processor_does(table, steps):
    params = params_of(table)
    processor, device = (
        advanced(SphFluid(params), steps),
        advanced(DeviceFluid(params, DEVICE), steps),
    )
    assert processor.state.moved > 0.0
    assert difference(processor, device, "points") < 1e-13
    assert difference(processor, device, "velocity") < 2e-7  # both are rounded to single
    assert device.stable_dt() == pytest.approx(processor.stable_dt(), rel=1e-12)
    first, second = processor.save(), device.save()
    assert first.keys() == second.keys()
    assert np.array_equal(first["identity"], second["identity"])  # sorted alike
    assert np.abs(first["reference"] - second["reference"]).max() < 1e-13


def symmetric(table, *faces):
    """Return a table with planes of symmetry."""
    return table | {"boundary": table["boundary"] | {"symmetry": [*faces]}}


@pytest.mark.parametrize(
    ("table", "steps"),
    [
        (symmetric(MIRRORED | TWICE, "x-"), 100),
        (symmetric(DYNAMIC, "x-", "y+"), 60),
        pytest.param(
            symmetric(MIRRORED, "x-") | {"viscosity": {"kinematic": 1e-3}, "shepard_every": 9},
            100,
            marks=pytest.mark.full,
        ),
    ],
)
def test_planes_of_symmetry_are_those_of_the_processor(table, steps):
    params = params_of(table)
    processor, device = (
        advanced(SphFluid(params), steps),
        advanced(DeviceFluid(params, DEVICE), steps),
    )
    assert device.stepping.rows.copies.count > 0
    assert difference(processor, device, "points") < 1e-13
    assert difference(processor, device, "velocity") < 2e-7  # both are rounded to single
    first, second = processor.save(), device.save()
    assert np.array_equal(first["identity"], second["identity"])  # sorted alike


@pytest.mark.parametrize("table", [MIRRORED, DYNAMIC | TWICE])
def test_a_device_that_is_no_processor_gets_lists_by_columns_and_single_lanes(table, monkeypatch):
    monkeypatch.setattr(Device, "is_processor", property(lambda self: False))
    params = params_of(table)
    processor, device = advanced(SphFluid(params), 30), advanced(DeviceFluid(params, DEVICE), 30)
    assert not device.stepping.rows.cells.by_rows
    assert difference(processor, device, "points") < 1e-13


UNEVEN = {
    "fluid": [{"shape": "box", "lowest": [0.0, 0.0, 0.0], "highest": [0.27, 1.0, 0.37]}],
}


@pytest.mark.parametrize(
    "changes",
    [
        {"kernel": "quintic"},
        pytest.param({}, marks=pytest.mark.full),
        pytest.param({"precision": "float32"}, marks=pytest.mark.full),
    ],
)
def test_walls_have_their_own_volume_where_the_spacing_does_not_divide_the_fluid(changes):
    params = params_of(MIRRORED | UNEVEN | changes)
    assert abs(relative_wall_volume(params) - 1.0) > 0.05
    processor, device = advanced(SphFluid(params), 60), advanced(DeviceFluid(params, DEVICE), 60)
    limit = 1e-4 if changes == {"precision": "float32"} else 2e-7
    assert difference(processor, device, "velocity") < limit


def test_a_device_without_double_precision_is_refused(monkeypatch):
    monkeypatch.setattr(Device, "has_doubles", property(lambda self: False))
    with pytest.raises(SceneError, match=r"it must compute in double precision.*`quintet devices`"):
        DeviceFluid(params_of(DYNAMIC), DEVICE)


def test_gauges_and_totals_are_those_of_the_processor():
    params = params_of(MIRRORED)
    processor, device = advanced(SphFluid(params), 40), advanced(DeviceFluid(params, DEVICE), 40)
    keys = frozenset(f"{p.name}.{f.name}" for p in device.gives for f in p.fields)
    names = frozenset(name for name in keys if name != "surface_load.force")
    expected, computed = processor.give(names), device.give(names)
    assert computed.keys() == expected.keys() == names and names
    for name in names:
        assert computed[name] == pytest.approx(expected[name], rel=1e-9, abs=1e-9)
    assert device.totals().kinetic == pytest.approx(processor.totals().kinetic, rel=1e-9)
    assert device.totals().mass == processor.totals().mass


def test_the_same_device_gives_the_same_bits_on_any_number_of_threads():
    params = params_of(DYNAMIC)
    first, second = (
        advanced(DeviceFluid(params, Resources(threads, device="opencl:0")), 30).save()
        for threads in (1, 2)
    )
    for key, array in first.items():
        assert np.array_equal(array, second[key], equal_nan=True), key


@pytest.mark.parametrize("changes", [{}, TWICE])
def test_a_snapshot_of_a_device_goes_on_there_with_the_same_bits(changes):
    params = params_of(MIRRORED | changes)
    device = advanced(DeviceFluid(params, DEVICE), 25)
    saved = device.save()
    loaded = DeviceFluid(params, DEVICE)
    loaded.load(saved)
    first, second = advanced(device, 25).save(), advanced(loaded, 25).save()
    for key, array in first.items():
        assert np.array_equal(array, second[key], equal_nan=True), key


@pytest.mark.parametrize("changes", [{}, TWICE])
def test_snapshots_go_on_elsewhere(changes):
    params = params_of(MIRRORED | changes)
    device, processor = DeviceFluid(params, DEVICE), SphFluid(params)
    advanced(device, 25), advanced(processor, 25)
    moved_out, moved_in = SphFluid(params), DeviceFluid(params, DEVICE)
    moved_out.load(device.save())
    moved_in.load(processor.save())
    uninterrupted = advanced(processor, 25)
    for fluid in (moved_out, moved_in):
        assert difference(uninterrupted, advanced(fluid, 25), "points") < 1e-13


def test_single_precision_rounds_pairs_alone():
    double, single = params_of(MIRRORED), params_of(MIRRORED | {"precision": "float32"})
    exact, rounded = advanced(SphFluid(double), 60), advanced(DeviceFluid(single, DEVICE), 60)
    assert 0.0 < difference(exact, rounded, "points") < 1e-6
    assert difference(exact, rounded, "density") < 1e-6


def test_fluid_that_leaves_the_tank_is_lost_as_on_the_processor():
    thrown = MIRRORED | {"gravity": [0.0, 0.0, 0.0], "initial": {"velocity": [0.0, 0.0, 8.0]}}
    params = params_of(thrown)
    processor, device = advanced(SphFluid(params), 190), advanced(DeviceFluid(params, DEVICE), 190)
    first, second = processor.save(), device.save()
    assert first["lost_through"].sum() > 0
    for key in ("lost_through", "exit_face", "identity"):
        assert np.array_equal(first[key], second[key]), key


# Every key of a fluid: a new one comes with a test that devices compute it as the processor does.
COMPUTED = frozenset(
    """material xsph shepard_every acoustic_damper spacing sound_speed fluid initial lost_limit
    remove_inside_bodies dimensions kernel smoothing staggered density gravity density_diffusion
    negative_pressure precision integration courant gauges wave viscosity.artificial
    viscosity.kinematic viscosity.form boundary.method boundary.walls boundary.symmetry
    boundary.periodic boundary.inflow boundary.outflow boundary.open_faces boundary.wall_velocity
    boundary.obstacles boundary.meshes boundary.motion boundary.pistons boundary.damping
    boundary.wall_offset boundary.sample_depth boundary.wall_viscosity_factor
    boundary.lubrication_films boundary.roughness boundary.potential_stiffness
    boundary.potential_exponent""".split()
)


def test_devices_compute_every_key_of_a_fluid():
    inner = {"boundary": Boundary, "viscosity": Viscosity}
    keys = {field.name for field in fields(SphFluidParams)} - inner.keys()
    keys |= {f"{name}.{field.name}" for name, table in inner.items() for field in fields(table)}
    assert keys == COMPUTED


def test_a_device_that_is_not_there_is_refused():
    with pytest.raises(SceneError, match=r"device opencl:99: .*found 1.*`quintet devices`"):
        DeviceFluid(params_of(DYNAMIC), Resources(device="opencl:99"))


def test_a_fluid_on_the_processor_loads_no_opencl():
    program = (
        "import sys; from quintet.components.sph_fluid import MANIFEST; MANIFEST.load();"
        "print([name for name in sys.modules if 'opencl' in name])"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.stdout.strip() == "[]", result.stderr
