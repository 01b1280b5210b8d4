"""Agglomerates: mass and inertia of the shape in the file, spheres that cover it, refusals."""

import numpy as np
import pytest
import trimesh
from dem_scenes import FLOOR, NOTHING, build, material, mistakes, params, run

from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.plan import plan
from quintet.components.dem_bodies.shapes.agglomerate import agglomerate
from quintet.components.dem_bodies.state import DEEPEST_PAIR, ELASTIC_ENERGY
from quintet.components.shared.geometry.mesh_files import voxels
from quintet.interfaces.component import outputs_of
from quintet.interfaces.params import read

EDGE = 0.15  # m


@pytest.fixture
def files(tmp_path):
    """A cube, a ball and an L in several formats; the L is 3 x 3 x 3 less 2 x 3 x 2 voxels."""
    cube = trimesh.creation.box((1e3 * EDGE,) * 3)
    cube.apply_translation((7.0, -3.0, 1.0))
    cube.export(tmp_path / "cube.stl")  # mm
    trimesh.creation.icosphere(4, EDGE / 2).export(tmp_path / "ball.ply")
    array = np.ones((3, 3, 3), np.uint8)
    array[1:, :, 1:] = 0
    np.save(tmp_path / "l.npy", array)
    corners = voxels(tmp_path / "l.npy", EDGE / 3).triangles.reshape(-1, 3)
    faces = np.arange(len(corners)).reshape(-1, 3)
    trimesh.Trimesh(corners, faces[:, ::-1]).export(tmp_path / "l.obj")  # inside out
    grid = (np.indices((64, 64, 64)) + 0.5) / 64 - 0.5
    np.save(tmp_path / "ball.npy", (grid**2).sum(axis=0) < 0.25)
    return tmp_path


def body(file, dim=8, radius=0.0125, scale=1.0, **properties):
    defaults = {
        "shape": "mesh",
        "file": str(file),
        "scale": scale,
        "density": 800.0,
        "material": "a",
    }
    return defaults | {"agglomerate": {"dim": dim, "sphere_radius": radius}} | properties


def exact_l():
    """Volume, centre from the corner, and inertia of the L, from its two bars."""
    w = EDGE / 3
    bars = [((w, EDGE, EDGE), (0.5 * w, 1.5 * w, 1.5 * w))]
    bars += [((2 * w, EDGE, w), (2 * w, 1.5 * w, 0.5 * w))]
    volumes = np.array([np.prod(size) for size, _ in bars])
    centre = sum(v * np.array(c) for v, (_, c) in zip(volumes, bars, strict=True)) / volumes.sum()
    inertia = np.zeros((3, 3))
    for v, (size, middle) in zip(volumes, bars, strict=True):
        square, r = np.array(size) ** 2, np.array(middle) - centre
        inertia += v / 12 * np.diag(square.sum() - square) + v * (
            r @ r * np.eye(3) - np.outer(r, r)
        )
    return volumes.sum(), centre, inertia


def exact_ball():
    volume = np.pi / 6 * EDGE**3
    return volume, NOTHING, volume * EDGE**2 / 10 * np.eye(3)


@pytest.mark.parametrize(
    ("file", "scale", "exact", "tolerance"),
    [
        ("cube.stl", 1e-3, (EDGE**3, NOTHING, EDGE**5 / 6 * np.eye(3)), 1e-6),
        ("ball.ply", 1.0, exact_ball(), 1e-2),
        ("ball.npy", EDGE / 64, exact_ball(), 1e-2),
        ("l.obj", 1.0, exact_l(), 1e-6),
        ("l.npy", EDGE / 3, exact_l(), 1e-12),
    ],
)
def test_volume_and_inertia_are_those_of_the_shape(files, file, scale, exact, tolerance):
    shape = agglomerate(str(files / file), scale, 8, 0.0125)
    volume, _, inertia = exact
    assert shape.volume == pytest.approx(volume, rel=tolerance)
    np.testing.assert_allclose(shape.inertia, inertia, atol=tolerance * np.abs(inertia).max())
    assert 50 < len(shape.centres) < 500
    scene = build([body(files / file, scale=scale)])
    assert scene.mass[0] == pytest.approx(800.0 * volume, rel=tolerance)


def test_spheres_touch_a_cube_from_within(files):
    cube = agglomerate(str(files / "cube.stl"), 1e-3, 8, 0.0125)
    assert len(cube.centres) == 8**3 - 6**3
    np.testing.assert_allclose(np.abs(cube.centres).max(axis=1), 0.5 * EDGE - 0.0125, rtol=1e-6)


