"""Tanks and obstacles from files: their wall particles, water at rest in them, and defects."""

import numpy as np
import pytest
import trimesh
from fluid_params import fluid_params
from scipy.spatial import cKDTree

from quintet.components.shared.geometry import mesh_files
from quintet.components.sph_fluid.boundary.obstacles import (
    from_meshes,
    obstacle_mirrors,
    obstacle_points,
)
from quintet.components.sph_fluid.boundary.walls import wall_points
from quintet.components.sph_fluid.build import state
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.plan import particles
from quintet.components.sph_fluid.setup.boundary_meshes import BoundaryMesh
from quintet.components.sph_fluid.setup.mesh_surfaces import Surface
from quintet.interfaces.errors import SceneError

SPACING, ORIGIN = 0.05, (0.0, 0.0, 0.0)
LOW, HIGH = (0.6, 0.2, 0.0), (1.0, 0.6, 0.4)  # m, a box on the floor
DAM = {
    "spacing": SPACING,
    "sound_speed": 40.0,
    "fluid": [(ORIGIN, (0.4, 0.8, 0.5))],
    "boundary.walls": (ORIGIN, (1.6, 0.8, 0.8)),
    "boundary.method": "mdbc",
    "viscosity.artificial": 0.1,
}


def export_mesh(mesh, folder, name="mesh.obj"):
    mesh.export(folder / name)
    return str(folder / name)


def block(folder, low=LOW, high=HIGH, name="mesh.obj"):
    return export_mesh(trimesh.creation.box(bounds=[low, high]), folder, name)


def dam(*meshes, **options):
    return fluid_params(**(DAM | {"boundary.meshes": list(meshes)} | options))


def match_points(points, other_points):
    """Greatest distance between points of two sets, and rows of the second, one for each."""
    distance, row = cKDTree(other_points).query(points)
    assert len(points) == len(other_points) == len(set(row.tolist()))
    return distance.max(), row


@pytest.mark.parametrize("method", ["mdbc", "dbc"])
@pytest.mark.parametrize(("name", "close"), [("mesh.obj", 1e-7), ("mesh.stl", 1e-6)])
def test_a_box_from_a_file_has_the_particles_of_the_built_in_one(tmp_path, name, close, method):
    box_params = fluid_params(
        **(DAM | {"boundary.obstacles": [(LOW, HIGH)], "boundary.method": method})
    )
    mesh_params = dam({"file": block(tmp_path, name=name)}, **{"boundary.method": method})
    points, mirrors = from_meshes(mesh_params)
    distance, row = match_points(points, obstacle_points(box_params))
    assert distance < close
    assert np.abs(mirrors - obstacle_mirrors(box_params)[row]).max() < close
    assert (
        particles(mesh_params) == particles(box_params) == len(state(mesh_params).position_density)
    )


def test_particles_begin_at_the_offset_that_the_scene_sets(tmp_path):
    options = {"boundary.method": "dbc", "boundary.wall_offset": 1.0}
    points, _ = from_meshes(dam({"file": block(tmp_path)}, **options))
    depth = np.minimum(points - np.array([*LOW[:2], -1.0]), np.array(HIGH) - points).min(axis=1)
    assert depth.min() == pytest.approx(SPACING, rel=1e-6)
    assert depth.max() < 2.0 * 1.5 * SPACING  # the fluid feels no others


def test_water_meets_a_box_from_a_file_as_the_built_in_one(tmp_path):
    """Rows have another order, so that sums differ by rounding."""
    box_params = fluid_params(**(DAM | {"boundary.obstacles": [(LOW, HIGH)]}))
    mesh_params = dam({"file": block(tmp_path)})
    ends = []
    for params in (box_params, mesh_params):
        fluid, time = SphFluid(params), 0.0
        while time < 0.35:
            dt = min(fluid.stable_dt(), 0.35 - time)
            fluid.step(dt)
            time += dt
        ends.append(fluid.view())
    assert ends[0]["points"][:, 0].max() > 0.6  # it has met the box
    assert np.abs(ends[0]["points"] - ends[1]["points"]).max() < 1e-3 * SPACING
    assert ends[0]["pressure"] == pytest.approx(ends[1]["pressure"], abs=5.0)  # Pa


