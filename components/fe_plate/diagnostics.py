"""Totals of a structure, and the reports of failed steps."""

import numpy as np

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.ranks.method import Ranks
from quintet.components.fe_plate.state import DAMAGE, ENERGY, Array, State, Whole, at_points
from quintet.components.shared.finite_items import require_finite_items
from quintet.interfaces.component import Totals
from quintet.interfaces.errors import SceneError, StepError
from quintet.interfaces.sums import finite

BEHIND = 1e-6  # of the least edge of elements, by which nodes may begin behind a rigid wall
Kicks = tuple[Whole | slice, Array]


def present_velocity(velocity: Array, kicks: Kicks | None) -> Array:
    """Velocities (n, 3) m/s at the end of a step, with `kicks` as of `motion`."""
    if kicks is not None:
        velocity = velocity.copy()
        velocity[kicks[0]] += kicks[1]
    return velocity


def motion(state: State, mass: Array, gravity: Array, kicks: Kicks | None) -> list[Array]:
    """Kinetic and potential energies (n,) J of the nodes that this rank moves, of mass (n,) kg.

    `kicks` are rows (k,) and velocities (k, 3) m/s that these nodes lack to the end of a step.
    """
    velocity = present_velocity(state.velocity[: len(mass)], kicks)
    kinetic = 0.5 * mass * (velocity * velocity).sum(axis=1)
    return [kinetic, -mass * (state.position[: len(mass)] @ gravity)]


def totals(
    state: State, built: Structure, mass: Array, energies: list[Array], ranks: Ranks
) -> Totals:
    """Mass, momentum and energies of all ranks, added mass included.

    Parameters
    ----------
    state, built
    mass : (n,) float array, kg
        Of the nodes that this rank moves.
    energies : two (n,) float arrays, J
        Kinetic and potential.
    ranks : Ranks
    """
    nodes = len(mass)
    momentum = mass[:, None] * state.velocity[:nodes]
    angular = np.cross(state.position[:nodes], momentum)
    internal = built.element_mass * built.places.of(state, ENERGY)
    internal += built.places.spring_energy(state)
    _, walls, damping = state.works(nodes)
    pressures = state.load_work[: len(state.partner_work)] - state.partner_work
    works = [pressures[:nodes], walls, damping]
    sums = ranks.sums([mass, *momentum.T, *angular.T, *energies, internal, *works])
    kinetic, potential, internal_energy, *work = sums[7:].tolist()
    return Totals(
        mass=float(sums[0]),
        momentum=sums[1:4],
        angular_momentum=sums[4:7],
        kinetic=kinetic,
        potential=potential,
        internal=internal_energy,
        work=sum(work),
        dissipated=0.0,  # plastic work is internal, damping is work
    )


def require_before_walls(built: Structure, state: State, ranks: Ranks) -> None:
    """Refuse nodes that begin behind a rigid wall, which would throw them out in one step."""
    walls, position = built.model.walls, state.position[: built.model.moving]
    if not len(walls):
        return
    heights = position @ walls[:, :3].T - walls[:, 3]  # (n, w) m
    lowest = ranks.least(heights.min(axis=0))
    wall = int(np.argmin(lowest))
    if lowest[wall] < -BEHIND * built.shortest:
        raise SceneError(
            f"rigid_walls.{wall}: no node may be behind it as the run begins; found one "
            f"{-lowest[wall]:.3g} m behind. Move the wall or the parts, or turn its normal."
        )


def inside_out(built: Structure, place: int, ratio: float, time: float, ranks: Ranks) -> StepError:
    """Report the element that has the least ratio of its volume at the start, at a time [s].

    Parameters
    ----------
    built
    place : int
        Of one of its points; -1 if this rank has none of its points.
    ratio : float
    time : float, s
    ranks : Ranks
    """
    row = np.full(4, np.inf)
    for element in np.flatnonzero((built.places.point == place).any(axis=1)):
        number = np.arange(ranks.elements.size)[ranks.elements.ids][element]
        row[:] = (
            number,
            *built.mesh.node[built.corners(slice(element, element + 1))[0]].mean(axis=0),
        )
    number, *middle = ranks.lowest(row)
    return StepError(
        f"element {number:.0f}, at {np.array2string(np.array(middle), precision=4)} m at the "
        f"start, must keep a positive volume; at {time:g} s it has {ratio:.3g} of that at the "
        "start: it is inside out. Let it erode by failure_strain, or refine the mesh.",
        middle,
    )


def not_finite(built: Structure, state: State, time: float, ranks: Ranks) -> StepError:
    """Report the first node whose velocity is not finite, at a time [s]."""
    row = np.full(4, np.inf)
    for node in np.flatnonzero(~np.isfinite(state.velocity[ranks.nodes.rows]).all(axis=1))[:1]:
        row[:] = np.arange(ranks.nodes.size)[ranks.nodes.ids][node], *built.mesh.node[node]
    number, *place = ranks.lowest(row)
    return StepError(
        f"node {number:.0f}, at {np.array(place)} m at the start: its velocity must be finite; "
        f"at {time:g} s it is not. Take a smaller courant.",
        place,
    )


def check(built: Structure, state: State, ranks: Ranks) -> None:
    """Refuse elements with numbers that are not finite and that a step need not notice."""
    names = ("specific energy", "plastic strain", "temperature", "damage")
    inner = state.points[:, ENERGY : DAMAGE + 1]
    if finite(inner):
        return
    places, corners = built.places.point, built.corners(slice(None))
    fields = {name: at_points(inner, k, places) for k, name in enumerate(names)}
    numbers = np.arange(ranks.elements.size)[ranks.elements.ids]
    middle = state.position[corners].mean(axis=1)
    advice = "Take a smaller courant, or check the constants of its material."
    require_finite_items("element", fields, numbers, middle, advice)
