"""Totals of a structure, and the reports of failed steps."""

import numpy as np

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.state import ENERGY, Array, State
from quintet.interfaces.component import Totals
from quintet.interfaces.errors import StepError


def motion(state: State, mass: Array, velocity: Array, gravity: Array) -> tuple[float, float]:
    """Kinetic and potential energy [J] of masses (n,) kg at velocities (n, 3) m/s."""
    kinetic = 0.5 * float((mass[:, None] * velocity * velocity).sum())
    return kinetic, -float(mass @ (state.position @ gravity)) if gravity.any() else 0.0


def totals(
    state: State, built: Structure, mass: Array, energies: tuple[float, float], work: float
) -> Totals:
    """Mass, momentum and energies, added mass included.

    Parameters
    ----------
    state, built
    mass : (n,) float array, kg
        Of the nodes.
    energies : two floats, J
        Kinetic and potential.
    work : float, J
        Of pressures and mass damping; that of rigid walls is added.
    """
    momentum = mass[:, None] * state.velocity
    springs = built.places.spring_energy(state).sum()
    return Totals(
        mass=float(mass.sum()),
        momentum=momentum.sum(axis=0),
        angular_momentum=np.cross(state.position, momentum).sum(axis=0),
        kinetic=energies[0],
        potential=energies[1],
        internal=float(built.element_mass @ built.places.of(state, ENERGY) + springs),
        work=work + float(state.wall_work.sum()),
    )


def inside_out(built: Structure, place: int, ratio: float, time: float) -> StepError:
    """Report that the element of a point has a ratio of its volume at the start, at a time [s]."""
    element = int(np.flatnonzero((built.places.point == place).any(axis=1))[0])
    middle = built.mesh.node[built.mesh.corner[element]].mean(axis=0)
    return StepError(
        f"element {element}, at {np.array2string(middle, precision=4)} m at the start, must keep "
        f"a positive volume; at {time:g} s it has {ratio:.3g} of that at the start: it is inside "
        "out. Let it erode by failure_strain, or refine the mesh."
    )


def not_finite(built: Structure, state: State, time: float) -> StepError:
    """Report the first node whose velocity is not finite, at a time [s]."""
    node = int(np.argmin(np.isfinite(state.velocity).all(axis=1)))
    return StepError(
        f"node {node}, at {built.mesh.node[node]} m at the start: its velocity must be finite; "
        f"at {time:g} s it is not. Take a smaller courant."
    )
