"""Contact of a component's particles with the faces of its partners' meshes, by penalty forces."""

import math
from dataclasses import astuple, dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from quintet.components.shared.contact.footprint import measure
from quintet.components.shared.contact.kernels import (
    Loads,
    Points,
    Surface,
    furthest_from,
    released_energy,
    touch,
)
from quintet.components.shared.contact.moduli import (
    longitudinal_modulus,
    plane_modulus,
    tangential_modulus,
)
from quintet.components.shared.contact.search import Near, list_near, near_of, no_faces
from quintet.components.shared.contact.stable_step import highest_square
from quintet.components.shared.geometry.face_projection import cells_of
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError

PORT, ACTIVE, FORCE = "contact_faces", "contact_activity.active", "contact_load.force"
POSITION = f"{PORT}.position"
MOST_SPREAD = 0.2  # radius of a contact over the shortest edge of elements
HEAD = "contact/"  # prefix of the keys in saved states


@dataclass(slots=True)
class Numbers:
    """What is summed over contacts, at the present time and so far."""

    energy: float = 0.0  # J, held by springs
    dissipated: float = 0.0  # J, by friction so far
    points: float = 0.0  # 1/s2, largest ω² of a particle on faces at rest
    nodes: float = 0.0  # 1/s2, largest ω² of what holds a particle, were it at rest
    impact: float = 0.0  # 1/s2, largest k/m of a particle, as deep as it may come
    spread: float = 0.0  # 1, largest radius of a sphere's contact over the least edge of elements
    # 1, largest penetration so far, over the radius of the particle; of points of a surface over
    # half of the thinner one of both layers.
    deepest: float = 0.0
    # J, done on the particles by the motion of the faces until the last step's begin
    work: float = 0.0
    second_half: float = 0.0  # J, that the other half of the last step's force added
    # J, that the kinetic energy lacks: velocities have none of the coming step's force yet, and at
    # the present time should have half of it.
    half_kick: float = 0.0
    last: float = 0.0  # s, the last step
    limit: float = math.inf  # s, of the next step, so that nothing passes through a face

    @property
    def brought(self) -> float:
        """Energy [J] in contact, less the work of the faces on the particles.

        Both are known at the last step's begin; so is the motion but for the second half of its
        kick (Hairer, Lubich & Wanner, section VI.3).
        """
        return self.energy + self.dissipated - self.work - self.second_half