def test_spheres_of_an_l_lie_in_it_and_its_centre_is_its_own(files):
    shape = agglomerate(str(files / "l.obj"), 1.0, 8, 0.0125)
    x, y, z = (shape.centres + exact_l()[1]).T
    assert min(x.min(), y.min(), z.min()) == pytest.approx(0.0125, rel=1e-3)
    assert max(x.max(), y.max(), z.max()) == pytest.approx(EDGE - 0.0125, rel=1e-3)
    notch = np.hypot(
        np.maximum(EDGE / 3 - x, 0.0), np.maximum(EDGE / 3 - z, 0.0)
    )  # m, distance from the edge
    assert notch.min() > 0.0125 * 0.999
    assert np.isclose(notch, 0.0125, rtol=1e-3).sum() > 30  # spheres touch it


def test_spheres_touch_a_ball_on_every_side(files):
    ball = agglomerate(str(files / "ball.ply"), 1.0, 8, 0.0125)
    directions = np.random.default_rng(1).normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    reach = (directions @ ball.centres.T).max(axis=1) + ball.radius  # m, extent in each direction
    assert reach.max() < 0.5 * EDGE * 1.001
    assert reach.min() > 0.5 * EDGE * 0.97


def test_spheres_of_one_body_never_touch(files):
    """The spheres overlap by a fifth; a free body still keeps its angular momentum and energy."""
    free = build(
        [body(files / "l.obj", radius=0.0125, angular_velocity=[3.0, 2.0, 1.0])], gravity=NOTHING
    )
    start = free.totals()
    run(free, 0.5)
    assert free.state.report[DEEPEST_PAIR] == -1 and free.state.report[ELASTIC_ENERGY] == 0.0
    np.testing.assert_allclose(free.totals().angular_momentum, start.angular_momentum, rtol=1e-12)
    assert free.totals().kinetic == pytest.approx(start.kinetic, rel=1e-4)


def test_a_ball_and_a_cube_of_spheres_come_to_lie_and_are_borne(files):
    materials = {"a": material(youngs_modulus=1e7, restitution=0.2, friction=0.4)}
    bodies = [body(files / "ball.ply", origin=[0.0, 0.0, 0.0755])]
    bodies += [body(files / "cube.stl", scale=1e-3, origin=[0.16, 0.0, 0.0755])]
    pile = build(bodies, materials, planes=[FLOOR], contact_forces=True, impact_speed=0.5)
    run(pile, 0.3)
    outputs = outputs_of(pile)
    assert outputs["motion.position"][1, 2] == pytest.approx(0.075, abs=2e-4)
    assert np.abs(outputs["motion.velocity"]).max() < 1e-4
    np.testing.assert_allclose(outputs["contact.force"][:2, 2], 9.81 * pile.mass, rtol=1e-3)
    np.testing.assert_allclose(outputs["contact.force"].sum(axis=0), 0.0, atol=1e-9)


def test_an_agglomerate_is_sampled_as_the_shape_in_its_file(files):
    ball = build([body(files / "ball.ply")])
    request = {"spacing": 0.02, "depth": 1.0, "inset": 0.01, "mirror": 1.0, "dimensions": 3.0}
    samples = ball.sample({f"motion.{key}": np.array([value]) for key, value in request.items()})
    volume = ball.mass[0] / body(files / "ball.ply")["density"]
    assert samples["motion.volume"].sum() == pytest.approx(volume, rel=1e-12)
    np.testing.assert_allclose(samples["motion.arm"].mean(axis=0), 0.0, atol=1e-3)


def cube_at(place):
    """A cube that shares an edge along z with the cube at 0."""
    return trimesh.creation.box(
        (EDGE,) * 3, trimesh.transformations.translation_matrix([place, place, 0.0])
    )


