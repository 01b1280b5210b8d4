"""Parts of the boundary that move by themselves: places, forces, work, and what is refused."""

import numpy as np
import pytest
import trimesh
from fluid_params import fluid_params
from pydantic import ValidationError

from quintet.components.sph_fluid.boundary.parts import moving, standing
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.plan import particles
from quintet.interfaces.component import outputs_of
from quintet.interfaces.errors import OrderError, SceneError, StepError

SPACING = 0.02
TANK = ((-0.1, 0.0, 0.0), (0.4, 1.0, 0.4))
PUSH = {
    "times": [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 2.0],
    "displacement": [[x, 0.0, 0.0] for x in (0.0, 0.005, 0.02, 0.035, 0.04, 0.04, 0.04)],
}
STAY = {"times": [0.0, 9.0], "displacement": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]}
BLOCK = ((0.0, 0.0, 0.0), (0.06, 1.0, 0.4))  # all across the tank
BASE = {
    "spacing": SPACING,
    "sound_speed": 20.0,
    "dimensions": 2,
    "kernel": "wendland",
    "density_diffusion": 0.1,
    "integration": "symplectic",
    "viscosity.artificial": 0.05,
    "boundary.method": "mdbc",
    "boundary.walls": TANK,
    "fluid": [((0.06, 0.0, 0.0), (0.4, 1.0, 0.2))],
}
OBSTACLE = {"boundary.obstacles": [BLOCK]}
WALL = {"boundary.walls": ((0.06, 0.0, 0.0), TANK[1])}


def piston(part, motion):
    return {"boundary.pistons": [{"part": part, "motion": motion}]}


def fluid_with(*tables):
    settings = dict(BASE)
    for table in tables:
        settings |= table
    fluid = SphFluid(fluid_params(**settings))
    fluid.bind({}, frozenset())
    return fluid


def piston_x(fluid):
    return fluid.state.position_density[fluid.samples.row, 0]


@pytest.mark.parametrize("method", ["mdbc", "dbc"])
@pytest.mark.parametrize(("tables", "part"), [((OBSTACLE,), "obstacles.0"), ((WALL,), "walls.x-")])
def test_a_part_that_is_told_to_stay_acts_as_one_that_stands(tables, part, method):
    still = fluid_with(*tables, {"boundary.method": method})
    with_piston = fluid_with(*tables, {"boundary.method": method}, piston(part, STAY))
    assert still.items() == with_piston.items() == particles(with_piston.params)
    for fluid in (still, with_piston):
        for _ in range(20):
            fluid.step(5e-4)
    field = "position_density"
    still_positions, piston_positions = (
        getattr(f.state, field)[: f.state.fluid] for f in (still, with_piston)
    )
    still_order, piston_order = (
        np.argsort(still.state.identity),
        np.argsort(with_piston.state.identity),
    )
    assert still_positions[still_order] == pytest.approx(piston_positions[piston_order], abs=1e-9)
    assert with_piston.totals().work == 0.0


@pytest.mark.parametrize(("tables", "part"), [((OBSTACLE,), "obstacles.0"), ((WALL,), "walls.x-")])
def test_a_piston_goes_where_its_table_says_and_pushes_the_fluid_before_it(tables, part):
    fluid = fluid_with(*tables, piston(part, PUSH))
    begin = piston_x(fluid).copy()
    for _ in range(500):
        fluid.step(5e-4)
    middle = 0.5 * (499 + 500) * 5e-4
    shift = fluid.params.boundary.pistons[0].motion.trajectory.at(middle).place[0]
    assert np.sort(piston_x(fluid)) == pytest.approx(np.sort(begin) + shift, abs=1e-12)
    x = fluid.state.position_density[: fluid.state.fluid, 0]
    assert x.min() > 0.06 + shift
    assert fluid.state.lost == 0


def test_the_work_of_a_slow_push_lifts_the_water():
    """Energy relative to a tank at rest; mirrored walls keep energy within 6 %."""
    still, pushed = fluid_with(OBSTACLE), fluid_with(OBSTACLE, piston("obstacles.0", PUSH))
    energies = {}
    for fluid in (still, pushed):
        for _ in range(1000):
            fluid.step(5e-4)
        totals = fluid.totals()
        energies[fluid] = totals.kinetic + totals.potential + totals.internal
    width, depth, weight = 0.34, 0.2, 9.81 * 1000.0
    lifted = 0.5 * weight * width * depth**2 * (width / (width - 0.04) - 1.0)
    work = pushed.totals().work
    assert work == pytest.approx(lifted, rel=0.25)  # waves have the rest
    gained = energies[pushed] - energies[still]
    assert gained == pytest.approx(work, rel=0.06)


