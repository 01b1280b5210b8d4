"""Spheres on an OpenCL device are those of the processor, to rounding."""

import re
import subprocess
import sys
from dataclasses import fields

import numpy as np
import pytest
from dem_scenes import FLOOR, box, disc, material, params, run, sphere

from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.state import COLUMNS, DEEPEST_PAIR
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError, StepError

pytest.importorskip("pyopencl")
from quintet.components.dem_bodies.opencl import one_device, programs
from quintet.components.dem_bodies.opencl.refusal import (
    SUPPORTED,
    SUPPORTED_IN,
    limits,
    refuse_what_needs_the_processor,
)
from quintet.components.dem_bodies.opencl.search import Search
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.devices import Device, is_accelerator_there

DEVICE = Resources(device="opencl")
STICKY = {"a": material(youngs_modulus=1e7, rolling_friction=0.1), "b": material(friction=0.6)}
CORNER = [
    {"point": [0.0] * 3, "normal": [float(axis == k) for axis in range(3)], "material": "b"}
    for k in range(3)
]
GATE = {"point": [0.08, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0], "material": "b", "until": 0.004}
PORTS = frozenset(
    {
        "motion.position", "motion.velocity", "motion.orientation", "motion.angular_velocity",
        "contact.force", "contact.torque", "front_gauge.position", "front_gauge.share",
    }
)  # fmt: skip


def heap(count=3):
    """Spheres of two sizes that touch each other and move into a corner."""
    random = np.random.default_rng(5)
    places = 0.02 * (np.array(list(np.ndindex(count, count, count))) + 0.5)
    return [
        sphere(
            place,
            (0.02, 0.019)[number % 2],
            velocity=(random.uniform(-0.05, 0.05, 3) - 2.0 * place).tolist(),
            angular_velocity=random.uniform(-1.0, 1.0, 3).tolist(),
        )
        for number, place in enumerate(places)
    ]


HEAP = {"planes": [*CORNER, GATE], "contact_forces": True, "front_gauge": "x"}


def spheres(resources, bodies=None, materials=None, **settings):
    scene = params(bodies or heap(), materials or STICKY, **(settings or HEAP))
    return DemBodies(scene, resources)


def advanced(solver, steps):
    for _ in range(steps):
        solver.step(solver.stable_dt())
    return solver


def differing(first, second):
    assert first.keys() == second.keys()
    return [key for key in first if not np.array_equal(first[key], second[key], equal_nan=True)]


def require_close(processor, device, limit=1e-9):
    """Every array of the state, and the pairs that touch, in the same order."""
    expected, computed = processor.save(), device.save()
    assert expected.keys() == computed.keys()
    for key in ("body", "balls.begin", "balls.partner"):
        assert np.array_equal(expected[key], computed[key]), key
    for key, array in expected.items():
        scale = np.abs(array[np.isfinite(array)]).max(initial=0.0)
        if key == "report":
            continue
        assert np.allclose(array, computed[key], limit, limit * scale), key
    # Each number has a unit of its own, and any pair stands for the deepest.
    reports = (np.delete(arrays["report"], DEEPEST_PAIR) for arrays in (expected, computed))
    assert np.allclose(*reports, limit, 0.0)
    assert (expected["balls.history"][3] > 0.0).any()
    assert device.stable_dt() == pytest.approx(processor.stable_dt(), rel=limit)


@pytest.mark.parametrize(
    ("count", "settings", "steps"),
    [(3, HEAP, 1000), (5, {"planes": CORNER}, 100)],
    ids=["one group of rows", "two groups of rows"],
)
def test_a_device_computes_as_the_processor_does(count, settings, steps):
    solvers = (spheres(resources, heap(count), **settings) for resources in (Resources(1), DEVICE))
    require_close(*(advanced(solver, steps) for solver in solvers))


def test_loads_turn_and_push_as_on_the_processor():
    settings = {"planes": CORNER}
    solvers = [spheres(resources, **settings) for resources in (Resources(1), DEVICE)]
    count = len(heap())
    random = np.random.default_rng(2)
    force, torque = 0.1 * random.normal(size=(2, count, 3)) * [[[1.0]], [[1e-3]]]
    for solver in solvers:
        solver.take({"load.force": force, "load.torque": torque})
        advanced(solver, 200)
    processor, device = solvers
    require_close(processor, device)
    assert device.accumulated.load_work == pytest.approx(processor.accumulated.load_work, rel=1e-9)
    assert processor.accumulated.load_work != 0.0


