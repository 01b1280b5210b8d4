"""A lattice on an OpenCL device is the lattice of the processor, to rounding."""

import subprocess
import sys
from dataclasses import fields

import numpy as np
import pytest

from quintet.components.particle_dynamics import MANIFEST
from quintet.components.particle_dynamics.component import ParticleLattice
from quintet.components.particle_dynamics.conform import LATTICE, cases
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.coupler.scene.read import load
from quintet.interfaces.component import Resources, fields_of
from quintet.interfaces.errors import SceneError, StepError
from quintet.interfaces.params import read

pytest.importorskip("pyopencl")
from quintet.components.particle_dynamics.opencl.refusal import SUPPORTED, limits
from quintet.components.shared.opencl.devices import Device

DEVICE = Resources(device="opencl")
TABLES = {case.name: case.params for case in cases() if case.device == "cpu"}
DRIVEN, WALL = TABLES["driven"], TABLES["wall"]
WARM = LATTICE["lattice"] | {"cells": [7, 6, 6], "temperature": 4e-6}
DAMPED = LATTICE | {"lattice": WARM, "damping": {"coefficient": 3e-4, "range": "step"}}
PERIODIC = DAMPED | {"lattice": WARM | {"periodic": ["x", "z"]}}
HOT = LATTICE | {
    "lattice": WARM | {"temperature": 2e-3},
    "damping": {"coefficient": 1e-3, "range": "all"},
    "if_point_lost": "report",
}
CALM = LATTICE | {"lattice": WARM | {"cells": [6, 6, 6], "periodic": ["x"]}}
CALM |= {"integrator": "yoshida"}
PLAIN = LATTICE | {"lattice": WARM, "seven_roots": {"top_frequency": 50.0, "exponent": 0.0}}


def params_of(table):
    params, mistakes = read(ParticleLatticeParams, table, "lattice")
    assert not mistakes
    return params


def advanced(lattice, steps):
    for _ in range(steps):
        lattice.step(lattice.stable_dt())
    return lattice


def pair(table, steps=0):
    params = params_of(table)
    lattices = ParticleLattice(params), ParticleLattice(params, DEVICE)
    return tuple(advanced(lattice, steps) for lattice in lattices)


def require_same_bits(first, second):
    assert first.keys() == second.keys()
    for key, array in first.items():
        assert np.array_equal(array, second[key], equal_nan=True), key


def largest_difference(first, second):
    """Largest difference of arrays, over the largest number of each."""
    assert first.keys() == second.keys()
    return max(
        np.abs(array - second[key]).max(initial=0.0) / np.abs(array).max(initial=1e-300)
        for key, array in first.items()
    )


@pytest.mark.parametrize(
    "table",
    [
        pytest.param(DRIVEN, id="driven"),
        pytest.param(PERIODIC, id="periodic"),
        pytest.param(HOT, id="hot"),
        pytest.param(CALM, id="calm"),
        pytest.param(PLAIN, id="plain", marks=pytest.mark.full),
    ],
)
def test_a_device_has_the_bits_of_the_processor(table):
    processor, device = pair(table, 1000)
    saved = device.save()
    require_same_bits(processor.save(), saved)
    assert np.array_equal(saved["listed"], processor.built.start) == (table is not HOT)
    assert device.warnings() == processor.warnings()
    wanted = frozenset(fields_of(device.gives))
    require_same_bits(processor.give(wanted), device.give(wanted))
    require_same_bits(processor.view(), device.view())
    assert device.totals().internal == processor.totals().internal


def test_points_that_a_strong_drive_moves_are_listed_in_time():
    # At the turn of its way a driven point stands still, and many steps are made without a look.
    drive = DRIVEN["drive"] | {"mode": "point", "amplitude": 0.12 * DRIVEN["lattice"]["spacing"]}
    processor, device = pair(DRIVEN | {"drive": drive, "substeps": 400}, 4)
    saved = device.save()
    require_same_bits(processor.save(), saved)
    assert not np.array_equal(saved["listed"], processor.built.start)


def test_a_device_that_is_no_processor_gets_lists_by_columns_and_single_lanes(monkeypatch):
    monkeypatch.setattr(Device, "is_processor", property(lambda self: False))
    processor, device = pair(PERIODIC, 200)
    assert not device.rows.points.by_rows
    require_same_bits(processor.save(), device.save())


def coupled(lattice, steps):
    """Advance a lattice whose wall gets warmer; heat [W] that it gives in each step."""
    heat = []
    for step in range(steps):
        lattice.take({"wall_temperature.temperature": np.full(4, 3e-6 * step)})
        advanced(lattice, 1)
        heat.append(lattice.give(frozenset({"wall_heat.heat_flow"}))["wall_heat.heat_flow"])
    return np.array(heat)