def test_a_piston_moves_as_samples_of_a_link_do_to_the_bit():
    pushed = fluid_with(OBSTACLE, piston("obstacles.0", PUSH))
    part, trajectory = pushed.pistons.parts[0], pushed.pistons.parts[0].trajectory
    linked = SphFluid(fluid_params(**BASE))
    count = len(part.points)
    volume = pushed.samples.volume
    static = {"normal": np.zeros((count, 3)), "volume": volume, "body": np.zeros(count)}
    linked.bind({f"surface.{k}": v for k, v in static.items()}, frozenset({"surface"}))
    dt, time = 5e-4, 0.0
    for _ in range(200):
        begin, middle, end = (trajectory.at(time + share * dt).place[:3] for share in (0, 0.5, 1))
        fields = {
            "surface.position": part.points + middle,
            "surface.velocity": ((part.points + end) - (part.points + begin)) / dt,
            "surface.mirror": part.images + middle,
        }
        linked.take(fields)
        linked.step(dt)
        pushed.step(dt)
        time += dt
    for field in ("position_density", "velocity_pressure", "force"):
        assert np.array_equal(getattr(linked.state, field), getattr(pushed.state, field)), field
    assert np.abs(pushed.state.force).max() > 0.0
    assert len(outputs_of(pushed)["surface_load.force"]) == 0


def test_samples_of_links_stand_before_those_of_pistons():
    fluid = SphFluid(fluid_params(**BASE | OBSTACLE | piston("obstacles.0", PUSH)))
    static = {"normal": np.zeros((2, 3)), "volume": np.full(2, SPACING**2), "body": np.zeros(2)}
    fluid.bind({f"surface.{k}": v for k, v in static.items()}, frozenset({"surface"}))
    with pytest.raises(OrderError, match="must be placed first"):
        fluid.step(5e-4)
    places = np.array([[0.2, 0.5, 0.3], [0.22, 0.5, 0.3]])
    fields = {"position": places, "velocity": np.zeros((2, 3)), "mirror": places}
    fluid.take({f"surface.{k}": v for k, v in fields.items()})
    fluid.step(5e-4)
    assert len(outputs_of(fluid)["surface_load.force"]) == 2
    assert fluid.state.position_density[fluid.samples.row[:2], :3] == pytest.approx(places)
    assert piston_x(fluid)[2:].max() < 0.06


def test_a_flap_turns_about_its_axis():
    flap = {
        "period": 0.8,
        "angle_amplitude": 0.3,
        "axis": [0.0, 1.0, 0.0],
        "point": [0.1, 0.5, 0.0],
    }
    obstacle = {"boundary.obstacles": [((0.02, 0.0, 0.1), (0.06, 1.0, 0.4))]}
    fluid = fluid_with(
        obstacle, piston("obstacles.0", flap), {"fluid": [((0.1, 0, 0), (0.4, 1, 0.2))]}
    )
    points = fluid.pistons.parts[0].points
    for _ in range(100):
        fluid.step(5e-4)
    angle = 0.3 * np.sin(2 * np.pi * 99.5 * 5e-4 / 0.8)
    x, z = points[:, 0] - 0.1, points[:, 2]
    expected = 0.1 + np.cos(angle) * x + np.sin(angle) * z
    assert np.sort(piston_x(fluid)) == pytest.approx(np.sort(expected), abs=1e-9)


@pytest.mark.parametrize("scheme", ["extrapolated", "symplectic"])
def test_a_saved_state_goes_on_with_the_same_bits(scheme):
    def make():
        return fluid_with(OBSTACLE, piston("obstacles.0", PUSH), {"integration": scheme})

    first, second = make(), make()
    for _ in range(150):
        first.step(5e-4 if scheme == "symplectic" else 2e-4)
    second.load(first.save())
    for _ in range(50):
        for fluid in (first, second):
            fluid.step(5e-4 if scheme == "symplectic" else 2e-4)
    for name, array in first.save().items():
        assert np.array_equal(array, second.save()[name]), name
    assert first.totals().work != 0.0