class PenaltyContact:
    """Penalty contact of the particles of a solver with the faces of its partners.

    Parameters
    ----------
    static : mapping of arrays
        Static fields of port `contact_faces`.
    particles : int
    radius : float or (n,) float array, m
        Of particles: they touch a face at their radius, half a spacing.
    spheres : bool
        Whether they are spheres, which touch by Hertz's law.
    on_surface : bool
        Whether they are points of a surface, which touch where they lie; their radius is half the
        thickness of the layer behind them.

    Raises
    ------
    SceneError
        Where spheres are to touch at several points.
    """

    def __init__(
        self, static: Fields, particles: int, radius: ArrayLike, spheres: bool = False,
        on_surface: bool = False,
    ) -> None:  # fmt: skip
        of = {key.partition(".")[2]: np.array(array) for key, array in static.items()}
        self.corner = np.ascontiguousarray(of["corner"], np.int64)
        self.mass = of["mass"]
        self.radius, self.smallest = float(np.max(radius)), float(np.min(radius))  # m
        moduli = of["bulk"], of["shear"]
        modulus = plane_modulus(*moduli) if spheres else longitudinal_modulus(*moduli)
        layer = of["thickness"], of["friction"], of["stiffness"], of["mass"]
        self.faces = modulus, tangential_modulus(*moduli), *layer
        is_planar = bool((self.corner[:, 0] == self.corner[:, 3]).all())
        self.off = 0.0 if on_surface else 1.0  # radii from a face at which they touch it
        points = 1 if on_surface else max(1, int(of["points"].max()))
        if spheres and points > 1:
            raise SceneError(
                f"points_across of a link contact must be 1 where spheres touch faces, as they "
                f"touch at one point; it is {points}. Leave it out."
            )
        self.across = np.array([points, 1 if is_planar else points])
        # m: the faces of a particle's points lie within `reach`, the points `aside` from its foot.
        aside = float(np.hypot(*(1.0 - 1.0 / self.across))) * self.radius
        self.reach = math.hypot(2.0 * self.radius, aside) + aside
        self.safety, self.step_of_faces = float(of["safety"].min()), float(of["step"].min())
        nodes = len(self.mass)
        self.active = np.ones(len(self.corner))
        self.coming = self.active  # of the next step
        self.touchable = np.unique(self.corner)  # nodes of active faces
        self.position = np.zeros((nodes, 3))  # m
        self.before = np.zeros((nodes, 3))  # m, places of nodes at the last step's begin
        self.reaction = np.zeros((nodes, 3))  # N, on the nodes in the last step
        self.slip = np.zeros((particles, 3))  # m, by the number of a particle
        self.held = np.zeros(particles)  # J, by the same: energy of tangential springs
        # m/s, by the same: half of the step's velocity change by contact, which velocities at a
        # step's end, that have none of the next force yet, lack.
        self.kicked = np.zeros((particles, 3))
        self.numbers = Numbers()
        self.near: Near | None = None
        self.slack = 0.0  # m, that particles and faces may still approach each other by

    def start(self, velocity: Array) -> None:
        """Bound the first step by velocities (n, 3) m/s of the start, as if all were at a face."""
        fastest = furthest_from(np.ascontiguousarray(velocity), np.zeros(3))
        self.numbers.limit = 0.5 * self.smallest / fastest if fastest > 0.0 else math.inf

    def take(self, fields: Fields) -> None:
        """Take places of nodes at a step's begin, and which faces are active."""
        self.position = np.array(fields.get(POSITION, self.position))
        active = fields.get(ACTIVE, self.coming)
        if not np.array_equal(active, self.coming):
            self.coming = np.array(active)

    def forget_rows(self) -> None:
        """Forget what is near, as the rows of particles have changed."""
        self.near = None

    def kick(self, points: Points, dt: float) -> None:
        """Change velocities by the forces at the begin of a step of dt [s]; note the reaction.

        All of the step's impulse comes before its drift, on both sides of the contact: with forces
        from the places of both at one time this is a leapfrog, which keeps energy bounded up to
        ω dt = 2 (Hairer, Lubich & Wanner, Geometric Numerical Integration, section VI.3).
        """
        nodes, numbers, last = len(self.mass), self.numbers, self.numbers.last
        surface = self._surface()
        since = last  # s, that places have changed for
        if self.coming is not self.active:
            self._change_faces(points, surface)
            since = 0.0
        near, apart, passed = self._measure(points, surface.velocity, since)
        former, moved = self.reaction, self.position - self.before
        self.reaction, stiffness = np.zeros((nodes, 3)), np.zeros(nodes)
        loads = Loads(self.reaction, stiffness, self.slip, self.held, self.kicked)
        sums = touch(points, surface, near, last, dt, loads, self.off)
        self.before, numbers.last = self.position.copy(), dt
        if last:
            numbers.work -= 0.5 * float(((former + self.reaction) * moved).sum())
        numbers.energy, numbers.half_kick = sums.energy, sums.half_kick
        kicked = self.kicked[points.identity[near.row]]
        more = points.mass[near.row, None] * kicked * kicked  # J, ΔE of a kick less twice half_kick
        numbers.second_half = sums.half_kick + float(more.sum())
        numbers.dissipated += sums.dissipated
        numbers.points, numbers.nodes = sums.points, sums.nodes
        numbers.impact, numbers.spread = sums.impact, max(numbers.spread, sums.spread)
        numbers.deepest = max(numbers.deepest, passed, sums.depth)
        numbers.limit = min(sums.limit, apart)

    def replace_points(self, before: Points, after: Points) -> None:
        """Take other points of a surface, and dissipate the springs of those that are gone."""
        surface = self._surface()
        self._dissipate(before, surface)
        self.near = None
        self._keep(after, surface)

    def _surface(self) -> Surface:
        """Faces and nodes at a step's begin."""
        last, moved = self.numbers.last, self.position - self.before
        moving = moved / last if last else np.zeros_like(moved)
        return Surface(self.corner, *self.faces, self.position, moving)

    def _change_faces(self, points: Points, surface: Surface) -> None:
        """Take the faces that are active now, and dissipate the springs on faces that eroded.

        What the particles press on lies further away than what has eroded: no spring gains.
        """
        self._dissipate(points, surface)
        self.active, self.near = self.coming, None
        self.touchable = np.unique(self.corner[self.active > 0.0])
        self._keep(points, surface)

    def _dissipate(self, points: Points, surface: Surface) -> None:
        """Dissipate the energy of all normal springs, before others take their place."""
        energy = self._released(points, surface, self.numbers.last)
        self.numbers.dissipated += energy

    def _keep(self, points: Points, surface: Surface) -> None:
        """Take back from what was dissipated the energy of the springs that are there now."""
        energy = self._released(points, surface, 0.0)
        self.numbers.dissipated -= energy

    def _released(self, points: Points, surface: Surface, since: float) -> float:
        """Energy [J] that all normal springs would release, after a step of some length [s].

        None in the first step, in which nothing has been touched yet. Tangential springs that are
        no longer near are let go meanwhile.
        """
        if self.numbers.last <= 0.0:
            return 0.0
        near, _, _ = self._measure(points, surface.velocity, since)
        return float(released_energy(points, surface, near, self.numbers.last))

    def _measure(self, points: Points, moving: Array, dt: float) -> tuple[Near, float, float]:
        """Faces near particles with gaps and weights as they are now, after a step of dt [s].

        Returns also the time [s] of `_list`, and the largest depth of `measure`.
        """
        near, apart = self._list(points, moving, dt)
        places = self.corner, self.position, self.across, 2.0 * self.radius, self.slack, self.off
        return near, apart, measure(points.place, points.radius, near, *places)

    def _list(self, points: Points, moving: Array, dt: float) -> tuple[Near, float]:
        """List the faces near particles, if they may have changed in the last step, of dt [s].

        Returns also the time [s] in which others, their radius away at least, come half of the way
        to a radius below a face; the smallest takes least. It does not depend on when faces were
        listed.
        """
        moving = moving[self.touchable]
        mean = moving.mean(axis=0) if len(moving) else np.zeros(3)
        spread = furthest_from(points.velocity, mean) + furthest_from(moving, mean)
        apart = self.smallest / spread if spread > 0.0 and self.active.any() else math.inf
        if self.near is not None:
            self.slack -= dt * spread
            if self.slack >= 0.0:
                return self.near, apart
        self.kicked[:] = 0.0
        self.slack, place = self.radius, self.position
        several = 4 * int(self.across.prod())
        faces = np.flatnonzero(self.active)
        if not len(faces) or not np.isfinite(place).all():
            self.near = no_faces(several)
        else:
            cells = cells_of(np.ascontiguousarray(place[self.corner[faces]]))
            reach = self.reach + self.slack
            row, begin, face = list_near(points.place, reach, cells, faces)
            self.near = near_of(row, begin, face, several)
        self._let_go(points.identity[self.near.row])
        return self.near, apart

    def _let_go(self, near: Array) -> None:
        """Release the tangential springs of particles other than these; their energy is lost."""
        left = np.ones(len(self.slip), bool)
        left[near] = False
        self.numbers.dissipated += float(self.held[left].sum())
        self.slip[left], self.held[left] = 0.0, 0.0

    def stable_step(self, bound: float) -> float:
        """Largest step [s] of particles in contact, of which those without have a bound [s].

        In a step no particle comes more than half of the way to where it would pass through a face.
        """
        numbers = self.numbers
        if not numbers.points:
            return numbers.limit
        alone = (2.0 / bound) ** 2, (2.0 / self.step_of_faces) ** 2
        square = highest_square(alone, (numbers.points, numbers.nodes))
        return min(numbers.limit, self.safety * 2.0 / math.sqrt(square))

    def save(self) -> Fields:
        """Copy out all state."""
        return {
            f"{HEAD}active": self.active.copy(),
            f"{HEAD}before": self.before.copy(),
            f"{HEAD}reaction": self.reaction.copy(),
            f"{HEAD}slip": self.slip.copy(),
            f"{HEAD}held": self.held.copy(),
            f"{HEAD}kicked": self.kicked.copy(),
            f"{HEAD}numbers": np.array(astuple(self.numbers)),
        }

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        self.active = self.coming = np.array(state[f"{HEAD}active"])
        self.touchable = np.unique(self.corner[self.active > 0.0])
        self.before = np.array(state[f"{HEAD}before"])
        self.reaction = np.array(state[f"{HEAD}reaction"])
        self.slip = np.array(state[f"{HEAD}slip"])
        self.held = np.array(state[f"{HEAD}held"])
        self.kicked = np.array(state[f"{HEAD}kicked"])
        self.numbers = Numbers(*state[f"{HEAD}numbers"].tolist())
        self.near = None

    def beginning(self, state: Fields) -> Fields:
        """Return what `load` needs of the state of another run: its history, where it suits.

        A state without contact, with another mesh or other particles starts without history. What
        is summed over the run begins at 0.
        """
        start = self.save()
        is_same = all(key in state and state[key].shape == start[key].shape for key in start)
        numbers = Numbers(*state[f"{HEAD}numbers"].tolist()) if is_same else self.numbers
        numbers = replace(numbers, dissipated=0.0, deepest=0.0, work=0.0, spread=0.0)
        history = {key: state[key] for key in start} if is_same else start
        return {**history, f"{HEAD}numbers": np.array(astuple(numbers))}

    def warnings(self) -> dict[str, str]:
        """Warn of particles that passed through faces, or nearly did."""
        texts = {}
        if self.numbers.deepest > 1.0 and self.off == 0.0:
            texts["contact"] = (
                f"a contact point penetrated {0.5 * self.numbers.deepest:.3g} of the thinner "
                "element's thickness; beyond 0.5 it may pass through a single layer, at 1 it "
                "passes through. Raise the link's stiffness, or refine both sides."
            )
        elif self.numbers.deepest > 1.0:
            texts["contact"] = (
                "particles must stay outside of the faces that they touch; one went "
                f"{self.numbers.deepest:.3g} of its radii deep, and beyond 2 it would pass "
                "through. Raise the link's stiffness, or refine both sides."
            )
        if self.numbers.spread > MOST_SPREAD:
            texts["indentation"] = (
                f"spheres must touch on a radius of at most {MOST_SPREAD:g} of the thickness and "
                "the sides of an element, as elements that resolve a dent add it to that of "
                f"Hertz's law; found {self.numbers.spread:.2g}. Take larger elements, or "
                "particles of sph_solid."
            )
        return texts
