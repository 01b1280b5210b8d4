"""Gauges of a structure: at nodes, in elements, of sets and of whole parts."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.meshes.mesh import Mesh, chosen, elements_of
from quintet.components.fe_plate.meshes.selections import Faces
from quintet.components.fe_plate.params import Gauges
from quintet.components.fe_plate.ranks.method import Ranks, Rows
from quintet.components.fe_plate.state import (
    DAMAGE,
    ENERGY,
    PRESSURE,
    STRAIN,
    TEMPERATURE,
    Array,
    Places,
    State,
    node_shares,
)
from quintet.components.fe_plate.view import von_mises
from quintet.components.shared.search.nearest import nearest_rows
from quintet.interfaces.component import Keys
from quintet.interfaces.errors import SceneError


class Measured(NamedTuple):
    """Nodes and elements at which a structure is measured."""

    node: Rows
    element: Rows
    node_sets: list[Rows]
    element_sets: list[Rows]
    parts: list[Rows]  # elements of each part, if parts are measured


def measured(mesh: Mesh, gauges: Gauges, ranks: Ranks) -> Measured:
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
    parts = int(mesh.part.max()) + 1 if gauges.part_gauge else 0
    return Measured(
        ranks.nodes_of(nearest_rows(mesh.node, gauges.node_gauges)),
        ranks.elements_of(nearest_rows(middle, gauges.element_gauges)),
        [ranks.nodes_of(numbers) for numbers in nodes],
        [ranks.elements_of(numbers) for numbers in elements],
        [ranks.elements_of(np.flatnonzero(mesh.part == part)) for part in range(parts)],
    )


def at_nodes(state: State, nodes: Rows) -> dict[str, Array]:
    """Motion of some nodes."""
    return {
        "node_gauge.position": nodes.gather(state.position[nodes.rows]),
        "node_gauge.velocity": nodes.gather(state.velocity[nodes.rows]),
    }


def in_elements(places: Places, state: State, elements: Rows) -> dict[str, Array]:
    """Stress, strain, temperature and damage of some elements."""
    subset = Places(places.point[elements.rows], places.share[elements.rows])
    values = {
        "von_mises": von_mises(subset, state),
        "pressure": subset.of(state, PRESSURE),
        "plastic_strain": subset.of(state, STRAIN),
        "temperature": subset.of(state, TEMPERATURE),
        "damage": subset.of(state, DAMAGE),
        "active": subset.active(state),
    }
    return {f"element_gauge.{name}": elements.gather(value) for name, value in values.items()}


def of_node_sets(state: State, sets: list[Rows], ranks: Ranks) -> dict[str, Array]:
    """Mean motion of the nodes of each set."""
    columns = [
        column
        for nodes in sets
        for array in (state.position, state.velocity)
        for column in array[nodes.rows].T
    ]
    counts = np.array([nodes.size for nodes in sets], float)
    means = ranks.sums(columns).reshape(-1, 2, 3) / counts[:, None, None]
    return {
        "node_set_gauge.position": means[:, 0].copy(),
        "node_set_gauge.velocity": means[:, 1].copy(),
    }


def of_elements(built: Structure, state: State, sets: list[Rows], ranks: Ranks) -> dict[str, Array]:
    """Mean velocities and energies of sets of elements.

    Each element has shares of its mass at its nodes.
    """
    ranks.copy_velocities(state)
    columns: list[Array] = []
    for elements in sets:
        rows = elements.rows
        subset = Places(built.places.point[rows], built.places.share[rows])
        mass = built.element_mass[rows]
        corners = built.corners(rows)
        velocity, shares = state.velocity[corners], node_shares(corners.shape[1])  # (e, c, 3)
        internal = mass * subset.of(state, ENERGY) + subset.spring_energy(state)
        columns += [mass, *(mass * (velocity[:, :, d] * shares).sum(axis=1) for d in range(3))]
        columns += [0.5 * mass * ((velocity**2).sum(axis=2) * shares).sum(axis=1), internal]
        columns += [internal * (subset.active(state) == 0.0)]
    sums = ranks.sums(columns).reshape(-1, 7)
    return {
        "velocity": sums[:, 1:4] / sums[:, :1],
        "kinetic": sums[:, 4].copy(),
        "internal": sums[:, 5].copy(),
        "eroded": sums[:, 6].copy(),
    }


def of_element_sets(
    built: Structure, state: State, sets: list[Rows], ranks: Ranks
) -> dict[str, Array]:
    """Mean velocity, energies, mean stress, greatest strain and damage of each set of elements."""
    places, stresses, extremes = built.places, [], []
    for elements in sets:
        subset = Places(places.point[elements.rows], places.share[elements.rows])
        stresses.append(von_mises(subset, state))
        extremes += [subset.of(state, row).max(initial=0.0) for row in (STRAIN, DAMAGE)]
    counts = np.array([elements.size for elements in sets], float)
    largest = ranks.greatest(np.array(extremes)).reshape(-1, 2)
    means = of_elements(built, state, sets, ranks)
    means["von_mises"] = ranks.sums(stresses) / counts
    means["plastic_strain"], means["damage"] = largest[:, 0].copy(), largest[:, 1].copy()
    return means


def readings(
    measured: Measured, built: Structure, state: State, wanted: Keys, ranks: Ranks
) -> dict[str, Array]:
    """Fields of the gauges that any partner, expectation or output wants."""

    def named(port: str, values: dict[str, Array]) -> dict[str, Array]:
        return {f"{port}.{name}": value for name, value in values.items()}

    sets = measured.element_sets
    gauges: dict[str, Callable[[], dict[str, Array]]] = {
        "node_gauge": lambda: at_nodes(state, measured.node),
        "element_gauge": lambda: in_elements(built.places, state, measured.element),
        "node_set_gauge": lambda: of_node_sets(state, measured.node_sets, ranks),
        "element_set_gauge": lambda: named(
            "element_set_gauge", of_element_sets(built, state, sets, ranks)
        ),
        "part_gauge": lambda: named("part_gauge", of_elements(built, state, measured.parts, ranks)),
    }
    ports = {key.partition(".")[0] for key in wanted}
    values = {k: v for port in gauges if port in ports for k, v in gauges[port]().items()}
    return {key: values[key] for key in wanted if key in values}
