"""Gauges of a structure: at nodes, in elements, of sets and of whole parts."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.meshes.mesh import Mesh, chosen, elements_of
from quintet.components.fe_plate.meshes.selections import Faces
from quintet.components.fe_plate.params import Gauges
from quintet.components.fe_plate.state import (
    DAMAGE,
    ENERGY,
    PRESSURE,
    STRAIN,
    TEMPERATURE,
    Array,
    Places,
    State,
    Whole,
)
from quintet.components.fe_plate.view import von_mises
from quintet.components.shared.search.nearest import nearest_rows
from quintet.interfaces.component import Keys
from quintet.interfaces.errors import SceneError


class Measured(NamedTuple):
    """Nodes and elements at which a structure is measured."""

    node: Whole  # (k,)
    element: Whole  # (k,)
    node_sets: list[Whole]  # nodes of each
    element_sets: list[Whole]  # elements of each


def measured(mesh: Mesh, gauges: Gauges) -> Measured:
    """Nodes nearest to some points at the start, elements whose middles are, and whole sets."""
    middle = mesh.node[mesh.corner].mean(axis=1)
    nodes = []
    for number, name in enumerate(gauges.node_set_gauges):
        where = f"gauges.node_set_gauges.{number}"
        nodes.append(np.flatnonzero(chosen(mesh, Faces(node_set=name), where)))
        if not len(nodes[-1]):
            raise SceneError(
                f"{where}: {name} must hold a node; it holds none. Correct its box, or name "
                "another set."
            )
    elements = []
    for number, chosen_elements in enumerate(gauges.element_set_gauges):
        where = f"gauges.element_set_gauges.{number}"
        elements.append(elements_of(mesh, chosen_elements, where))
        if not len(elements[-1]):
            raise SceneError(
                f"{where}: it must hold an element; it holds none. Correct the box, or name "
                "another set."
            )
    return Measured(
        nearest_rows(mesh.node, gauges.node_gauges),
        nearest_rows(middle, gauges.element_gauges),
        nodes,
        elements,
    )


def at_nodes(state: State, node: Whole) -> dict[str, Array]:
    """Motion of some nodes."""
    return {
        "node_gauge.position": state.position[node],
        "node_gauge.velocity": state.velocity[node],
    }


def in_elements(places: Places, state: State, element: Whole) -> dict[str, Array]:
    """Stress, strain, temperature and damage of some elements."""
    subset = Places(places.point[element], places.share[element])
    return {
        "element_gauge.von_mises": von_mises(subset, state),
        "element_gauge.pressure": subset.of(state, PRESSURE),
        "element_gauge.plastic_strain": subset.of(state, STRAIN),
        "element_gauge.temperature": subset.of(state, TEMPERATURE),
        "element_gauge.damage": subset.of(state, DAMAGE),
        "element_gauge.active": subset.active(state),
    }


def of_node_sets(state: State, sets: list[Whole]) -> dict[str, Array]:
    """Mean motion of the nodes of each set."""
    return {
        "node_set_gauge.position": np.stack([state.position[nodes].mean(axis=0) for nodes in sets]),
        "node_set_gauge.velocity": np.stack([state.velocity[nodes].mean(axis=0) for nodes in sets]),
    }


def of_element_sets(
    mesh: Mesh, places: Places, state: State, mass: Array, sets: list[Whole]
) -> dict[str, Array]:
    """Mean velocity, energies, mean stress, greatest strain and damage of each set of elements."""
    means: dict[str, list[Any]] = {}
    for rows in sets:
        subset = Places(places.point[rows], places.share[rows])
        part = mesh._replace(corner=mesh.corner[rows], part=np.zeros(len(rows), np.int64))
        for key, value in of_parts(part, subset, state, mass[rows]).items():
            means.setdefault(key.partition(".")[2], []).append(value[0])
        means.setdefault("von_mises", []).append(von_mises(subset, state).mean())
        means.setdefault("plastic_strain", []).append(subset.of(state, STRAIN).max())
        means.setdefault("damage", []).append(subset.of(state, DAMAGE).max())
    return {f"element_set_gauge.{name}": np.array(values) for name, values in means.items()}


def of_parts(mesh: Mesh, places: Places, state: State, mass: Array) -> dict[str, Array]:
    """Mean velocity and energies of each part, whose elements have a mass (e,) kg each.

    Each element has an eighth of its mass at each of its corners.
    """
    parts = int(mesh.part.max()) + 1

    def sums(of_elements: Array) -> Array:
        return np.bincount(mesh.part, of_elements, parts).astype(np.float64)

    velocity = state.velocity[mesh.corner]  # (e, 8, 3)
    internal = mass * places.of(state, ENERGY) + places.spring_energy(state)
    momentum = [sums(mass * velocity[:, :, d].mean(axis=1)) for d in range(3)]
    return {
        "part_gauge.velocity": np.stack(momentum, axis=1) / sums(mass)[:, None],
        "part_gauge.kinetic": sums(0.5 * mass * (velocity**2).sum(axis=2).mean(axis=1)),
        "part_gauge.internal": sums(internal),
        "part_gauge.eroded": sums(internal * (places.active(state) == 0.0)),
    }


def readings(measured: Measured, built: Structure, state: State, wanted: Keys) -> dict[str, Array]:
    """Fields of the gauges that any partner, expectation or output wants."""
    mesh, places, mass = built.mesh, built.places, built.element_mass
    gauges: dict[str, Callable[[], dict[str, Array]]] = {
        "node_gauge": lambda: at_nodes(state, measured.node),
        "element_gauge": lambda: in_elements(places, state, measured.element),
        "node_set_gauge": lambda: of_node_sets(state, measured.node_sets),
        "element_set_gauge": lambda: of_element_sets(
            mesh, places, state, mass, measured.element_sets
        ),
        "part_gauge": lambda: of_parts(mesh, places, state, mass),
    }
    ports = {key.partition(".")[0] for key in wanted}
    values = {k: v for port in gauges if port in ports for k, v in gauges[port]().items()}
    return {key: values[key] for key in wanted if key in values}
