"""Clouds of nodes that go with bodies: holes, seams, and what walls of bodies feel.

Velocities are stored in the laboratory's frame, and fluxes computed in that of each node's body, so
neither sources of inertia nor a change of variables between clouds is needed.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.moving.fresh_nodes import fill_fresh_nodes
from quintet.components.meshless_gas.moving.hole_cutting import Holes, without_holes
from quintet.components.meshless_gas.moving.kernels.axis import add_axis
from quintet.components.meshless_gas.moving.kernels.walls import add_loads, write_slip_walls
from quintet.components.meshless_gas.moving.layout import CloudLayout, Pose
from quintet.components.meshless_gas.moving.outputs import (
    base_force,
    outputs,
    unit_force,
    unit_heat,
)
from quintet.components.meshless_gas.moving.overset import FringeStencils
from quintet.components.meshless_gas.moving.refusals import (
    refuse_jump,
    refuse_off_axis,
    refuse_off_plane,
    refuse_partner,
    refuse_places,
)
from quintet.components.meshless_gas.moving.start import soft_start
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.state import Fluxes, State
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array, Fields, Keys

if TYPE_CHECKING:
    from quintet.components.meshless_gas.moving.friction import AxisStresses, Friction
    from quintet.components.meshless_gas.viscous.terms import Viscous

Rows = NDArray[np.int64]
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
        self.base_force = base_force(params, layout, domain.cloud.areas)  # (b, 3) N
        bodies, cloud = self.params.bodies, domain.cloud
        self.pose = Pose(
            np.array([one.position for one in bodies]),
            np.array([one.velocity for one in bodies]),
            np.array([(0.0, one.angular_velocity, 0.0) for one in bodies]),
        )
        self.driven = np.array([k for k, one in enumerate(bodies) if one.is_driven], np.int64)
        self.heat_is_joined = False  # whether a partner takes the heat of driven bodies
        self.given: Array | None = None  # (driven, 3) m, places at the middle of the coming step
        self.holes = Holes(params.moving, layout, cloud, team)
        self.fringe = FringeStencils(layout, domain, team)
        self.frame = np.zeros((len(cloud.positions), 3))
        self.wall_velocity = np.zeros((len(layout.walls), 3))
        self.loads = np.zeros((len(bodies), 8))  # N, N m, W of walls on gas, W of heat: now
        self.summed = np.zeros((len(bodies), 8))  # in the mean over the last step
        self.friction: Friction | None = None  # of walls that hold the gas
        self.stresses: AxisStresses | None = None  # of a viscous gas about an axis
        self._place(self.pose.centre)
        self._set_frame()
        self._cut(is_first=True)

    # Steps

    def bind(self, static: Fields, joined: Keys) -> None:
        """Learn how large a partner's bodies are, and whether it takes the heat of driven ones."""
        refuse_partner(static, self.layout.radii, self.driven)
        self.heat_is_joined = "heat" in joined

    def soften_start(self, state: State) -> None:
        """Let gas near a body begin with the body's velocity, which fades over one radius."""
        soft_start(self, state)

    def take(self, fields: Fields) -> None:
        """Take the motion of driven bodies: places at the middle of the step, mean velocities."""
        if "motion.position" not in fields:
            return
        # Nothing leaves a plane, not by rounding either.
        flat, across = np.ones(3), np.ones(3)
        if self.layout.planar:
            refuse_off_plane(fields["motion.position"], fields["motion.velocity"], self.driven)
            flat, across = np.array([1.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
        self.given = fields["motion.position"] * flat
        self.pose.velocity[self.driven] = fields["motion.velocity"] * flat
        if "motion.angular_velocity" in fields:
            self.pose.spin[self.driven] = fields["motion.angular_velocity"] * across
        if self.params.axisymmetric:
            refuse_off_axis(
                self.given, self.pose.velocity[self.driven], self.pose.spin[self.driven],
                self.driven,
            )  # fmt: skip

    def begin(self, dt: float, primitive: Array, conservative: Array) -> bool:
        """Put clouds where they are at the step's start; cut holes anew where they have moved."""
        if self.given is not None:
            moved = self.given - 0.5 * dt * self.pose.velocity[self.driven]
            near = self.layout.spacing[self.driven]
            refuse_jump(moved, self.pose.centre[self.driven], near, self.driven)
            self.pose.centre[self.driven] = moved
        refuse_places(self.layout, self.pose.centre + dt * self.pose.velocity)
        self._place(self.pose.centre)
        self._set_frame()
        self.summed[:] = 0.0
        if self.holes.are_old(self.pose.centre):
            fill_fresh_nodes(self, self._cut(), primitive, conservative)
        else:
            self.fringe.refit(self.pose.centre)
        return True

    def place(self, stage: int, dt: float) -> None:
        """Move clouds to where they are at a stage; coefficients across seams follow."""
        if stage > 0:
            centre = self.pose.centre + STAGE_TIMES[stage] * dt * self.pose.velocity
            self._place(centre)
            self.fringe.refit(centre)

    def end(self, dt: float) -> None:
        """Move clouds to the step's end."""
        self.pose.centre[:] += dt * self.pose.velocity
        self._place(self.pose.centre)
        self.fringe.refit(self.pose.centre)

    # Stages

    def hold_walls(self, primitive: Array) -> None:
        """Write the states of the bodies' walls."""
        own = self.layout
        primitive[own.leaving] = primitive[own.before]
        write_slip_walls(
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
            gradients[self.fringe.across] = 0.0

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
        fresh = self.holes.cut(self.pose.centre, is_first)
        self.fringe.join(self.holes.active, self.pose.centre)
        self._leave_out()
        return fresh

    def _leave_out(self) -> None:
        """Let the domain be that of nodes that are not left out."""
        self.domain = without_holes(self.domain, self.holes, self.outflows)

    # State

    def save(self) -> dict[str, Array]:
        """Copy out all that does not follow from the parameters."""
        made = self.domain.stencils
        kept = {
            "centre": self.pose.centre, "velocity": self.pose.velocity, "spin": self.pose.spin,
            "seen": self.holes.seen, "active": self.holes.active, "touched": self.fringe.touched,
            "across": self.fringe.across, "neighbours": made.neighbours,
            "coefficients": made.coefficients, "summed": self.summed,
            "volumes": self.holes.volumes, "uncovered": np.array(self.holes.uncovered),
        }  # fmt: skip
        return {f"moving/{name}": np.array(one) for name, one in kept.items()}

    def restore(self, saved: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        made = self.domain.stencils
        for name, array in (
            ("centre", self.pose.centre), ("velocity", self.pose.velocity),
            ("spin", self.pose.spin), ("seen", self.holes.seen), ("active", self.holes.active),
            ("neighbours", made.neighbours), ("coefficients", made.coefficients),
            ("summed", self.summed), ("volumes", self.holes.volumes),
        ):  # fmt: skip
            array[:] = saved[f"moving/{name}"]
        self.fringe.touched = np.array(saved["moving/touched"], np.int64)
        self.fringe.across = np.array(saved["moving/across"], np.int64)
        self.holes.uncovered = int(saved["moving/uncovered"])
        self.given = None
        self._place(self.pose.centre)
        self.fringe.fitted[:] = self.pose.centre
        self.fringe.weigh(self.domain.edges.astype(np.int64))
        self._set_frame()
        self._leave_out()
