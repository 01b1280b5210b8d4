"""Particle dynamics: a lattice that heats itself, or spheres that fly."""

from collections.abc import Mapping

from quintet.components.particle_dynamics import MANIFEST
from quintet.components.particle_dynamics.lattice_dynamics import LatticeDynamics
from quintet.components.particle_dynamics.params import ParticleDynamicsParams
from quintet.components.particle_dynamics.ports import SHOWS
from quintet.components.particle_dynamics.spheres.dynamics import SphereDynamics
from quintet.interfaces.component import (
    ONE_THREAD,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
)


class ParticleDynamics(Component):
    """Moves a lattice or spheres, whichever the parameters have.

    Parameters
    ----------
    params : ParticleDynamicsParams
        Points, forces, what holds and heats them; or spheres.
    """

    Params: type[ParticleDynamicsParams] = ParticleDynamicsParams

    manifest = MANIFEST
    shows = SHOWS

    def __init__(self, params: ParticleDynamicsParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.moved: Component = (
            SphereDynamics(params) if params.lattice is None else LatticeDynamics(params)
        )

    def describe(self) -> Fields:
        """Static fields of what is moved."""
        return self.moved.describe()

    def prepare(self, fields: Fields) -> None:
        """Compile the kernels of a lattice."""
        self.moved.prepare(fields)

    def stable_dt(self) -> float:
        """Largest step of what is moved."""
        return self.moved.stable_dt()

    def take(self, fields: Fields) -> None:
        """Set temperatures of a wall; loads and heat of spheres."""
        self.moved.take(fields)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]."""
        self.moved.step(dt)

    def give(self, wanted: Keys) -> Fields:
        """Copy out what is wanted."""
        return self.moved.give(wanted)

    def save(self) -> Fields:
        """Copy out all state."""
        return self.moved.save()

    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        self.moved.load(state)

    def notes(self) -> tuple[str, ...]:
        """Tell of what is lost or missing."""
        return self.moved.notes()

    def warnings(self) -> Mapping[str, str]:
        """Why the motion may be wrong: overlaps, lost points, missing energy."""
        return self.moved.warnings()

    def final_warnings(self) -> Mapping[str, str]:
        """Warnings that only the whole run can justify."""
        return self.moved.final_warnings()

    def totals(self) -> Totals:
        """Mass, momentum and energies."""
        return self.moved.totals()

    def view(self) -> Fields:
        """Points and what they show."""
        return self.moved.view()

    def items(self) -> int:
        """Count the points."""
        return self.moved.items()
