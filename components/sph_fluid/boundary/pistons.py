"""Parts of the boundary that move by themselves; imported only by a scene that has some.

Their particles are surface samples, listed after the samples of links. The state, the neighbour
lists and the ranks treat them as these, and the fluid's force on them is summed in the same way.
They are placed as samples are: where they are in the middle of a step, with the mean
velocity over it, so that displacements add up. The force of a step on them times their velocity is
the work that the fluid does on them.
"""

from collections.abc import Callable, Mapping
from typing import Protocol

import numpy as np

from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.boundary.parts import moving, part_faces
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.boundary.walls import wall_volume
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.kernels import write_pressure
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.setup.piston_ways import moved
from quintet.components.sph_fluid.setup.trajectory import ROUNDING, Trajectory
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError, StepError

SAVED = "pistons"  # key of a saved state: time [s] and work [J]
CORRECTED = "pistons_corrected"  # key of a saved state: displacements [m] that were added
JUMP = 0.02  # spacings: how far pistons may be from where a state has them


class Correction(Protocol):
    """What is added to the motion of a piston, by the state of the fluid."""

    forward: Array  # (3,) 1, along which it is displaced

    def velocity(self, state: State, time: float, displacement: float) -> float:
        """Velocity [m/s] that is added at a time [s], of a piston displaced so far [m]."""


class Part:
    """One piston: its particles, their images and its faces in the scene, and its trajectory."""

    def __init__(self, params: SphFluidParams, number: int, correction: Correction | None) -> None:
        piston = params.boundary.pistons[number]
        self.points, self.images = moving(params, piston)  # (k, 3) m
        self.faces = part_faces(params, piston)
        self.trajectory: Trajectory = piston.path.trajectory
        self.axis, self.point = piston.path.direction, np.array(piston.path.point)
        self.correction = correction
        self.added, self.added_velocity, self.clock = 0.0, 0.0, 0.0  # m, m/s, s

    def correct(self, state: State, time: float) -> None:
        """Choose the velocity that is added in a step that begins at a time [s]."""
        self.clock = time
        if self.correction is not None:
            forward = self.correction.forward
            place = self.trajectory.at(time).place.tolist()
            displacement = sum(float(n) * x for n, x in zip(forward, place[:3], strict=True))
            self.added_velocity = self.correction.velocity(state, time, displacement + self.added)

    def finish(self, dt: float) -> None:
        """Go on to the end of a step [s]."""
        self.added += dt * self.added_velocity
        self.clock += dt

    def at(self, points: Array, time: float) -> Array:
        """Places (k, 3) m of points (k, 3) m of it at a time [s]."""
        place = self.trajectory.at(time).place
        if self.correction is not None:
            added = self.added + (time - self.clock) * self.added_velocity
            return np.asarray(points + (place[:3] + added * self.correction.forward))
        return moved(points, place, self.axis, self.point)