def test_baths_walls_and_collisions_act_as_on_the_processor():
    processor, device = pair(WALL)
    expected, computed = coupled(processor, 1000), coupled(device, 1000)
    assert np.abs(expected).max() > 0.0
    assert np.abs(computed - expected).max() < 1e-11 * np.abs(expected).max()
    first, second = processor.save(), device.save()
    assert first["generator"] == second["generator"]
    assert largest_difference(first, second) < 1e-11
    outputs, of_device = (
        dict(lattice.give(frozenset(fields_of(lattice.gives)))) for lattice in (processor, device)
    )
    audit = outputs.pop("energies.audit"), of_device.pop("energies.audit")
    assert audit[1] == pytest.approx(audit[0], abs=1e-12)  # a difference of energies
    assert largest_difference(outputs, of_device) < 1e-11


def test_the_same_device_gives_the_same_bits_on_any_number_of_threads():
    params, saved = params_of(WALL), []
    for threads in (1, 2):
        lattice = ParticleLattice(params, Resources(threads, device="opencl:0"))
        coupled(lattice, 200)
        saved.append(lattice.save())
    require_same_bits(*saved)


@pytest.mark.parametrize("table", [WALL, HOT], ids=["wall", "hot"])
def test_snapshots_go_on_here_and_elsewhere(table):
    params = params_of(table | {"substeps": 7})
    processor, device = (
        advanced(ParticleLattice(params, resources), 20) for resources in (Resources(), DEVICE)
    )
    moved_on, moved_out, moved_in = (
        ParticleLattice(params, resources) for resources in (DEVICE, Resources(), DEVICE)
    )
    moved_on.load(device.save())
    moved_out.load(device.save())
    moved_in.load(processor.save())
    uninterrupted = advanced(processor, 20).save()
    require_same_bits(advanced(device, 20).save(), advanced(moved_on, 20).save())
    for lattice in (moved_out, moved_in):
        assert largest_difference(uninterrupted, advanced(lattice, 20).save()) < 1e-11


def test_a_step_brings_no_points_back():
    device = advanced(pair(PERIODIC)[1], 3)
    before = device.rows.state.position.copy()
    advanced(device, 3)
    assert np.array_equal(device.rows.state.position, before)
    assert not np.array_equal(device.rows.all("position"), before)


def test_points_that_move_too_far_are_named_as_on_the_processor():
    messages = []
    for lattice in pair(LATTICE | {"lattice": WARM | {"temperature": 1.0}}):
        with pytest.raises(StepError, match=r"point \d+, at .* must move by less than") as error:
            lattice.step(0.05)
        messages.append(str(error.value))
    assert messages[0] == messages[1]


def test_a_table_of_forces_is_refused_with_what_to_do(tmp_path):
    name = str(tmp_path / "force.csv")
    (tmp_path / "force.csv").write_text("0.005,-1.0\n0.01,0.0\n0.02,0.0\n")
    table = {key: value for key, value in LATTICE.items() if key != "seven_roots"}
    params = params_of(table | {"force_table": name})
    with pytest.raises(SceneError) as error:
        MANIFEST.check_device(params, "opencl:0")
    assert str(error.value) == (
        f"on device opencl:0, force_table must be left out; found {name}. Give seven_roots, or set "
        'device = "cpu".'
    )


def test_every_key_of_a_lattice_is_supported_or_limited():
    keys = {field.name for field in fields(ParticleLatticeParams)}
    limited = limits(params_of(LATTICE)).keys()
    assert keys == SUPPORTED | limited and not SUPPORTED & limited


def test_a_scene_may_have_a_lattice_on_several_devices():
    for device in ("opencl", "opencl:0,1"):
        settings = [
            f"components.bar.device='{device}'",
            "components.bar.ranks=2",
            "transport='mpi'",
        ]
        plan = load("hot_bar", settings=settings).components["bar"]
        assert (plan.ranks, plan.device) == (2, device)


def test_a_device_without_double_precision_is_refused(monkeypatch):
    monkeypatch.setattr(Device, "has_doubles", property(lambda self: False))
    with pytest.raises(SceneError, match=r"it must compute in double precision.*`quintet devices`"):
        ParticleLattice(params_of(LATTICE), DEVICE)


def test_a_lattice_on_the_processor_loads_no_opencl():
    program = (
        "import sys; from quintet.components.particle_dynamics import MANIFEST;"
        "from quintet.components.particle_dynamics.conform import LATTICE;"
        "from quintet.interfaces.params import read;"
        "params, _ = read(MANIFEST.params, LATTICE, 'lattice');"
        "lattice = MANIFEST.load()(params); lattice.step(lattice.stable_dt());"
        "print([name for name in sys.modules if 'opencl' in name])"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.stdout.strip() == "[]", result.stderr
