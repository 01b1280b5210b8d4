"""Fields of several links are merged at one port, and split again."""

import numpy as np
import pytest
from toy_samples import cubes, masses, mesh

from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.link import Binding, Link, Transfer
from quintet.coupler.coupling.links.fsi import join as join_fsi
from quintet.coupler.coupling.links.glue import join as join_glue
from quintet.coupler.coupling.links.port_checks import misfits, requires
from quintet.interfaces.component import Field, Port
from quintet.interfaces.errors import LinkError
from quintet.interfaces.ports import (
    FACES,
    GLUED,
    GLUED_LOAD,
    LOAD,
    MOTION,
    NODE_GLUE,
    NODE_LOAD,
    SURFACE,
    SURFACE_LOAD,
)

FLUID = ((SURFACE,), (SURFACE_LOAD,))
BODY = ((LOAD,), (MOTION,))
STATED = {"surface.spacing": np.array([0.1]), "surface.depth": np.array([0.3])}


def _at_rest(count, x):
    return {
        "motion.position": np.tile([x, 0.0, 0.0], (count, 1)),
        "motion.velocity": np.full((count, 3), x),
        "motion.orientation": np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
        "motion.angular_velocity": np.zeros((count, 3)),
    }


def _inputs(exchange, taker, outputs, finished=()):
    """Fields that all links bring to a component; `finished` have done the window already."""
    transfers = exchange.transfers
    numbers = [n for n, transfer in enumerate(transfers) if transfer.taker == taker]
    deliveries = [exchange.deliver(number, outputs, outputs) for number in numbers]
    return exchange.merge(
        taker, [(delivery, delivery.transfer.giver in finished) for delivery in deliveries]
    )


@pytest.fixture(params=[("water", "small", "large"), ("small", "large", "water")])
def two_links(request):
    """Two components of bodies in one fluid; ports in the order in which they step."""
    kinds = {"water": FLUID, "small": BODY, "large": BODY}
    ports = {name: kinds[name] for name in request.param}
    links = [join_fsi(name, ("water", name), ports) for name in ("small", "large")]
    exchange = Exchange(links, ports)
    descriptions = {"water": STATED, "small": masses(2), "large": masses(1)}
    answers = {"small": cubes(0.2, 2), "large": cubes(0.3)}
    static = exchange.bind(descriptions, lambda name, request: answers[name](request))
    outputs = {
        "water": {"surface_load.force": np.zeros((16 + 27, 3))},
        "small": _at_rest(2, 1.0),
        "large": _at_rest(1, 5.0),
    }
    exchange.count_rows(outputs)
    return exchange, static, outputs


def test_rows_of_several_links_stand_one_after_another(two_links):
    exchange, static, outputs = two_links
    assert static["water"]["surface.volume"].shape == (16 + 27,)
    inputs = _inputs(exchange, "water", outputs)
    velocity = inputs.fields["surface.velocity"]
    np.testing.assert_array_equal(velocity[:16], 1.0)
    np.testing.assert_array_equal(velocity[16:], 5.0)


def test_forces_go_back_to_whom_they_belong(two_links):
    exchange, _, outputs = two_links
    force = np.arange(43.0)[:, None] * np.ones(3)
    outputs["water"]["surface_load.force"] = force
    # For any component that is asked first.
    for _ in range(2):
        small = _inputs(exchange, "small", outputs).fields["load.force"]
        large = _inputs(exchange, "large", outputs).fields["load.force"]
        _inputs(exchange, "water", outputs)
    np.testing.assert_allclose(small, [force[:8].sum(axis=0), force[8:16].sum(axis=0)], rtol=1e-14)
    np.testing.assert_allclose(large, [force[16:].sum(axis=0)], rtol=1e-14)


def test_ends_are_known_when_all_links_bring_them(two_links):
    exchange, _, outputs = two_links
    assert "surface.position" in _inputs(exchange, "water", outputs, ("small", "large")).ends
    half = _inputs(exchange, "water", outputs, ("small",))
    assert "surface.position" not in half.ends
    assert "surface.position" in half.mixed
    assert _inputs(exchange, "water", outputs).mixed == []