def test_readings_are_those_of_the_processor():
    solvers = [advanced(spheres(resources), 300) for resources in (Resources(1), DEVICE)]
    expected, computed = (solver.give(PORTS) for solver in solvers)
    assert expected.keys() == computed.keys() == PORTS
    for name in PORTS:
        scale = np.abs(expected[name]).max()
        assert scale > 0.0
        assert np.allclose(expected[name], computed[name], 1e-9, 1e-9 * scale), name
    processor, device = solvers
    first, second = (solver.contact_points() for solver in solvers)
    assert np.array_equal(first["bodies"], second["bodies"])
    scale = np.abs(first["force"]).max()
    assert np.allclose(first["force"], second["force"], 1e-9, 1e-9 * scale)
    assert device.totals().kinetic == pytest.approx(processor.totals().kinetic, rel=1e-9)
    assert device.totals().internal == pytest.approx(processor.totals().internal, rel=1e-9)
    assert device.warnings().keys() == processor.warnings().keys()
    assert device.items() == processor.items() == len(heap())


def test_totals_read_no_loads_from_a_device(monkeypatch):
    device, read, get = advanced(spheres(DEVICE), 3), [], DeviceArray.get
    monkeypatch.setattr(
        DeviceArray, "get", lambda array, *rows: read.append(array.shape) or get(array, *rows)
    )
    device.totals()
    rows = len(heap()) + 1
    assert (rows, COLUMNS) in read and (rows, 6) not in read


def test_a_device_repeats_its_bits_on_any_number_of_threads():
    first, second = (
        advanced(spheres(Resources(threads, device="opencl:0")), 100).save() for threads in (1, 2)
    )
    assert differing(first, second) == []


@pytest.mark.skipif(is_accelerator_there(), reason="lanes of pairs are for processors")
def test_lanes_of_pairs_are_close_to_single_pairs(monkeypatch):
    first = advanced(spheres(DEVICE), 100)
    monkeypatch.setattr(programs, "LANES_OF_PROCESSORS", 1)
    require_close(first, advanced(spheres(DEVICE), 100), 1e-12)


def loose(count=3):
    """Spheres that fly in all directions between planes, of which pairs are often listed again."""
    random = np.random.default_rng(3)
    return [body | {"velocity": random.uniform(-1.0, 1.0, 3).tolist()} for body in heap(count)]


SMOOTH = {"a": material(), "b": material()}
LISTED = {
    "rolling": (3, STICKY, HEAP),
    "no rolling": (3, SMOOTH, HEAP),
    "two groups of rows": (5, SMOOTH, {"planes": CORNER}),
    "no planes": (3, SMOOTH, {"planes": []}),
    "one sphere": (1, SMOOTH, {"planes": CORNER}),
}


@pytest.mark.skipif(is_accelerator_there(), reason="a device that is no processor lists pairs")
@pytest.mark.parametrize("case", LISTED)
def test_pairs_that_a_device_lists_are_those_of_the_host(case, monkeypatch):
    count, materials, settings = LISTED[case]
    monkeypatch.setattr(programs, "LANES_OF_PROCESSORS", 1)
    saved, searches, renew = [], [], Search.renew
    monkeypatch.setattr(
        Search, "renew", lambda self, former: searches.append(former) or renew(self, former)
    )
    for is_processor in (True, False):
        monkeypatch.setattr(
            Device, "is_processor", property(lambda self, is_it=is_processor: is_it)
        )
        saved.append(advanced(spheres(DEVICE, loose(count), materials, **settings), 300).save())
    assert searches and differing(*saved) == []


def test_snapshots_go_on_elsewhere_and_on_the_device_with_the_same_bits():
    device, processor = (advanced(spheres(resources), 150) for resources in (DEVICE, Resources(1)))
    moved_out, moved_in, moved_on = spheres(Resources(1)), spheres(DEVICE), spheres(DEVICE)
    moved_out.load(device.save())
    moved_on.load(device.save())
    moved_in.load(processor.save())
    uninterrupted = advanced(processor, 150)
    for solver in (moved_out, moved_in):
        require_close(uninterrupted, advanced(solver, 150))
    assert differing(advanced(device, 150).save(), advanced(moved_on, 150).save()) == []


def test_a_device_begins_from_a_run_of_the_processor():
    saved = advanced(spheres(Resources(1)), 150).save()
    settings = HEAP | {"planes": CORNER}
    begun = [spheres(resources, **settings) for resources in (Resources(1), DEVICE)]
    for solver in begun:
        solver.begin_from(saved)
    require_close(*(advanced(solver, 100) for solver in begun))