class MovingPistons:
    """All pistons of one fluid."""

    def __init__(
        self,
        params: SphFluidParams,
        samples: Samples,
        ranks: Ranks,
        density_at: Callable[[Array], Array],
        corrections: Mapping[int, Correction],
    ) -> None:
        self.params, self.samples, self.ranks = params, samples, ranks
        self.density_at = density_at  # kg/m3 of walls at places (n, 3) m, at the start
        count = len(params.boundary.pistons)
        self.parts = [Part(params, n, corrections.get(n)) for n in range(count)]
        self.corrected = [part for part in self.parts if part.correction is not None]
        self.end = min(part.trajectory.end for part in self.parts)  # s
        self.links = 0  # samples that links bring, which theirs follow
        self.time, self.work = 0.0, 0.0
        self.velocity = np.zeros((0, 3))  # (k, 3) m/s, mean over the step

    def join(self, static: Fields) -> dict[str, Array]:
        """Static fields of the samples that links bring, and of the pistons' after them."""
        count = sum(len(part.points) for part in self.parts)
        body = [np.full(len(part.points), -1.0 - k) for k, part in enumerate(self.parts)]
        volume = wall_volume(self.params)
        appended = {"surface.volume": np.full(count, volume), "surface.body": np.concatenate(body)}
        self.links = len(static.get("surface.volume", ()))
        joined = {
            k: np.concatenate([static.get(k, np.zeros(0)), rows]) for k, rows in appended.items()
        }
        contact = static.get("surface.contact")
        if contact is not None:
            joined["surface.contact"] = np.concatenate([contact, np.zeros(count)])
        return {**static, **joined}

    def start(self, state: State, boundary: BoundaryMethod) -> None:
        """Put them where the scene has them, under the pressure of the fluid at rest there."""
        rows, numbers = self.samples.rows_of(self.links, len(self.samples.volume) - self.links)
        places = self._places(0.0)
        state.position_density[rows, 3] = self.density_at(places)[numbers]
        self._move(state, boundary, places, np.zeros_like(places), 0.0)
        write_pressure(constants(self.params), state.position_density, state.velocity_pressure)

    def place(self, state: State, boundary: BoundaryMethod, dt: float) -> None:
        """Put them where they are in the middle of a step [s]."""
        end = self.time + dt
        if end > self.end + ROUNDING * abs(self.end):
            raise StepError(
                "boundary.pistons must go on until the run's end; the table of one ends at "
                f"{self.end:g} s, and a step goes on to {end:g} s. Extend it, or end the run "
                "before."
            )
        for part in self.corrected:
            part.correct(state, self.time)
        middle = self.time + 0.5 * dt
        ends = [self._places(time) for time in (self.time, end)]
        self.velocity = (ends[1] - ends[0]) / dt
        self._move(state, boundary, self._places(middle), self.velocity, middle)

    def _move(
        self, state: State, boundary: BoundaryMethod, places: Array, velocity: Array, time: float
    ) -> None:
        fields = {
            "surface.position": places,
            "surface.velocity": velocity,
            "surface.mirror": np.concatenate([p.at(p.images, time) for p in self.parts]),
        }
        self.samples.move(state, fields, self.links)
        self.ranks.follow_samples(fields, self.links)
        boundary.follow_samples(state, fields, self.links)

    def _places(self, time: float) -> Array:
        return np.concatenate([part.at(part.points, time) for part in self.parts])

    def advance(self, state: State, dt: float) -> None:
        """Count the work of a step [s], and go on to its end; rank 0 has the forces."""
        force = state.force[self.links :]
        per_metre = self.params.slab_thickness
        self.work -= dt * per_metre * float((force * self.velocity).sum(axis=1).sum())
        self.time += dt
        for part in self.corrected:
            part.finish(dt)

    def forces_of_links(self, state: State) -> Array:
        """Forces (samples, 3) N on the samples that links bring."""
        return state.force[: self.links]

    def faces(self) -> list[Array]:
        """Corners (k, 3) m of their faces where they are now."""
        return [part.at(face, self.time) for part in self.parts for face in part.faces]

    def save(self) -> dict[str, Array]:
        """Copy out their clock, and their work."""
        saved = {SAVED: np.array([self.time, self.work])}
        if self.corrected:
            saved[CORRECTED] = np.array([part.added for part in self.corrected])
        return saved

    def load(self, state: Fields) -> None:
        """Come back to a saved state."""
        self.time, self.work = np.asarray(state.get(SAVED, np.zeros(2))).tolist()
        zeros = np.zeros(len(self.corrected))
        for part, added in zip(self.corrected, state.get(CORRECTED, zeros).tolist(), strict=True):
            part.added, part.clock = added, self.time

    def refuse_jump(self, saved: Fields) -> None:
        """Refuse the state of another run in which pistons stand elsewhere than at their start.

        Raises
        ------
        SceneError
            With the first piston that would jump through the fluid.
        """
        is_piston = saved["sample"] >= self.links
        rows = len(saved["identity"]) + np.flatnonzero(is_piston)
        velocity = saved["velocity_pressure"][rows, :3]
        # A state has samples where they were in the middle of its last step.
        at_end = saved["position_density"][rows, :3] + 0.5 * saved["last_dt"] * velocity
        places = np.empty_like(at_end)
        places[saved["sample"][is_piston] - self.links] = at_end
        distance = np.linalg.norm(places - self._places(0.0), axis=1)
        first = 0
        for number, part in enumerate(self.parts):
            jump = float(distance[first : first + len(part.points)].max(initial=0.0))
            first += len(part.points)
            if jump > JUMP * self.params.spacing:
                raise SceneError(
                    f"boundary.pistons[{number}] must stand at its start where the state that it "
                    f"begins from has it, within {JUMP:g} spacings; found {jump:.3g} m between "
                    "the two. Begin from a state in which it is back at its start, as "
                    "output.states can keep one, or let it stand still in the first run."
                )