def tank(folder, lid, name="tank.stl"):
    """A cylinder about z, of radius 0.2 m and 0.4 m high; its triangles look outwards."""
    solid_mesh = trimesh.creation.cylinder(radius=0.2, height=0.4, sections=48)
    solid_mesh.apply_translation([0.0, 0.0, 0.2])
    if not lid:
        solid_mesh.update_faces(solid_mesh.triangles_center[:, 2] < 0.399)
    return export_mesh(solid_mesh, folder, name)


def filled_tank(file, surface, radius=0.19):
    water = {"shape": "cylinder", "base": ORIGIN, "top": (0.0, 0.0, 0.2), "radius": radius}
    return fluid_params(
        spacing=0.025,
        sound_speed=20.0,
        kernel="wendland",
        density_diffusion=0.1,
        fluid=[water],
        viscosity__artificial=0.1,
        boundary__method="mdbc",
        boundary__meshes=[{"file": file, "surface": surface, "fluid_side": "back"}],
        gauges__pressure_gauges=[[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.0, 0.1]],
    )


@pytest.mark.parametrize("surface", ["closed", "open"])
def test_water_rests_in_a_round_tank_under_its_weight(tmp_path, surface):
    params = filled_tank(tank(tmp_path, surface == "closed"), surface)
    fluid, time, readings = SphFluid(params), 0.0, []
    while time < 0.6:
        dt = fluid.stable_dt()
        fluid.step(dt)
        time += dt
        if time > 0.4:
            names = frozenset(["pressure_gauge.pressure"])
            readings.append(fluid.give(names)["pressure_gauge.pressure"])
    view = fluid.view()
    points = view["points"]
    assert np.hypot(points[:, 0], points[:, 1]).max() < 0.2  # none leaves
    assert points[:, 2].min() > -0.5 * params.spacing
    assert np.sqrt((view["velocity"] ** 2).sum(axis=1).mean()) < 0.05  # m/s; √(g h) is 1.4
    area = 24.0 * np.sin(2.0 * np.pi / 48.0) * 0.2**2  # m2, of the polygon
    level = fluid.totals().mass / (1000.0 * area)
    middle, aside, above = np.mean(readings, axis=0).ravel()
    # Water stands higher than its mass in the tank: by 6.2 % with 8 spacings in the radius.
    assert middle == pytest.approx(9810.0 * level, rel=0.07)
    assert aside == pytest.approx(middle, rel=0.02)
    assert middle - above == pytest.approx(981.0, rel=0.03)


def test_an_open_tank_has_no_particles_above_its_rim(tmp_path):
    closed, _ = from_meshes(filled_tank(tank(tmp_path, True), "closed"))
    file = tank(tmp_path, False, "open.stl")
    params = filled_tank(file, "open")
    points, _ = from_meshes(params)
    assert points[:, 2].max() < 0.4 + 0.1 * params.spacing
    lower = (closed[:, 2] < 0.35).sum()
    assert (points[:, 2] < 0.35).sum() == pytest.approx(lower, rel=0.03)
    assert any("its rims have 48 edges, and a hole in it would be one" in n for n in params.notes)


def test_the_volume_of_layers_is_measured_in_slabs(tmp_path, monkeypatch):
    sizes, depths = [], Surface.depths

    def count_points(surface, points):
        sizes.append(len(points))
        return depths(surface, points)

    monkeypatch.setattr(Surface, "depths", count_points)
    from_meshes(filled_tank(tank(tmp_path, False), "open"))
    assert 24**3 <= max(sizes) < 3 * 24**3  # places in the box around, a spacing apart


@pytest.mark.parametrize("shape", ["ball", "ring", "brick"])
def test_depths_are_those_of_the_nearest_place(tmp_path, shape):
    solid_mesh = {
        "ball": lambda: trimesh.creation.icosphere(subdivisions=2, radius=0.5),
        "ring": lambda: trimesh.creation.torus(0.5, 0.2, 16, 12),
        "brick": lambda: trimesh.creation.box(extents=(1.0, 0.6, 0.3)),
    }[shape]()
    file = export_mesh(solid_mesh, tmp_path)
    surface = Surface(BoundaryMesh(file=file), 0.05, 0.15)
    solid_mesh = trimesh.load_mesh(file)  # its digits
    rng = np.random.default_rng(3)
    places = rng.uniform(-0.8, 0.8, (600, 3))
    depth, normal = surface.depths(places)
    is_near = np.abs(depth) < 0.15
    assert is_near.sum() > 50
    feet = mesh_files.nearest(places, solid_mesh.triangles)
    inside = mesh_files.inside(places, solid_mesh.triangles)
    assert np.array_equal(depth > 0.0, inside)
    distance = np.linalg.norm(places - feet, axis=1)
    assert np.abs(depth)[is_near] == pytest.approx(distance[is_near], abs=1e-9)
    ordinary = is_near & (np.linalg.norm(normal, axis=1) < 1.0 + 1e-9)
    surface_places = places + depth[:, None] * normal
    assert np.abs(surface_places - feet)[ordinary].max() < 1e-7
    assert (np.abs(depth[~is_near]) > 0.15).all()


