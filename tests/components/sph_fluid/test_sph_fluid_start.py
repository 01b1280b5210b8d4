"""How fluid starts: fields by expressions and tables, shapes that are no boxes, room for bodies."""

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh
from fluid_params import fluid_params, nested
from sampled_bodies import BOX, SPHERE, fill, mirrors

from quintet.components.sph_fluid import MANIFEST, SphFluidParams
from quintet.components.sph_fluid.boundary.removal import displaced
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.setup.expressions import values_at
from quintet.interfaces.params import read

SPACING = 0.02
CUBE = ((0.0, 0.0, 0.0), (0.2, 0.2, 0.2))
ROOM = {"spacing": SPACING, "sound_speed": 30.0, "gravity": (0.0, 0.0, 0.0)}


def mistakes(folder=None, **changes):
    return "\n".join(read(SphFluidParams, nested(ROOM | changes), "water", folder)[1])


def fluid(**changes):
    return SphFluid(fluid_params(**(ROOM | changes)))


def points(solver):
    return solver.state.position_density[: solver.state.fluid, :3]


def test_velocity_and_density_are_fields_of_the_place():
    solver = fluid(
        fluid=(CUBE,),
        initial__velocity=("-2 * (y - 0.1)", "2 * (x - 0.1)", 0.25),
        initial__density="1000 + where(z < 0.1, 5, 0) * cos(pi * x / 0.2)**2",
    )
    x, y, z = points(solver).T
    velocity = solver.state.velocity_pressure[: solver.state.fluid, :3]
    np.testing.assert_allclose(velocity, np.stack([-2 * (y - 0.1), 2 * (x - 0.1), 0.25 + 0 * x], 1))
    density = 1000.0 + np.where(z < 0.1, 5.0, 0.0) * np.cos(math.pi * x / 0.2) ** 2
    np.testing.assert_allclose(solver.state.position_density[: solver.state.fluid, 3], density)
    # A vortex about the middle, which also drifts: of a lattice, Σ m ω r².
    assert solver.totals().momentum == pytest.approx([0.0, 0.0, 2.0], abs=1e-12)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1 + 2 * 3", 7.0),
        ("-x ** 2", -0.25),
        ("min(x, y) + max(x, y)", 1.25),
        ("where(x <= 0.5, 1, 2)", 1.0),
        ("hypot(3, 4) + abs(-1) + sqrt(4) + atan2(0, 1)", 8.0),
        ("exp(log(3)) + sinh(0) + cosh(0) + tanh(0) + tan(0) + sin(pi)", 4.0),
    ],
)
def test_expressions_have_the_value_of_mathematics(text, value):
    values = values_at(text, np.array([[0.5, 0.75, 1.0]] * 2), "v")
    assert values == pytest.approx([value, value])


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('true')",
        "().__class__",
        "x.real",
        "x[0]",
        "lambda: x",
        "[x for x in (1,)]",
        "f'{x}'",
        "open('file')",
        "sin(x, y)",
        "sin(*x)",
        "hypot(x, y=1)",
        "x if y else z",
        "x and y",
        "True",
        "'text'",
        "1j",
        "t",
        "(x := 1)",
        "x <",
        "",
        "x\x00",
        "-" * 200 + "x",
        "(" * 300 + "x" + ")" * 300,
        "x + " * 400 + "x",
    ],
)
def test_what_is_no_expression_is_refused_and_never_run(text):
    sentence = mistakes(fluid=(CUBE,), initial__density=text)
    assert "an expression must" in sentence and "\n" not in sentence, sentence


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"initial.density": "1 / (x - x)"}, "density must be finite in all of the fluid"),
        ({"initial.velocity": [0, "log(-1 - x)", 0]}, "velocity must be finite"),
        ({"initial.velocity": [0, "9**9**9**9", 0]}, "velocity must be finite"),
        ({"initial.density": 1200.0}, "within 10 % of 1000 kg/m3"),
        ({"initial.table": "none.csv"}, "file none.csv must lie beside the scene"),
    ],
)
def test_fields_that_cannot_be_are_refused(changes, sentence):
    assert sentence in mistakes(fluid=(CUBE,), **changes)


def write(path: Path, text: str) -> Path:
    (path / "start.csv").write_text(text)
    return path