def test_a_body_on_the_floor_beside_a_piston_has_no_film_and_a_note_says_why():
    settings = BASE | OBSTACLE | {"fluid": [((0.16, 0.0, 0.0), (0.4, 1.0, 0.2))]}
    fluid = SphFluid(fluid_params(**settings, **piston("obstacles.0", STAY)))
    x, z = np.meshgrid([0.11, 0.13, 0.15], [0.01, 0.03, 0.05])
    places = np.stack([x.ravel(), np.full(9, 0.5), z.ravel()], axis=1)
    zeros = np.zeros((9, 3))
    static = {"normal": zeros, "volume": np.full(9, SPACING**2), "body": np.zeros(9)}
    fluid.bind({f"surface.{k}": v for k, v in static.items()}, frozenset({"surface"}))
    fluid.take({"surface.position": places, "surface.velocity": zeros, "surface.mirror": places})
    fluid.step(2e-4)
    (note,) = [note for note in fluid.notes() if "touches a wall" in note]
    assert note.startswith("body 0 ")
    assert "films are not available with boundary.pistons" in note


def test_a_state_of_a_piston_on_its_way_is_no_start():
    first, second = (fluid_with(OBSTACLE, piston("obstacles.0", PUSH)) for _ in range(2))
    for _ in range(250):
        first.step(5e-4)
    displacement = first.params.boundary.pistons[0].motion.trajectory.at(250 * 5e-4).place[0]
    with pytest.raises(
        SceneError, match=f"within 0.02 spacings; found {displacement:.3g} m between"
    ):
        second.begin_from(first.save())


def test_water_that_settled_before_a_piston_at_rest_can_be_pushed():
    first = fluid_with(OBSTACLE, piston("obstacles.0", STAY))
    second = fluid_with(OBSTACLE, piston("obstacles.0", PUSH))
    first.step(5e-4)
    second.begin_from(first.save())
    second.step(5e-4)
    assert second.save()["pistons"][0] == 5e-4


def test_a_state_without_the_piston_is_refused():
    saved = fluid_with(OBSTACLE).save()
    pushed = fluid_with(OBSTACLE, piston("obstacles.0", PUSH))
    count = len(pushed.samples.volume)
    with pytest.raises(SceneError, match=f"its {count} samples of bodies and pistons; found 0"):
        pushed.begin_from(saved)


def test_a_step_beyond_the_table_is_refused():
    motion = {"times": [0.0, 1e-3], "displacement": [[0, 0, 0], [1e-6, 0, 0]]}
    fluid = fluid_with(OBSTACLE, piston("obstacles.0", motion))
    fluid.step(1e-3)
    with pytest.raises(StepError, match=r"table of one ends at 0.001 s, and a step goes on to"):
        fluid.step(1e-3)


def test_what_stands_and_what_moves_is_all_there_is():
    params = fluid_params(**BASE | OBSTACLE | WALL | piston("walls.x+", STAY))
    fixed_params = fluid_params(**BASE | OBSTACLE | WALL)
    parts = [standing(params), moving(params, params.boundary.pistons[0])]
    points = np.concatenate([p for p, _ in parts])
    assert sorted(map(tuple, points)) == sorted(map(tuple, standing(fixed_params)[0]))
    assert {len(p) - len(images) for p, images in parts} == {0}


OUT = {"times": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [-0.1, 0.0, 0.0]]}
AHEAD = {"times": [0.0, 1.0], "displacement": [[0.08, 0.0, 0.0], [0.0, 0.0, 0.0]]}
LEANING = {"times": [0.0, 1.0], "angle": [0.2, 0.0], "axis": [0.0, 1.0, 0.0]}
ALONG = {"times": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [0.25, 0.0, 0.0]]}
FAR = {"times": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [0.6, 0.0, 0.0]]}
DRY = {"fluid": [((0.06, 0.0, 0.0), (0.2, 1.0, 0.2))]}
POST = DRY | {"boundary.obstacles": [BLOCK, ((0.26, 0.0, 0.0), (0.3, 1.0, 0.4))]}
NO_POST = {"boundary.obstacles": []}
LATE = {"times": [0.0, 1.0, 1.2], "displacement": [[0, 0, 0], [0, 0, 0], [0.1, 0, 0]]}
UP = {"times": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.1]]}
TURN = {"period": 1.0, "angle_amplitude": 0.1, "axis": [1.0, 0.0, 0.0]}
DEEP = {"dimensions": 3}


