"""Links: the ports they join, their refusals, and the fields they carry."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from toy_samples import balls, bodies, bound, cubes, masses

from quintet.components.shared.geometry.surface_samples import disc, polygon
from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.links import maker
from quintet.coupler.coupling.links.direct import join as join_direct
from quintet.coupler.coupling.links.fsi import join as join_fsi
from quintet.coupler.coupling.links.glue import join as join_glue
from quintet.coupler.coupling.links.sampled_structures import FACES_OF_A_MESH, RIGID_BODIES
from quintet.interfaces.component import Field, Port
from quintet.interfaces.errors import LinkError, SceneError
from quintet.interfaces.ports import (
    DIMENSIONS,
    FACES,
    FORCE,
    GLUED,
    GLUED_LOAD,
    LOAD,
    MIRRORED_SURFACE,
    MOTION,
    NODE_GLUE,
    NODE_LOAD,
    PLANAR_MOTION,
    POSITION,
    SURFACE,
    SURFACE_LOAD,
    VELOCITY,
)

WARMTH = Field("heat", (), "W", "impulse")
PORTS = {
    "water": ((SURFACE,), (SURFACE_LOAD,)),
    "cubes": ((LOAD,), (MOTION,)),
    "path": ((), (MOTION,)),
    "plate": ((NODE_LOAD,), (FACES, NODE_GLUE)),
    "rods": ((GLUED,), (GLUED_LOAD,)),
    "puck": ((Port("push", (FORCE, WARMTH)),), (Port("pose", (POSITION, VELOCITY)),)),
    "air": ((Port("flight", (VELOCITY,)),), (Port("drag", (FORCE, WARMTH)),)),
}
STILL = np.array([[1.0, 0.0, 0.0, 0.0]])
TURN = np.array([[np.cos(0.4), 0.0, 0.0, np.sin(0.4)]])


def test_fsi_finds_who_is_who_in_either_order():
    for pair in (("water", "cubes"), ("cubes", "water")):
        link = join_fsi("link", pair, PORTS)
        assert link.structure is RIGID_BODIES
        assert (link.sampling.fluid, link.sampling.body) == ("water", "cubes")
    assert join_fsi("link", ("plate", "water"), PORTS).structure is FACES_OF_A_MESH
    assert len(join_fsi("link", ("water", "path"), PORTS).transfers) == 1  # it takes no load


CHOOSING = replace(SURFACE, static=(*SURFACE.static, Field("contact", (), "1")))


def test_bodies_of_links_one_after_the_other_are_numbered_on():
    counts = {"path": 2, "cubes": 3}
    links = [maker("fsi")(n, {"between": ["water", name]}, PORTS) for n, name in enumerate(counts)]
    descriptions = {name: masses(count) for name, count in counts.items()}
    descriptions["water"] = {"surface.spacing": np.array([0.05]), "surface.depth": np.array([0.1])}
    exchange = Exchange(links, PORTS)
    static = exchange.bind(descriptions, lambda name, request: cubes(0.1, counts[name])(request))
    body = static["water"]["surface.body"]
    assert (np.unique(body) == np.arange(5.0)).all() and (np.diff(body) >= 0.0).all()


@pytest.mark.parametrize(("keys", "mark"), [({}, 0.0), ({"contact": "potential"}, 1.0)])
def test_fsi_tells_the_fluid_which_contact_a_link_asks_for(keys, mark):
    ports = {**PORTS, "water": ((CHOOSING,), (SURFACE_LOAD,))}
    link = maker("fsi")(0, {"kind": "fsi", "between": ["water", "cubes"], **keys}, ports)
    stated = {"surface.spacing": np.array([0.1]), "surface.depth": np.array([0.3])}
    binding = bound(link, {"water": stated, "cubes": masses(1)}, cubes=cubes(0.3))
    (static,) = binding.static.values()
    assert static["surface.contact"].tolist() == [mark] * 27


def test_fsi_says_which_contacts_there_are_and_who_has_none():
    table = {"kind": "fsi", "between": ["water", "cubes"]}
    pattern = r"links.3.contact should be 'walls' or 'potential'; found 'potentials'. Correct it."
    with pytest.raises(SceneError, match=pattern):
        maker("fsi")(3, {**table, "contact": "potentials"}, PORTS)
    second_pattern = (
        "link water-cubes: contact potential needs a fluid that lets links choose.*port surface of "
        "water does not say contact. Remove contact, or choose a boundary of water that does"
    )
    with pytest.raises(SceneError, match=second_pattern):
        maker("fsi")(3, {**table, "contact": "potential"}, PORTS)
    with pytest.raises(SceneError, match="contact"):
        maker("glue")(3, {"between": ["rods", "plate"], "contact": "potential"}, PORTS)


@pytest.mark.parametrize("body", [cubes, balls])
@pytest.mark.parametrize("surface", [SURFACE, MIRRORED_SURFACE])
@pytest.mark.parametrize(("inset", "smallest"), [(0.5, 0.1), (0.0, 0.1), (1.5, 0.3)])
def test_bodies_smaller_than_a_spacing_are_refused(body, surface, inset, smallest):
    link = join_fsi("link", ("water", "cubes"), {**PORTS, "water": ((surface,), (SURFACE_LOAD,))})
    water = {"surface.spacing": 0.1, "surface.depth": 0.3, "surface.inset": 0.1 * inset}
    stated = {key: np.array([value]) for key, value in water.items()}
    with pytest.raises(SceneError) as error_info:
        bound(link, {"water": stated, "cubes": masses(2)}, cubes=body(0.09, 2))
    for words in (
        f"at least {smallest:g} m across",
        "body 0 is 0.09 m",
        "Refine the partner's spacing",
    ):
        assert words in str(error_info.value)


PLANAR = {
    **PORTS,
    "flume": ((replace(SURFACE, requests=(*SURFACE.requests, DIMENSIONS)),), (SURFACE_LOAD,)),
    "discs": ((LOAD,), (PLANAR_MOTION,)),
}


@pytest.mark.parametrize("pair", [("flume", "cubes"), ("water", "discs"), ("flume", "plate")])
def test_fsi_refuses_two_dimensions_beside_three_before_anything_starts(pair):
    with pytest.raises(SceneError, match=r"link a: both sides must have two dimensions or both"):
        join_fsi("a", pair, PLANAR)
    flat = next(name for name in pair if name in ("flume", "discs"))
    with pytest.raises(SceneError, match=f"{flat} has two, .* has three. Set dimensions = 2 in"):
        join_fsi("a", pair[::-1], PLANAR)


OBLONG = np.array([[-0.15, -0.1], [0.15, -0.1], [0.15, 0.1], [-0.15, 0.1]])
FLAT = bodies(partial(disc, 0.4), partial(polygon, OBLONG))


def _stated_surface(**keys):
    stated = {"spacing": 0.05, "depth": 1.0, "dimensions": 2.0, **keys}
    return {f"surface.{name}": np.array([value]) for name, value in stated.items()}


def test_bodies_of_two_dimensions_are_sampled_in_one_row_for_one_metre():
    link = join_fsi("link", ("flume", "discs"), PLANAR)
    binding = bound(link, {"flume": _stated_surface(), "discs": masses(2)}, discs=FLAT)
    static = binding.static["flume"]
    area = np.bincount(static["surface.body"].astype(int), static["surface.volume"])
    np.testing.assert_allclose(area, [np.pi * 0.04, 0.06], rtol=1e-12)
    pose = {name: np.repeat(value, 2, axis=0) for name, value in _pose(1.0, STILL).items()}
    samples = binding.maps[0]({}, {"discs": pose})
    assert not samples["surface.position"][:, 1].any()


def test_what_a_fluid_says_and_what_bodies_are_must_agree():
    link = join_fsi("link", ("flume", "discs"), PLANAR)
    described = {"discs": masses(2)}
    with pytest.raises(SceneError, match=r"both sides must have two.*Make the body a sphere"):
        bound(link, described | {"flume": _stated_surface(dimensions=3.0)}, discs=FLAT)
    with pytest.raises(SceneError, match=r"both sides must have two.*Make the body a disc"):
        bound(link, described | {"flume": _stated_surface()}, discs=cubes(0.3))
    with pytest.raises(SceneError, match=r"at least 0\.25 m across.*body 1 is 0\.2 m"):
        bound(link, described | {"flume": _stated_surface(spacing=0.25)}, discs=FLAT)


def test_fsi_says_what_does_not_fit():
    with pytest.raises(SceneError, match="cubes takes load and gives motion"):
        join_fsi("link", ("cubes", "plate"), PORTS)
    push = Port("load", (Field("force", (3,), "N"),))
    wrong_ports = {**PORTS, "cubes": ((push,), (MOTION,))}
    with pytest.raises(SceneError, match=r"cubes.load.force is instant, the other side's impulse"):
        join_fsi("link", ("water", "cubes"), wrong_ports)


def test_glue_finds_who_is_who_in_either_order():
    for pair in (("rods", "plate"), ("plate", "rods")):
        link = join_glue("glue", pair, PORTS)
        assert (link.particles, link.mesh) == ("rods", "plate")
    with pytest.raises(SceneError, match="water must take a port glued"):
        join_glue("glue", ("water", "plate"), PORTS)


def _cube_in_water():
    link = join_fsi("link", ("water", "cubes"), PORTS)
    water = {"surface.spacing": np.array([0.1]), "surface.depth": np.array([1.0])}
    return bound(link, {"water": water, "cubes": masses(1)}, cubes=cubes(0.4))


def _move(binding, pose):
    """Samples of a cube in a pose."""
    return binding.maps[0]({}, {"cubes": pose})


def _load(binding, force, first, second):
    """Load of a cube that moved from a pose to another, and its moment about the origin."""
    start = {"cubes": first}
    end = {"cubes": second, "water": {"surface_load.force": force}}
    load = binding.maps[1](start, end)
    return load, binding.moment[1](start, end, load)


def _pose(x, turn):
    return {
        "motion.position": np.array([[x, 0.0, 0.0]]),
        "motion.velocity": np.array([[1.0, 2.0, 3.0]]),
        "motion.orientation": turn,
        "motion.angular_velocity": np.array([[0.0, 0.0, 5.0]]),
    }


def test_a_rigid_body_is_sampled_as_the_fluid_asks():
    static = _cube_in_water().static["water"]
    assert static["surface.volume"].sum() == pytest.approx(0.4**3, rel=1e-13)
    assert static["surface.normal"].shape == (64, 3)


def test_loads_are_zero_before_anything_moved():
    """Forces follow from motion: a fluid that has given no force yet puts no load on a body."""
    binding = _cube_in_water()
    load, moment = _load(binding, np.zeros((64, 3)), _pose(1.0, TURN), _pose(1.0, TURN))
    np.testing.assert_array_equal(load["load.force"], np.zeros((1, 3)))
    np.testing.assert_array_equal(load["load.torque"], np.zeros((1, 3)))
    np.testing.assert_array_equal(moment, np.zeros(3))


def test_carrying_the_same_pose_twice_changes_nothing():
    """A link has no memory: its output for two poses does not depend on earlier poses."""
    binding = _cube_in_water()
    force = np.random.default_rng(3).normal(size=(64, 3))
    poses = _pose(1.0, STILL), _pose(1.2, TURN)
    samples, (load, moment) = _move(binding, poses[1]), _load(binding, force, *poses)
    for pose in (_pose(7.0, STILL), poses[1]):
        _move(binding, pose)
        _load(binding, force, pose, pose)
    second_samples, (same_load, same_moment) = (
        _move(binding, poses[1]),
        _load(binding, force, *poses),
    )
    for first, second in ((samples, second_samples), (load, same_load)):
        assert all(first[key].tobytes() == second[key].tobytes() for key in first)
    assert moment.tobytes() == same_moment.tobytes()


def test_loads_act_at_the_middle_of_the_way():
    """Force and moment about the origin equal those of forces halfway between the two poses."""
    binding = _cube_in_water()
    poses = _pose(1.0, STILL), _pose(1.2, TURN)
    first, second = (_move(binding, pose)["surface.position"] for pose in poses)
    force = np.random.default_rng(2).normal(size=(64, 3))
    load, link_moment = _load(binding, force, *poses)
    moment = np.cross(0.5 * (first + second), force).sum(axis=0)
    np.testing.assert_allclose(load["load.force"][0], force.sum(axis=0), atol=1e-13)
    np.testing.assert_allclose(link_moment, moment, atol=1e-12)


def test_samples_of_a_turning_body_move_with_it():
    samples = _move(_cube_in_water(), _pose(1.0, TURN))
    arm = samples["surface.position"] - [1.0, 0.0, 0.0]
    velocity = np.array([1.0, 2.0, 3.0]) + np.cross([0.0, 0.0, 5.0], arm)
    np.testing.assert_allclose(samples["surface.velocity"], velocity, atol=1e-14)


def test_answers_that_are_no_samples_are_refused():
    link = join_fsi("link", ("water", "cubes"), PORTS)
    water = {"surface.spacing": np.array([0.1]), "surface.depth": np.array([1.0])}
    described = {"water": water, "cubes": masses(1)}
    with pytest.raises(LinkError, match=r"sample of cubes must answer with motion.arm.*found none"):
        bound(link, described, cubes=lambda _: {})
    with pytest.raises(LinkError, match=r"motion.volume of shape \('n',\).*found \(3,\)"):
        bound(link, described, cubes=lambda r: cubes(0.4)(r) | {"motion.volume": np.ones(3)})


def test_direct_passes_only_what_is_taken():
    pairs = [["puck.pose", "air.flight"], ["air.drag", "puck.push"]]
    link = join_direct("drag", pairs, PORTS)
    pose = {"pose.position": np.zeros((2, 3)), "pose.velocity": np.ones((2, 3))}
    carry, _ = link.bind({"puck": {}, "air": {}}).maps
    assert set(carry({}, {"puck": pose})) == {"flight.velocity"}
    assert link.transfers[0].reads == ("pose.velocity",)
    exchange = Exchange([link], PORTS)
    assert exchange.sums == [[], [("drag.force", "push.force"), ("drag.heat", "push.heat")]]
    assert exchange.works_of == [{"air": [("drag.force", "flight.velocity", "")]}]
    assert exchange.works_on == [[], [("push.force", "pose.velocity", "pose.position")]]


def test_direct_names_ports_that_are_not_there():
    with pytest.raises(SceneError, match=r"air takes flight; found air\.fligth"):
        join_direct("drag", [["puck.pose", "air.fligth"]], PORTS)
    with pytest.raises(SceneError, match="Did you mean puck"):
        join_direct("drag", [["pcuk.pose", "air.flight"]], PORTS)
    with pytest.raises(SceneError, match="is not known to the other side"):
        join_direct("drag", [["air.drag", "air.flight"]], PORTS)


@pytest.mark.parametrize(
    ("table", "rule"),
    [
        ({"kind": "fsi", "between": ["water"]}, "must name two components"),
        ({"kind": "fsi", "between": ["water", "water"]}, "must name two components"),
        ({"kind": "glue", "between": ["rods", "palte"]}, "Did you mean plate"),
        ({"kind": "fsi", "betwen": ["water", "cubes"]}, "Did you mean between"),
        ({"kind": "direct", "pairs": ["a.b", "c.d"]}, "must be pairs of ports"),
    ],
)
def test_tables_of_links_are_checked(table, rule):
    with pytest.raises(SceneError, match=rule):
        maker(table["kind"])(0, table, PORTS)


def test_a_link_that_lacks_a_port_says_what_would_add_it():
    port = Port("bodies", (VELOCITY,), lacks=((GLUED_LOAD.name, "it has no table glued"),))
    ports = {"rod": ((), (port,)), "bar": ((NODE_LOAD,), (NODE_GLUE,))}
    with pytest.raises(SceneError) as error_info:
        join_glue("rod-bar", ("rod", "bar"), ports)
    assert error_info.value.mistakes == [
        "link rod-bar: glue needs: rod must give a port glued_load: it has no table glued. "
        "Link others."
    ]