def test_a_table_is_linear_between_its_rows(tmp_path):
    rows = [f"{x},{z},{3 * x + z},{1000 + z}" for z in (0.2, 0.0) for x in (0.0, 0.2, 0.1)]
    folder = write(tmp_path, "\ufeffx, z, u, density\n" + "\n".join(rows) + "\n")
    table = nested(ROOM | {"fluid": (CUBE,), "initial.table": "start.csv"})
    params, errors = read(SphFluidParams, table, "water", folder)
    assert not errors
    solver = SphFluid(params)
    x, _, z = points(solver).T
    velocity = solver.state.velocity_pressure[: solver.state.fluid, :3]
    np.testing.assert_allclose(velocity[:, 0], 3.0 * x + z, atol=1e-12)
    assert not velocity[:, 1:].any()
    np.testing.assert_allclose(solver.state.position_density[: solver.state.fluid, 3], 1000.0 + z)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("x,u\n0,1\n0,2\n", "a row for each point of a rectangular grid"),
        ("x,z,u\n0,0,1\n1,1,2\n", "a row for each point of a rectangular grid"),
        ("x,speed\n0,1\n", "must have columns of finite numbers"),
        ("x,u\n0,nan\n", "must have columns of finite numbers"),
        ("x,u\n0,much\n", "lines of numbers"),
        ("x,u\n0,0,1\n", "separated by commas; found 3 cells in line 2, and 2 names"),
        ("x,u\n0,0\n1\n", "found 1 cells in line 3, and 2 names"),
        ("x,u\n", "found 1 lines"),
        ("", "lines of numbers"),
    ],
)
def test_a_table_that_is_none_is_refused(tmp_path, text, sentence):
    folder = write(tmp_path, text)
    assert sentence in mistakes(folder, fluid=(CUBE,), initial__table="start.csv")


SPHERE_SHAPE = {"shape": "sphere", "centre": [0.1, 0.1, 0.1], "radius": 0.085}
SHAPES = [
    (SPHERE_SHAPE, math.pi / 6.0 * 0.17**3),
    (
        {"shape": "cylinder", "base": [0.0] * 3, "top": [0.0, 0.0, 0.2], "radius": 0.065},
        math.pi / 4.0 * 0.13**2 * 0.2,
    ),
    (
        {
            "shape": "prism",
            "axis": "y",
            "corners": [[0.0, 0.0], [0.3, 0.0], [0.3, 0.07], [0.1, 0.07], [0.0, 0.2]],
            "ends": [0.0, 0.1],
        },
        0.1 * (0.3 * 0.07 + 0.5 * 0.13 * 0.1),
    ),
]


@pytest.mark.parametrize(("shape", "volume"), SHAPES, ids=["sphere", "cylinder", "prism"])
def test_a_shape_weighs_what_it_holds_and_stays_inside(shape, volume):
    solver = fluid(fluid=(shape,))
    assert solver.totals().mass == pytest.approx(1000.0 * volume, rel=1e-9)
    # Nearly as many particles as volumes of a cube.
    assert solver.state.fluid == pytest.approx(volume / SPACING**3, rel=0.1)
    low, high = np.array(solver.params.shapes[0].bounds)
    assert ((points(solver) > low - 0.5 * SPACING) & (points(solver) < high + 0.5 * SPACING)).all()
    assert MANIFEST.plan is not None and MANIFEST.plan(solver.params).items == solver.items()


def test_particles_of_a_sphere_lie_in_it():
    distance = np.linalg.norm(points(fluid(fluid=(SPHERE_SHAPE,))) - 0.1, axis=1)
    assert distance.max() < 0.5 * 0.17 + 0.5 * SPACING
    assert np.sqrt((distance**2).mean()) == pytest.approx(math.sqrt(0.6) * 0.085, rel=0.02)


def test_a_shape_in_a_slab_is_a_disc():
    disc = {"shape": "cylinder", "base": [0.3, 0.0, 0.5], "top": [0.3, 1.0, 0.5], "radius": 0.1}
    box = ((0.0, 0.0, 0.0), (0.6, 1.0, 0.2))
    solver = fluid(dimensions=2, fluid=(box, disc))
    assert solver.totals().mass == pytest.approx(1000.0 * (0.12 + math.pi * 0.01), rel=1e-9)


def test_a_surface_from_a_file_is_filled(tmp_path):
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=1.0)
    mesh.export(tmp_path / "ball.stl")
    ball = {"shape": "mesh", "file": "ball.stl", "scale": 0.1, "origin": [0.3, 0.2, 0.1]}
    params, errors = read(SphFluidParams, nested(ROOM | {"fluid": [ball]}), "water", tmp_path)
    assert not errors
    solver = SphFluid(params)
    assert solver.totals().mass == pytest.approx(1000.0 * 1e-3 * float(mesh.volume), rel=1e-6)
    distance = np.linalg.norm(points(solver) - [0.3, 0.2, 0.1], axis=1)
    assert distance.max() < 0.1 + 0.5 * SPACING
    assert solver.totals().momentum == pytest.approx([0.0] * 3)
    assert points(solver).mean(axis=0) == pytest.approx([0.3, 0.2, 0.1], abs=0.1 * SPACING)