def test_a_surface_is_scaled_turned_and_moved(tmp_path):
    flat_file = block(tmp_path, (-1.0, -2.0, 0.0), (1.0, 2.0, 3.0))
    half = 0.5**0.5
    transform = {"scale": 0.1, "orientation": [half, 0.0, 0.0, half], "origin": [0.8, 0.4, 0.2]}
    upright_file = block(tmp_path, (0.6, 0.3, 0.2), (1.0, 0.5, 0.5), "same.obj")
    first, _ = from_meshes(dam({"file": flat_file} | transform))
    second, _ = from_meshes(dam({"file": upright_file}))
    distance, _ = match_points(first, second)
    assert distance < 1e-9


def test_what_is_drawn_has_the_triangles(tmp_path):
    walls = SphFluid(dam({"file": block(tmp_path)})).walls()
    assert len(walls["cells"]) == 5 + 12


def open_box(folder):
    solid_mesh = trimesh.creation.box(bounds=[LOW, HIGH])
    solid_mesh.update_faces(np.arange(12) > 1)
    return export_mesh(solid_mesh, folder)


def overlapping_boxes(folder):
    solid_mesh = trimesh.creation.box(bounds=[LOW, HIGH])
    second_mesh = solid_mesh.copy()
    second_mesh.apply_translation([0.1, 0.0, 0.0])
    return export_mesh(trimesh.util.concatenate([solid_mesh, second_mesh]), folder)


def mixed_triangles(folder):
    corners = [[0.6, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.4, 0.0], [0.6, 0.4, 0.0]]
    faces = [[0, 1, 2], [0, 3, 2]]
    return export_mesh(trimesh.Trimesh(corners, faces, process=False), folder)


def fan(folder):
    corners = [[0.6, 0.0, 0.0], [1.0, 0.0, 0.0], [0.8, 0.4, 0.0], [0.8, 0.0, 0.4], [0.8, 0.4, 0.4]]
    faces = [[0, 1, 2], [0, 1, 3], [0, 1, 4]]
    return export_mesh(trimesh.Trimesh(corners, faces, process=False), folder)


DEFECTS = {
    "hole": (open_box, {}, "closed surface, .* found 4 edges with only one triangle, among 10"),
    "overlap": (overlapping_boxes, {}, r"enclose each part of its volume once; found .*%"),
    "two sides": (
        mixed_triangles,
        {"surface": "open"},
        "triangles whose normals all point to the same side",
    ),
    "three at an edge": (fan, {"surface": "open"}, "one or two triangles at each edge; found 1 "),
    "no fluid": (block, {"fluid_side": "back"}, r"all fluid 0.25 spac.* found 1280 of 1280 .*far"),
    "not a unit": (block, {"orientation": [1.0, 1.0, 0.0, 0.0]}, "of length 1; found 1.41421"),
}


@pytest.mark.parametrize(("make", "keys", "reason"), DEFECTS.values(), ids=DEFECTS)
def test_surfaces_that_cannot_be_walls_are_refused(tmp_path, make, keys, reason):
    with pytest.raises((SceneError, ValueError), match=rf"boundary.meshes.*{reason}"):
        dam({"file": make(tmp_path)} | keys)


def test_a_thin_plate_is_refused_with_its_thickness(tmp_path):
    file = block(tmp_path, (0.6, 0.2, 0.1), (0.69, 0.6, 0.5))
    with pytest.raises(ValueError, match=r"2 spacings, 0.1 m, or more .*found 0.09 m behind"):
        dam({"file": file})
    assert len(from_meshes(dam({"file": file}, spacing=0.04))[0])


def test_water_in_a_mesh_is_refused(tmp_path):
    file = block(tmp_path, (0.3, 0.2, 0.1), (0.6, 0.6, 0.5))
    with pytest.raises(ValueError, match=r"found 128 of 1280 .*fluid\[0\] .* one 0.075 m behind"):
        dam({"file": file})