def test_a_single_sphere_flies_in_long_steps_until_the_floor_is_near():
    flying = sphere([0.0, 0.0, 0.2])
    steps = []
    for resources in (Resources(1), DEVICE):
        solver = spheres(resources, [flying], planes=[FLOOR], materials={"a": material()})
        lengths = []
        run(solver, 0.198, lambda time, lengths=lengths: lengths.append(time))
        steps.append(lengths)
    assert steps[0] == pytest.approx(steps[1], rel=1e-9) and len(steps[0]) > 40


def test_a_step_that_fails_names_its_body():
    named = []
    for resources in (Resources(1), DEVICE):
        solver = spheres(resources)
        with pytest.raises(StepError, match=r"the overlap of a contact must be at most") as error:
            for _ in range(20):
                solver.step(2e-3)
        message = str(error.value)
        bodies = re.search(r"body \d+ with (body \d+|a plane)", message)
        assert bodies, message
        named.append((message.partition(":")[0], bodies[0]))
    assert named[0] == named[1]


def test_lists_that_outgrow_the_memory_stop_the_run(monkeypatch):
    def without_room(*_):
        raise SceneError("no room")

    solver = advanced(spheres(DEVICE, loose()), 1)
    monkeypatch.setattr(one_device, "pairs_of_host", without_room)
    monkeypatch.setattr(Search, "renew", without_room)
    with pytest.raises(StepError, match="no room"):
        advanced(solver, 300)


def test_a_load_that_is_not_finite_stops_the_run():
    solver = advanced(spheres(DEVICE), 3)
    solver.check()
    solver.take({"load.force": np.full((len(heap()), 3), np.nan)})
    with pytest.raises(StepError, match=r"the state must stay finite; body 0"):
        advanced(solver, 2)


REFUSED = {
    "bodies": ([box([0.0, 0.0, 0.1])], {}),
    "dimensions": ([disc([0.0, 0.0, 0.2])], {"dimensions": 2}),
    "contact_with_faces": ([sphere([0.0, 0.0, 0.2])], {"contact_with_faces": True}),
}


def test_every_key_of_the_bodies_is_supported_or_limited():
    keys, limited = (
        {field.name for field in fields(DemBodiesParams)},
        limits(params(heap(), STICKY)),
    )
    assert keys == SUPPORTED | limited.keys() and not SUPPORTED & limited.keys()
    assert limited.keys() == REFUSED.keys()


@pytest.mark.parametrize("table", SUPPORTED_IN)
def test_every_key_of_nested_tables_is_supported(table):
    assert {field.name for field in fields(table)} == SUPPORTED_IN[table]


@pytest.mark.parametrize("key", REFUSED)
def test_what_devices_cannot_compute_is_refused_by_name(key):
    bodies, settings = REFUSED[key]
    with pytest.raises(
        SceneError, match=rf'on device opencl, {key} must be .*; found .*set device = "cpu"'
    ):
        refuse_what_needs_the_processor(params(bodies, **settings), "opencl")


def test_bodies_that_are_no_free_spheres_are_named():
    bodies = [sphere([0.0, 0.0, 0.2]), sphere([0.0, 0.0, 0.4], locked=["x"]), box([0.0, 0.0, 0.7])]
    with pytest.raises(SceneError) as error:
        DemBodies(params(bodies), Resources(device="opencl:0"))
    assert str(error.value) == (
        "on device opencl:0, bodies must be free spheres; found sphere with locked x, box. Leave "
        'others out, or set device = "cpu".'
    )


def test_a_device_without_double_precision_is_refused(monkeypatch):
    monkeypatch.setattr(Device, "has_doubles", property(lambda self: False))
    with pytest.raises(SceneError, match=r"it must compute in double precision.*`quintet devices`"):
        spheres(DEVICE)


def test_one_rank_takes_no_list_of_devices():
    words = r"device opencl:0,1: it must have one number, .*; found 2 numbers and ranks = 1"
    with pytest.raises(SceneError, match=words):
        spheres(Resources(device="opencl:0,1"))


def test_bodies_on_the_processor_load_no_opencl():
    program = (
        "import sys; from quintet.components.dem_bodies import MANIFEST; MANIFEST.load();"
        "print([name for name in sys.modules if 'opencl' in name])"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.stdout.strip() == "[]", result.stderr