def test_what_is_wrong_with_a_file_is_told(files):
    cube = trimesh.creation.box((EDGE,) * 3)
    cube.update_faces(np.arange(12) != 5)
    cube.export(files / "open.stl")
    turned = trimesh.creation.box((EDGE,) * 3)
    turned.faces[5] = turned.faces[5, ::-1]
    turned.export(files / "turned.ply")
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    pyramid = trimesh.Trimesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    pyramid.export(files / "pyramid.ply")
    (files / "text.stl").write_text("no triangles here")
    (files / "text.npy").write_text("no array here")
    np.save(files / "flat.npy", np.ones((3, 3)))
    np.save(files / "none.npy", np.zeros((3, 3, 3)))
    np.save(files / "nan.npy", np.pad(np.full((1, 1, 1), np.nan), 1, constant_values=1.0))
    pair = trimesh.util.concatenate([cube_at(0.0), cube_at(EDGE)])
    pair.merge_vertices()
    pair.export(files / "pair.ply")
    wrong_bodies = {
        "bodies.0.file none.stl must lie beside the scene; in its folder": body("none.stl"),
        "must be a closed surface": body(files / "open.stl"),
        "found 3 edges with only one triangle": body(files / "open.stl"),
        "among 11 triangles, as at (": body(files / "open.stl"),
        "found 3 edges between faces with inconsistent orientation": body(files / "turned.ply"),
        "text.stl must be a surface of triangles (STL, OBJ, PLY)": body(files / "text.stl"),
        "text.npy must be one array": body(files / "text.npy"),
        "must have three axes of numbers": body(files / "flat.npy"),
        "of which not all are zero": body(files / "none.npy"),
        "must have finite numbers, 0 outside of the solid; found 1 of 27": body(files / "nan.npy"),
        "found 1 edge with more than two triangles, among 24": body(files / "pair.ply"),
        "Separate the shells that touch there": body(files / "pair.ply"),
        "at most half the shortest edge of the box around the shape, 0.075 m": body(
            files / "ball.ply", radius=0.08
        ),
        "found 0.0125 m for": body(files / "cube.stl"),
        "Make dim 6000 or larger, or sphere_radius larger, or ": body(files / "cube.stl"),
        "must have at most 2000 spheres; dim 40": body(files / "l.npy", 40, scale=0.05),
        "must have room for a sphere within": body(files / "pyramid.ply", 3, 0.3),
        "by file and agglomerate alone (it may have scale and origin); found agglomerate, c": body(
            files / "ball.ply", centre=[0.0, 0.0, 0.0]
        ),
        "bodies.0.agglomerate.dim should be greater than or equal to 2": body("x", 1),
    }  # fmt: skip
    for sentence, wrong_body in wrong_bodies.items():
        assert sentence in " ".join(mistakes([wrong_body])), (sentence, mistakes([wrong_body]))


def test_a_file_is_read_once_for_spheres_mass_and_view(files, monkeypatch):
    read_files, load_mesh = [], trimesh.load_mesh
    monkeypatch.setattr(
        trimesh, "load_mesh", lambda *args: read_files.append(args) or load_mesh(*args)
    )
    build([body(files / "cube.stl", scale=1e-3)]).view()
    assert len(read_files) == 1


@pytest.mark.parametrize("inwards", [False, True])
def test_a_surface_that_is_inside_out_is_turned_with_a_note(files, inwards):
    cube = trimesh.creation.box((EDGE,) * 3)
    if inwards:
        cube.invert()
    cube.export(files / "some.ply")
    (note,) = plan(params([body(files / "some.ply")])).notes
    volume = f"encloses {EDGE**3:.4g} m3"
    assert volume in note
    assert note.endswith("; all its triangles look inwards, and were turned") == inwards


@pytest.mark.parametrize(
    ("edge", "scale", "advised"),
    [
        (0.15, 0.001, "or leave scale out: the shape of a file in m is 0.15 x 0.15 x 0.15 m."),
        (150.0, 1.0, "or set scale = 0.001 for a file in mm: its shape is 0.15 x 0.15 x 0.15 m."),
        (15.0, 1.0, "or set scale = 0.01 for a file in cm: its shape is 0.15 x 0.15 x 0.15 m."),
        (1.5, 1.0, "or correct scale, the length in m of one unit in the file."),
    ],
)
def test_the_scale_that_fits_is_advised(files, edge, scale, advised):
    trimesh.creation.box((edge,) * 3).export(files / "some.stl")
    (text,) = mistakes([body(files / "some.stl", 8, 0.0125, scale=scale)])
    assert text.endswith(advised)


def test_a_file_is_looked_for_in_the_scenes_folder_only(files, monkeypatch):
    other_folder = files / "elsewhere"
    other_folder.mkdir()
    scene = {"bodies": [body("ball.ply")], "materials": {"a": material()}}
    parsed, errors = read(DemBodiesParams, scene, "bodies", files)
    assert not errors and parsed.bodies[0].file == str(files / "ball.ply")
    monkeypatch.chdir(files)
    monkeypatch.syspath_prepend(files)
    assert "must lie beside the scene" in read(DemBodiesParams, scene, "bodies", other_folder)[1][0]


def test_bodies_that_start_in_one_another_are_refused(files):
    pair = [body(files / "ball.ply"), body(files / "ball.ply", origin=[0.14, 0.0, 0.0])]
    assert "bodies[0] and bodies[1] must not overlap" in " ".join(mistakes(pair))
    assert not mistakes([pair[0], pair[1] | {"origin": [0.16, 0.0, 0.0]}])