def test_water_that_touches_a_mesh_is_refused(tmp_path):
    file = block(tmp_path, (0.38, 0.2, 0.1), (0.6, 0.6, 0.5))
    with pytest.raises(
        ValueError, match=r"0.0125 m, or more in front of it; .*one 0.005 m in front"
    ):
        dam({"file": file})


def test_meshes_that_overlap_are_refused(tmp_path):
    first, second = block(tmp_path), block(tmp_path, (0.8, 0.4, 0.2), (1.2, 0.8, 0.6), "b.obj")
    with pytest.raises(ValueError, match=r"meshes\[1\] must not overlap boundary.meshes\[0\]; "):
        dam({"file": first}, {"file": second})


def test_a_mesh_in_an_obstacle_is_refused(tmp_path):
    options = {"boundary.obstacles": [((0.9, 0.2, 0.0), (1.3, 0.6, 0.4))]}
    with pytest.raises(ValueError, match=r"not overlap boundary.obstacles\[0\]; 128 of its 492 "):
        dam({"file": block(tmp_path)}, **options)
    file = block(tmp_path, LOW, (0.9, 0.6, 0.4), "beside.obj")
    dam({"file": file}, **options)  # it may touch one


@pytest.mark.parametrize("method", ["mdbc", "dbc"])
def test_a_mesh_has_no_particles_in_a_closed_wall_of_the_tank(tmp_path, method):
    options = {"boundary.method": method}
    standing_points, _ = from_meshes(dam({"file": block(tmp_path)}, **options))
    sunk_file = block(tmp_path, (*LOW[:2], -0.2), name="sunk.obj")
    params = dam({"file": sunk_file}, **options)
    points, _ = from_meshes(params)
    wall_distance, _ = cKDTree(wall_points(params)).query(points)
    assert wall_distance.min() > 0.99 * SPACING
    distance, _ = match_points(points[points[:, 2] > 0.0], standing_points)
    assert distance < 1e-7
    options["boundary.open_faces"] = ["z-", "z+"]
    points, _ = from_meshes(dam({"file": sunk_file}, **options))
    assert points[:, 2].min() < -0.1


OPTIONS = {
    "potential": ({"boundary.method": "potential"}, "found boundary.method potential"),
    "symmetry": ({"boundary.symmetry": ["y-"]}, r"found boundary.symmetry \['y-'\]"),
    "films": ({"boundary.lubrication_films": True}, "films is not available with boundary.m"),
    "staggered": ({"staggered": True}, "staggered is not available with boundary.meshes"),
    "plane": ({"dimensions": 2}, "found dimensions 2"),
    "gauge": (
        {"gauges.pressure_gauges": [[0.8, 0.4, 0.2]]},
        r"pressure_gauges\[0\] must not be behind boundary.meshes\[0\]; found \(0.8, 0.4, 0.2\) m",
    ),
    "velocity": (
        {"gauges.velocity_gauges": [[0.3, 0.4, 0.2], [0.8, 0.4, 0.2]]},
        r"velocity_gauges\[1\] must not be behind boundary.meshes\[0\]; found \(0.8, 0.4, 0.2\) m",
    ),
    "buffer": (
        {
            "boundary.walls": (ORIGIN, (1.2, 0.8, 0.8)),
            "boundary.open_faces": ["x+", "z+"],
            "boundary.outflow": [{"face": "x+"}],
        },
        r"meshes\[0\] must stand outside of the buffers of inflows and outflows, 0.25 m",
    ),
}


@pytest.mark.parametrize(("options", "reason"), OPTIONS.values(), ids=OPTIONS)
def test_what_meshes_cannot_go_with_is_refused(tmp_path, options, reason):
    with pytest.raises(ValueError, match=reason):
        dam({"file": block(tmp_path)}, **options)


def test_a_mesh_needs_a_file():
    with pytest.raises(ValueError, match="a mesh needs its file; found none"):
        dam({"scale": 1.0})


def test_an_open_surface_that_is_no_mesh_is_refused(tmp_path):
    (tmp_path / "text.stl").write_text("nothing")
    with pytest.raises(ValueError, match=r"text.stl must be a surface of triangles \(STL"):
        dam({"file": str(tmp_path / "text.stl"), "surface": "open"})