def test_a_column_starts_hydrostatic_and_a_drop_without_weight():
    column, drop = SHAPES[1][0], SPHERE_SHAPE | {"centre": [0.4, 0.0, 0.3], "hydrostatic": False}
    solver = fluid(fluid=(column, drop), gravity=(0.0, 0.0, -9.81))
    place = points(solver)
    density = solver.state.position_density[: solver.state.fluid, 3]
    in_drop = place[:, 0] > 0.2
    assert (density[in_drop] == 1000.0).all()
    pressure = 900.0 * 1000.0 / 7.0 * ((density[~in_drop] / 1000.0) ** 7 - 1.0)
    np.testing.assert_allclose(pressure, 9810.0 * (0.2 - place[~in_drop, 2]), rtol=1e-6)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"fluid": [{"shape": "sphere", "radius": 1.0}]},
            "a sphere is described by",
        ),
        (
            {"fluid": [CUBE, SPHERE_SHAPE | {"radius": 0.05}]},
            r"fluid[1] must not overlap fluid[0]",
        ),
        ({"fluid": [SPHERE_SHAPE, SPHERE_SHAPE]}, r"fluid[1] must not overlap fluid[0]"),
        ({"fluid": [SPHERE_SHAPE], "dimensions": 2}, "a cylinder or a prism along y"),
        (
            {"fluid": [SPHERE_SHAPE], "boundary.walls": [[0.05, 0.0, 0.0], [1.0, 1.0, 1.0]]},
            "fluid[0] must be inside the walls along x",
        ),
        (
            {"fluid": [SHAPES[2][0] | {"corners": [[0, 0], [1, 1], [1, 0], [0, 1]]}]},
            "does not cross itself",
        ),
        ({"fluid": [SHAPES[2][0] | {"ends": [0.1, 0.0]}]}, "the lower and the upper end"),
        ({}, "fluid must have at least one box"),
    ],
)
def test_shapes_that_cannot_be_are_refused(changes, sentence):
    assert sentence in mistakes(**changes)


def samples_at(shape, size, centre):
    arm, normal, volume = fill(shape, size, SPACING, 3.0 * SPACING)
    image = mirrors(shape, size, arm, normal)
    return centre + arm, centre + image, volume


def lattice(spacing, dimensions):
    axis = spacing * (np.arange(round(0.4 / spacing)) + 0.5)
    return np.stack(np.meshgrid(*[axis] * dimensions, indexing="ij"), axis=-1).reshape(
        -1, dimensions
    )


@pytest.mark.parametrize("shape", [SPHERE, BOX])
@pytest.mark.parametrize("shift", [0.0, 0.3, 0.5])
def test_a_body_displaces_its_volume_wherever_the_lattice_lies(shape, shift):
    size, centre = np.full(3, 0.17), 0.2 + shift * SPACING * np.array([1.0, 0.7, 0.4])
    arm, _, volume = fill(shape, size, SPACING, math.inf)
    water = lattice(SPACING, 3)
    rows = displaced(water, centre + arm, volume, SPACING)
    fill_share = math.pi / 6.0 if shape == SPHERE else 1.0
    assert len(rows) == round(fill_share * 0.17**3 / SPACING**3)
    offset = water - centre
    depth = 0.085 - (
        np.linalg.norm(offset, axis=1) if shape == SPHERE else np.abs(offset).max(axis=1)
    )
    assert depth[rows].min() > -0.5 * SPACING
    assert np.delete(depth, rows).max() < 0.5 * SPACING


def test_a_floating_body_displaces_what_is_below_the_surface():
    arm, _, volume = fill(BOX, np.full(3, 0.16), SPACING, math.inf)
    water = lattice(SPACING, 3)
    water = water[water[:, 2] < 0.2]
    rows = displaced(water, np.array([0.2, 0.2, 0.237]) + arm, volume, SPACING)
    assert len(rows) == pytest.approx(0.16**2 * (0.2 - 0.157) / SPACING**3, abs=0.5)


def test_fluid_inside_bodies_is_removed_and_its_mass_told():
    solver = fluid(fluid=(CUBE,), remove_inside_bodies=True, boundary__method="mdbc")
    size, centre = np.full(3, 0.08), np.array([0.1, 0.1, 0.1])
    place, image, volume = samples_at(BOX, size, centre)
    static = {"surface.volume": volume, "surface.body": np.zeros(len(volume))}
    solver.bind({"surface.normal": place, **static}, frozenset({"surface"}))
    fields = {"surface.position": place, "surface.velocity": 0.0 * place, "surface.mirror": image}
    solver.prime(fields)
    assert solver.notes() == (
        "body 0 stood in the fluid: 64 particles inside it, 0.512 kg, were removed",
    )
    assert solver.totals().mass == pytest.approx(8.0 - 0.512)
    assert np.abs(points(solver) - 0.1).max(axis=1).min() > 0.04
    for _ in range(5):
        solver.take(fields)
        solver.step(solver.stable_dt())
    assert solver.totals().mass == pytest.approx(8.0 - 0.512)