@pytest.mark.parametrize(
    ("part", "motion", "changes", "match"),
    [
        ("wall.x-", PUSH, {}, "part must be one of walls.x-, walls.x"),
        ("obstacles.00", PUSH, {}, "with a number N from 0 on; found obstacles.00"),
        ("obstacles.one", PUSH, {}, "with a number N from 0 on; found obstacles.one"),
        ("walls.z+", PUSH, {}, r"must be a closed face of the tank, x-, x\+, z-; found walls\.z"),
        ("obstacles.3", PUSH, {}, "one of the 1 entries of boundary.obstacles, numbered from 0"),
        ("meshes.0", PUSH, {}, "one of the 0 entries of boundary.meshes"),
        ("walls.x-", OUT, {}, r"must move into the tank.*found displacements of -0.1 m along x"),
        ("obstacles.0", AHEAD, {}, r"must begin at no displacement.*found 0.08 m and 0 rad"),
        ("obstacles.0", LEANING, {}, r"must begin at no displacement.*found 0 m and 0.2 rad"),
        ("obstacles.0", ALONG, POST, r"must not go through boundary.obstacles\[1\], which stands"),
        ("walls.x-", ALONG, POST, r"must not go through boundary.obstacles\[0\], which stands"),
        ("walls.x-", FAR, NO_POST, "opposite face, 0.5 m away; found a displacement of 0.6 m"),
        ("obstacles.0", FAR, {}, r"must stay in the tank; found it beyond the wall x\+ on its way"),
        ("walls.x-", LATE, {}, r"found displacements of -0\.0\d+ m along x"),
        ("walls.x-", {"period": 1.0, "amplitude": [0.1, 0, 0]}, {}, "must move into the tank"),
        ("walls.x-", UP, {}, "must move along x alone"),
        ("walls.x-", PUSH, {"boundary.wall_velocity": {"x-": [0, 0, 1.0]}}, "wall_velocity too"),
        ("obstacles.0", UP, {}, "must stay on the wall z- that it touches"),
        ("obstacles.0", TURN, {}, "in the plane of x and z in two dimensions"),
        ("obstacles.0", PUSH, {"boundary.symmetry": ["x+"]}, "plane of boundary.symmetry x"),
        ("obstacles.0", PUSH, {"boundary.method": "potential"}, "need boundary.method mdbc or dbc"),
        ("obstacles.0", PUSH, DEEP | {"boundary.lubrication_films": True}, "films is not avail"),
    ],
)
def test_a_piston_that_cannot_move_so_is_refused(part, motion, changes, match):
    with pytest.raises(ValidationError, match=match):
        fluid_params(**BASE | OBSTACLE | piston(part, motion) | changes)


THROUGH = ((0.1, 0.2, -0.08), (0.3, 0.4, 0.2))  # through the floor


def through_the_floor(folder, form):
    """A block that stands 0.08 m deep in the floor, from the scene or from a file."""
    settings = BASE | DEEP | {"fluid": [((0.32, 0.0, 0.0), (0.4, 0.4, 0.2))]}
    settings |= {"boundary.walls": ((0.0, 0.0, 0.0), (0.4, 0.6, 0.4))}
    if form == "obstacles":
        return settings | {"boundary.obstacles": [THROUGH]}
    file = str(folder / "block.obj")
    trimesh.creation.box(bounds=THROUGH).export(file)
    return settings | {"boundary.meshes": [{"file": file}]}


