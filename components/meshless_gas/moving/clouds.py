"""Clouds of nodes that go with bodies: holes, seams, and what walls of bodies feel.

Velocities are stored in the laboratory's frame, and fluxes computed in that of each node's body, so
neither sources of inertia nor a change of variables between clouds is needed.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.clouds.cloud import INNER, OUTFLOW
from quintet.components.meshless_gas.clouds.nearest import nearest
from quintet.components.meshless_gas.kernels.boundaries import write_weights
from quintet.components.meshless_gas.kernels.outflows import uncovered
from quintet.components.meshless_gas.moving.axis import add_axis
from quintet.components.meshless_gas.moving.holes import cut, part
from quintet.components.meshless_gas.moving.layout import CloudLayout, Pose, write_plane_areas
from quintet.components.meshless_gas.moving.outputs import outputs, unit_force, unit_heat
from quintet.components.meshless_gas.moving.refusals import (
    refuse_jump,
    refuse_off_axis,
    refuse_places,
    too_few,
)
from quintet.components.meshless_gas.moving.seams import around, choose
from quintet.components.meshless_gas.moving.start import soft_start
from quintet.components.meshless_gas.moving.uncovered import uncover
from quintet.components.meshless_gas.moving.walls import add_loads, hold_slip_walls
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.state import Fluxes, State
from quintet.components.meshless_gas.stencils import SOUND, write_coefficients
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array, Fields, Keys
from quintet.interfaces.errors import StepError

if TYPE_CHECKING:
    from quintet.components.meshless_gas.moving.friction import AxisStresses, Friction
    from quintet.components.meshless_gas.viscous.terms import Viscous

Rows = NDArray[np.int64]
Flags = NDArray[np.bool_]
BAND = 3.0  # spacings about a seam within which neighbours are found anew
NEAR = 4  # times as many nodes are looked at as a node has neighbours
STAGE_TIMES = (0.0, 1.0, 0.5)  # of SSP-RK3, in steps


class MovingClouds:
    """Bodies, their clouds, and the seams between clouds."""

    def __init__(
        self, params: MeshlessGasParams, domain: Domain, layout: CloudLayout, team: Team
    ) -> None:
        assert params.moving is not None
        self.params, self.domain, self.layout, self.team = params.moving, domain, layout, team
        self.gamma, self.unit_force = params.gas.gamma, unit_force(params)
        self.outflows = domain.outflows  # of the box, whether left out or not
        self.unit_heat = unit_heat(params)
        self.kept = layout.kept  # neighbours of a node across seams
        bodies, cloud = self.params.bodies, domain.cloud
        self.pose = Pose(
            np.array([one.position for one in bodies]),
            np.array([one.velocity for one in bodies]),
            np.array([(0.0, one.angular_velocity, 0.0) for one in bodies]),
        )
        self.driven = np.array([k for k, one in enumerate(bodies) if one.is_driven], np.int64)
        self.heat_is_joined = False  # whether a partner takes the heat of driven bodies
        self.given: Array | None = None  # (driven, 3) m, places at the middle of the coming step
        self.radii = np.array([one.radius for one in bodies])
        self.spacing = np.array([one.spacing for one in bodies])
        self.thickness = np.array([one.heights[-1] for one in bodies])
        self.active = np.ones(len(cloud.positions), bool)
        self.seen = self.pose.centre.copy()  # (b, 3) m, when holes were cut last
        self.touched = np.zeros(0, np.int64)  # nodes whose neighbours are not those of their cloud
        self.across = np.zeros(0, np.int64)  # of these, those that reach over a seam
        self.quality = np.ones(len(cloud.positions))
        self.least = np.zeros(len(cloud.positions))  # weight of least squares across seams
        self.frame = np.zeros((len(cloud.positions), 3))
        self.wall_velocity = np.zeros((len(layout.walls), 3))
        self.loads = np.zeros((len(bodies), 8))  # N, N m, W of walls on gas, W of heat: now
        self.summed = np.zeros((len(bodies), 8))  # in the mean over the last step
        self.friction: Friction | None = None  # of walls that hold the gas
        self.stresses: AxisStresses | None = None  # of a viscous gas about an axis
        self.uncovered = 0  # nodes that came back since the start
        self._place(self.pose.centre)
        self._set_frame()
        self._cut(is_first=True)

    # Steps

    def bind(self, joined: Keys) -> None:
        """Learn whether a partner takes the heat of driven bodies: it is then in its account."""
        self.heat_is_joined = "heat" in joined

    def soften_start(self, state: State) -> None:
        """Let gas near a body begin with the body's velocity, which fades over one radius."""
        soft_start(self, state)

    def take(self, fields: Fields) -> None:
        """Take the motion of driven bodies: places at the middle of the step, mean velocities."""
        if "motion.position" not in fields:
            return
        # Nothing leaves a plane.
        flat, across = np.ones(3), np.ones(3)
        if self.layout.planar:
            flat, across = np.array([1.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
        self.given = fields["motion.position"] * flat
        self.pose.velocity[self.driven] = fields["motion.velocity"] * flat
        if "motion.angular_velocity" in fields:
            self.pose.spin[self.driven] = fields["motion.angular_velocity"] * across
        if self.params.axisymmetric:
            refuse_off_axis(self.given, self.pose.velocity[self.driven], self.driven)

    def begin(self, dt: float, primitive: Array, conservative: Array) -> bool:
        """Put clouds where they are at the step's start; cut holes anew where they have moved."""
        if self.given is not None:
            moved = self.given - 0.5 * dt * self.pose.velocity[self.driven]
            refuse_jump(
                moved, self.pose.centre[self.driven], self.spacing[self.driven], self.driven
            )
            self.pose.centre[self.driven] = moved
        refuse_places(
            self.layout,
            self.radii,
            self.thickness,
            self.spacing,
            self.pose.centre + dt * self.pose.velocity,
        )
        self._place(self.pose.centre)
        self._set_frame()
        self.summed[:] = 0.0
        way = np.abs(self.pose.centre - self.seen).max(axis=1)
        if (way > self.params.threshold * self.spacing).any():
            fresh = self._cut()
            uncover(self, fresh, primitive, conservative)
        else:
            self._refit()
        return True

    def place(self, stage: int, dt: float) -> None:
        """Move clouds to where they are at a stage; coefficients across seams follow."""
        if stage > 0:
            self._place(self.pose.centre + STAGE_TIMES[stage] * dt * self.pose.velocity)
            self._refit()

    def end(self, dt: float) -> None:
        """Move clouds to the step's end."""
        self.pose.centre[:] += dt * self.pose.velocity
        self._place(self.pose.centre)
        self._refit()

    # Stages

    def hold_walls(self, primitive: Array) -> None:
        """Write the states of the bodies' walls."""
        own = self.layout
        primitive[own.leaving] = primitive[own.before]
        hold_slip_walls(
            own.walls, own.above, own.heights, self.domain.cloud.normals[own.walls],
            self.wall_velocity, self.gamma, primitive,
        )  # fmt: skip
        if self.friction is not None:
            self.friction.hold(self.wall_velocity, primitive)

    def load(self, primitive: Array, flows: Array) -> None:
        """Find what bodies are loaded with now, and add what the gas gets from them to `flows`."""
        own, cloud = self.layout, self.domain.cloud
        self.loads[:] = 0.0
        add_loads(
            own.walls, own.body, cloud.areas[own.walls], own.arms, self.wall_velocity, primitive,
            self.loads,
        )  # fmt: skip
        if self.friction is not None:
            self.friction.load(cloud, self.wall_velocity, self.pose.spin, primitive, self.loads)
        if self.params.axisymmetric:  # of a whole turn about the axis nothing else is left
            self.loads[:, 1:6] = 0.0
        flows[1:4] -= self.loads[:, :3].sum(axis=0)
        flows[4] += (self.loads[:, 6] - self.loads[:, 7]).sum()

    def flatten(self, gradients: Array) -> None:
        """Let states be constant around nodes that reach over a seam, if the scene asks for it."""
        if self.params.seam_order == 1:
            gradients[self.across] = 0.0

    def add_rates(self, share: float, work: Fluxes, viscous: "Viscous | None") -> None:
        """Add what symmetry about the axis asks for; sum the loads of a stage."""
        self.summed += share * self.loads
        if not self.params.axisymmetric:
            return
        rows, positions = self.domain.inner, self.domain.cloud.positions
        self.team.run(
            add_axis, len(rows), rows, positions, work.primitive, self.gamma, work.residual
        )
        if self.stresses is not None and viscous is not None:
            flow = viscous.transported, work.gradients, viscous.gradients
            self.stresses.add(
                self.team, rows, positions, work.primitive, self.domain.stencils, flow,
                work.residual,
            )  # fmt: skip

    def power_of_partners(self) -> float:
        """Energy [W] that links bring the gas now: from bodies that a partner moves or heats."""
        loads = self.loads[self.driven]
        return float((loads[:, 6] - self.heat_is_joined * loads[:, 7]).sum())

    def outputs(self, primitive: Array) -> dict[str, Array]:
        """Fields of the bodies' ports."""
        return outputs(self, primitive)

    # Geometry

    def _place(self, centre: Array) -> None:
        """Move the nodes of all clouds, and their images beyond the axis."""
        positions, own = self.domain.cloud.positions, self.layout
        positions[own.carried] = own.offsets + centre[own.carrier]
        positions[own.images] = positions[own.imaged] * np.array([1.0, 1.0, -1.0])

    def _set_frame(self) -> None:
        """Velocities of nodes; walls turn with their body."""
        own = self.layout
        self.frame[own.carried] = self.pose.velocity[own.carrier]
        turning = np.cross(self.pose.spin[own.body], own.arms)
        self.wall_velocity[:] = self.pose.velocity[own.body] + turning

    def _cut(self, is_first: bool = False) -> Rows:
        """Cut holes, find neighbours anew; return the nodes that came back."""
        cloud, own, keys = self.domain.cloud, self.layout, self.params
        count, positions, centre = cloud.nodes, cloud.positions, self.pose.centre
        refuse_places(self.layout, self.radii, self.thickness, self.spacing, centre)
        was = self.active[:count].copy()
        active = np.empty(count, bool)
        margins = np.where(is_first, 0.0, keys.hysteresis) * self.spacing
        depths = self.thickness - keys.overlap * self.spacing
        covered = cut(
            positions, cloud.region[:count], own.height, centre, self.radii, depths, margins, was,
            active,
        )  # fmt: skip
        if covered >= 0:
            raise StepError(
                f"walls must lie in the gas; that at {positions[covered].tolist()} m lies in "
                "another body. Move the bodies apart."
            )
        away = self.heights(positions[:count])
        for b in range(len(self.radii)):
            self._part(b, away[b], was, active, margins[b])
        self.active[:count] = active
        self.active[count:] = active[cloud.owner]
        fresh = np.flatnonzero(active & ~was)
        self._join(away)
        self.seen[:] = centre
        self.uncovered += len(fresh)
        self._leave_out()
        return fresh

    def _leave_out(self) -> None:
        """Let volumes, boundaries and rows be those of nodes that are not left out."""
        cloud, own = self.domain.cloud, self.layout
        active = self.active[: cloud.nodes]
        cloud.volumes[: cloud.nodes] = np.where(active, own.volumes, 0.0)
        inner = np.flatnonzero(active & (cloud.kind[: cloud.nodes] == INNER)).astype(np.int32)
        every = np.flatnonzero(active).astype(np.int32)
        self.domain = self.domain._replace(inner=inner, every=every)
        if own.is_cut.any():  # a cloud that reaches the box's face covers nodes of it
            cloud.areas[: cloud.nodes] = np.where(active[:, None], own.areas, 0.0)
            self.domain = self.domain._replace(outflows=uncovered(self.outflows, active))
            if own.planar:
                wall = self.radii[own.is_cut].max()
                there = own.plane[active[own.plane]]
                write_plane_areas(there, cloud.positions, wall, cloud.areas)
            write_weights(
                self.domain.edges, cloud.kind, cloud.normals, *self.domain.stencils,
                self.domain.weights,
            )  # fmt: skip

    def heights(self, places: Array) -> Array:
        """Heights (b, m) m of places above bodies."""
        apart = places[None] - self.pose.centre[:, None]
        return np.asarray(np.sqrt((apart**2).sum(axis=2)) - self.radii[:, None])

    def _part(self, b: int, away: Array, was: Flags, active: Flags, more: float) -> None:
        """Leave out nodes of other clouds that lie too near to nodes of a body's cloud."""
        region = self.domain.cloud.region[: len(active)]
        h, top = self.spacing[b], self.thickness[b]
        own = np.flatnonzero(active & (region == b + 1))
        rows = np.flatnonzero(active & (region != b + 1) & (away < top + h))
        rows = rows[np.isin(self.domain.cloud.kind[rows], (INNER, OUTFLOW))]
        if len(rows) and len(own):
            positions = self.domain.cloud.positions
            _, squares = nearest(positions, own, positions[rows], 1, self.team)
            part(rows, squares, self.params.seam_distance * h, more, was, active)

    def _join(self, away: Array) -> None:
        """Find neighbours across seams, and coefficients of all nodes that they changed for."""
        cloud, own = self.domain.cloud, self.layout
        count, neighbours = cloud.nodes, self.domain.stencils.neighbours
        region, active = cloud.region[:count], self.active[:count]
        band = np.zeros(count, bool)
        near_any = np.zeros(count, bool)
        for b, one in enumerate(away):
            reach = BAND * self.spacing[b]
            mine = region == b + 1
            band |= ~mine & (one < self.thickness[b] + reach)
            band |= mine & (one > self.thickness[b] - reach)
            near_any |= ~mine & (one < self.thickness[b] + 2.0 * reach) | mine
        band &= active & (own.height > 0.0)
        if not own.planar:
            band[own.leaving] = False  # they have the state of the node beside them
        rows = np.flatnonzero(band)
        before = self.touched
        neighbours[before] = own.home[before]
        among = np.flatnonzero(np.concatenate([near_any & active, self._images(near_any)]))
        found = around(rows, among, cloud, NEAR * self.kept, own.planar, self.team)
        lacks = choose(
            rows, found, cloud.positions, cloud.spacing, self.pose.centre, self.radii, self.kept,
            4 if own.planar else 6, neighbours,
        )  # fmt: skip
        if lacks >= 0:
            raise StepError(too_few(self.kept, cloud.positions[lacks]))
        other = (cloud.region[neighbours[rows]] != region[rows][:, None]).any(axis=1)
        whole = self.active[own.home[rows]].all(axis=1)
        back = rows[whole & ~other]
        neighbours[back] = own.home[back]
        self.touched, self.across = rows[~(whole & ~other)], rows[other]
        self._fit(np.union1d(before, self.touched))

    def _images(self, near: Flags) -> Flags:
        owner = self.domain.cloud.owner
        return np.asarray(near[owner] & self.active[owner])

    def _fit(self, rows: Rows) -> None:
        """Write the coefficients of nodes."""
        cloud, made = self.domain.cloud, self.domain.stencils
        weight = cloud.weight
        if len(self.across):
            weight = weight.copy()
            weight[self.across] = self.least[self.across]
        self.team.run(
            write_coefficients, len(rows), rows, cloud.positions, made.neighbours, weight,
            self.layout.planar, made.coefficients, self.quality,
        )  # fmt: skip
        bad = rows[self.quality[rows] < SOUND]
        if len(bad):
            raise StepError(too_few(self.kept, cloud.positions[bad[0]]))

    def _refit(self) -> None:
        """Write the coefficients of what reaches over seams, where clouds have moved apart."""
        if len(self.across):
            self._fit(self.across)

    # State

    def save(self) -> dict[str, Array]:
        """Copy out all that does not follow from the parameters."""
        made = self.domain.stencils
        kept = {
            "centre": self.pose.centre, "velocity": self.pose.velocity, "spin": self.pose.spin,
            "seen": self.seen, "active": self.active, "touched": self.touched,
            "across": self.across, "neighbours": made.neighbours,
            "coefficients": made.coefficients, "summed": self.summed,
            "uncovered": np.array(self.uncovered),
        }  # fmt: skip
        return {f"moving/{name}": np.array(one) for name, one in kept.items()}

    def restore(self, saved: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        made = self.domain.stencils
        for name, array in (
            ("centre", self.pose.centre), ("velocity", self.pose.velocity),
            ("spin", self.pose.spin), ("seen", self.seen), ("active", self.active),
            ("neighbours", made.neighbours), ("coefficients", made.coefficients),
            ("summed", self.summed),
        ):  # fmt: skip
            array[:] = saved[f"moving/{name}"]
        self.touched = np.array(saved["moving/touched"], np.int64)
        self.across = np.array(saved["moving/across"], np.int64)
        self.uncovered = int(saved["moving/uncovered"])
        self.given = None
        self._place(self.pose.centre)
        self._set_frame()
        self._leave_out()