def test_forces_on_own_items_add_up():
    """A plate between two fluids, and glued to particles: one load on its nodes."""
    plate = ((NODE_LOAD,), (FACES, NODE_GLUE))
    ports = {"a": FLUID, "b": FLUID, "plate": plate, "rods": ((GLUED,), (GLUED_LOAD,))}
    links = [join_fsi("a", ("a", "plate"), ports), join_fsi("b", ("plate", "b"), ports)]
    links += [join_glue(str(n), ("rods", "plate"), ports) for n in range(2)]
    exchange = Exchange(links, ports)
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    corner = np.array([[0.0, 1.0, 2.0, 3.0]])
    described = {
        "a": STATED | {"surface.spacing": np.array([0.5]), "surface.inset": np.zeros(1)},
        "b": STATED | {"surface.spacing": np.array([0.25]), "surface.inset": np.zeros(1)},
        "plate": {
            **{"faces.start": square, "faces.corner": corner},
            **{"node_glue.start": square, "node_glue.corner": corner},
        },
        "rods": {
            "glued_load.position": np.array([[0.5, 0.5, 0.0]]),
            "glued_load.mass": np.array([4.0]),
        },
    }
    plate = mesh(described["plate"])
    static = exchange.bind(described, lambda _, request: plate(request))
    np.testing.assert_allclose(static["plate"]["node_load.added_mass"], 2.0)  # 1 of each link
    outputs = {
        "a": {"surface_load.force": np.full((4, 3), 1.0)},
        "b": {"surface_load.force": np.full((16, 3), 1.0)},
        "rods": {"glued_load.force": np.full((1, 3), 100.0)},
        "plate": {"faces.position": square, "faces.velocity": np.zeros((4, 3))},
    }
    exchange.count_rows(outputs)
    load = _inputs(exchange, "plate", outputs).fields["node_load.force"]
    np.testing.assert_allclose(load, (4 + 16 + 200) / 4.0, rtol=1e-14)


class _Values(Link):
    """A link that brings a value, which cannot be added up."""

    name = "values"

    def __init__(self, giver):
        self.transfers = (Transfer(giver, "taker", reads=("port.value",), fills=("port.value",)),)

    def bind(self, described):
        giver = self.transfers[0].giver
        return Binding({}, (lambda _, end: {"port.value": end[giver]["port.value"]},))


def test_values_of_several_links_cannot_be_added():
    port = Port("port", (Field("value", (), "K"),))
    ports = {"a": ((), (port,)), "b": ((), (port,)), "taker": ((port,), ())}
    exchange = Exchange([_Values("a"), _Values("b")], ports)
    exchange.bind({name: {} for name in ports})
    outputs = {name: {"port.value": np.ones(2)} for name in ("a", "b")}
    exchange.count_rows(outputs)
    with pytest.raises(
        LinkError, match="only where they are impulses, as forces are; this one is an instant"
    ):
        _inputs(exchange, "taker", outputs)


def test_ports_that_do_not_fit_are_named():
    port = Port("load", (Field("force", (3,), "N"), Field("torque", (3,), "N", "impulse")))
    messages = misfits("cubes", port, LOAD)
    assert "cubes.load.force is instant, the other side's impulse" in messages
    assert "cubes.load.torque is in N, the other side's in N m" in messages
    scalar = Port("load", (Field("force", (), "N", "impulse"), Field("moment", (3,), "N m")))
    messages = misfits("cubes", scalar, LOAD)
    assert "cubes.load.force has shape (), the other side's (3,)" in messages
    assert "cubes.load.moment is not known to the other side (force, torque)" in messages
    assert requires(BODY, "cubes", LOAD, MOTION) == []
    assert requires(BODY, "cubes", SURFACE, None) == ["cubes must take a port surface"]


@pytest.mark.parametrize("first", ["left", "right"])
def test_two_plates_in_one_fluid_get_their_own_forces_from_the_start(first):
    plate = ((NODE_LOAD,), (FACES,))
    ports = {"left": plate, "right": plate, "water": FLUID}
    exchange = Exchange([join_fsi(n, ("water", n), ports) for n in ("left", "right")], ports)
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    faces = {"faces.start": square, "faces.corner": np.array([[0.0, 1.0, 2.0, 3.0]])}
    requests = {"surface.spacing": np.ones(1), "surface.inset": np.zeros(1)}
    described = {"left": faces, "right": faces, "water": STATED | requests}
    exchange.bind(described, lambda _, request: mesh(faces)(request))
    moving = {"faces.position": square, "faces.velocity": square}
    force = {"surface_load.force": np.array([[4.0, 0.0, 0.0], [0.0, 8.0, 0.0]])}
    outputs = {"left": moving, "right": moving, "water": force}
    exchange.count_rows(outputs)
    for name in dict.fromkeys([first, "left", "right"]):
        load = _inputs(exchange, name, outputs).fields["node_load.force"]
        expected = [1.0, 0.0, 0.0] if name == "left" else [0.0, 2.0, 0.0]
        np.testing.assert_allclose(load, np.tile(expected, (4, 1)), rtol=1e-14)