@pytest.mark.parametrize("form", ["obstacles", "meshes"])
def test_a_part_that_rises_out_of_a_wall_has_particles_all_around(tmp_path, form):
    settings = through_the_floor(tmp_path, form) | piston(f"{form}.0", UP)
    params = fluid_params(**settings)
    points, images = moving(params, params.boundary.pistons[0])
    low, high = np.array(THROUGH)
    outermost = [points.min(axis=0) - low, high - points.max(axis=0)]
    assert outermost == pytest.approx(np.full((2, 3), 0.5 * SPACING), abs=1e-6)
    middle = np.abs(points[:, :2] - 0.5 * (low + high)[:2]).max(axis=1) < SPACING
    under = middle & (points[:, 2] < low[2] + SPACING)
    assert under.sum() == 4
    assert images[under, 2] == pytest.approx(low[2] - 0.5 * SPACING, abs=1e-6)
    assert particles(params) == SphFluid(params).items() + len(points)


@pytest.mark.parametrize(("part", "count"), [("obstacles.0", 4), ("walls.x-", 1)])
def test_pictures_show_pistons_where_they_are(part, count):
    tables = (OBSTACLE,) if part == "obstacles.0" else (WALL,)
    still, fluid = fluid_with(*tables), fluid_with(*tables, piston(part, PUSH))
    assert (fluid.walls_move, still.walls_move) == (True, False)
    before = fluid.walls()
    assert len(before["cells"]) == len(still.walls()["cells"])
    assert np.abs(before["points"]).sum() == pytest.approx(np.abs(still.walls()["points"]).sum())
    for _ in range(200):
        fluid.step(5e-4)
    after = fluid.walls()
    assert np.array_equal(after["cells"], before["cells"])
    shift = after["points"] - before["points"]
    expected = np.zeros_like(shift)
    expected[-4 * count :, 0] = 0.005  # at 0.1 s; pistons stand behind all others
    assert shift == pytest.approx(expected, abs=1e-12)


FREE = ((0.02, 0.0, 0.1), (0.06, 1.0, 0.4))
HUNG = DRY | {"boundary.obstacles": [FREE, ((0.26, 0.0, 0.0), (0.3, 1.0, 0.4))]}


def swing(angle, x=0.04):
    return {
        "times": [0.0, 1.0],
        "angle": [0.0, angle],
        "axis": [0.0, 1.0, 0.0],
        "point": [x, 0.5, 0.4],
    }


@pytest.mark.parametrize(
    ("motion", "match"),
    [
        (swing(-1.2), r"must not go through boundary.obstacles\[1\], which stands"),
        (swing(-6.28), r"must not go through boundary.obstacles\[1\], which stands"),
        (swing(3.14, 0.5), r"must stay in the tank; found it beyond the wall x\+ on its way"),
        (swing(3.14, -0.1), "must stay in the tank; found it beyond the wall x- on its way"),
    ],
)
def test_an_obstacle_that_turns_is_refused_where_something_is_in_its_way(motion, match):
    fluid_params(**BASE | HUNG | piston("obstacles.0", swing(-0.7)))
    with pytest.raises(ValidationError, match=match):
        fluid_params(**BASE | HUNG | piston("obstacles.0", motion))


@pytest.mark.parametrize(
    ("way", "match"),
    [
        ([0.1, 0.0, 0.1], r"must not go through boundary.obstacles\[0\], which stands"),
        ([-0.35, 0.0, 0.2], "must stay in the tank; found it beyond the wall x- on its way"),
        ([0.1, 0.0, 0.35], ""),
    ],
)
def test_a_mesh_is_refused_where_something_is_in_its_way(tmp_path, way, match):
    settings = through_the_floor(tmp_path, "meshes")
    settings |= {"fluid": [((0.0, 0.0, 0.0), (0.06, 0.6, 0.1))]}
    settings |= {"boundary.obstacles": [((0.34, 0.2, 0.0), (0.38, 0.4, 0.2))]}
    up = [0.0, 0.0, way[2]]
    motion = {"times": [0.0, 1.0, 1.1, 2.0], "displacement": [[0.0, 0.0, 0.0], up, up, way]}
    if not match:
        fluid_params(**settings | piston("meshes.0", motion))
        return
    with pytest.raises(ValidationError, match=match):
        fluid_params(**settings | piston("meshes.0", motion))


def test_a_part_that_is_moved_twice_is_refused():
    pistons = [{"part": "obstacles.0", "motion": PUSH}] * 2
    with pytest.raises(ValidationError, match=r"found obstacles\.0 twice"):
        fluid_params(**BASE | OBSTACLE, **{"boundary.pistons": pistons})
