"""Clouds of nodes that go with bodies: holes, fringes, and loads on the bodies' walls.

Velocities are stored in the laboratory's frame, and fluxes computed in that of each node's body, so
neither sources of inertia nor a change of variables between clouds is needed.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.kernels.motion import write_conservative
from quintet.components.meshless_gas.moving.fresh_nodes import fill_fresh_nodes
from quintet.components.meshless_gas.moving.friction import BodyFriction
from quintet.components.meshless_gas.moving.hole_cutting import Holes, without_holes
from quintet.components.meshless_gas.moving.kernels.walls import (
    FORCE,
    HEAT,
    POWER,
    TORQUE,
    add_loads,
    write_slip_walls,
)
from quintet.components.meshless_gas.moving.layout import CloudLayout, Pose
from quintet.components.meshless_gas.moving.outputs import BodyOutputs
from quintet.components.meshless_gas.moving.overset import FringeStencils
from quintet.components.meshless_gas.moving.refusals import (
    refuse_elsewhere,
    refuse_jump,
    refuse_off_axis,
    refuse_off_plane,
    refuse_partner,
    refuse_places,
)
from quintet.components.meshless_gas.moving.start import soft_start
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.parts import NodeMotion, Reader
from quintet.components.meshless_gas.state import State, conserved
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array, Fields, Keys

Rows = NDArray[np.int64]
STAGE_TIMES = (0.0, 1.0, 0.5)  # of SSP-RK3, in steps


class MovingClouds(NodeMotion):
    """Bodies, their clouds, and the fringes between clouds."""

    moves = True

    def __init__(
        self,
        params: MeshlessGasParams,
        domain: Domain,
        layout: CloudLayout,
        friction: BodyFriction,
        team: Team,
    ) -> None:
        assert params.moving is not None
        self.params, self.domain, self.layout, self.team = params.moving, domain, layout, team
        self.gamma, self.friction = params.gas.gamma, friction
        self.outflows = domain.outflows  # of the box, whether left out or not
        bodies, cloud = self.params.bodies, domain.cloud
        self.pose = Pose(
            np.array([body.centre for body in bodies]),
            np.array([body.velocity for body in bodies]),
            np.array([(0.0, body.angular_velocity, 0.0) for body in bodies]),
        )
        self.driven = np.array([k for k, body in enumerate(bodies) if body.is_driven], np.int64)
        self.heat_is_joined = False  # whether a partner takes the heat of driven bodies
        self.middle: Array | None = None  # (driven, 3) m, places at the middle of the coming step
        self.holes = Holes(params.moving, layout, cloud, team)
        self.fringe = FringeStencils(layout, domain, team)
        self.frame: Array = np.zeros((len(cloud.positions), 3))
        self.wall_velocity = np.zeros((len(layout.walls), 3))
        self.loads = np.zeros((len(bodies), 8))  # now; columns as in `kernels.walls`
        self.summed = np.zeros((len(bodies), 8))  # in the mean over the last step
        self.outputs = BodyOutputs(params, layout, cloud.areas, self.driven)
        self._place(self.pose.centre)
        self._set_frame()
        self._cut(is_first=True)

    # Steps

    def bind(self, static: Fields, joined: Keys) -> None:
        """Check the sizes of a partner's bodies; learn whether it takes the heat of driven ones."""
        refuse_partner(static, self.layout.radii, self.driven)
        self.heat_is_joined = "heat" in joined

    def prime(self, fields: Fields, primitive: Array) -> None:
        """Check where a partner's bodies begin."""
        if "motion.position" in fields:
            radii, centre = self.layout.radii[self.driven], self.pose.centre[self.driven]
            refuse_elsewhere(fields["motion.position"], centre, radii, self.driven)

    def soften_start(self, state: State) -> None:
        """Start gas near a body with the body's velocity, which fades over one radius."""
        cloud = self.domain.cloud
        soft_start(state, cloud.positions[: cloud.nodes], self.layout.radii, self.pose, self.gamma)
        state.begun[:] = conserved(state.conservative, cloud.volumes, self.team)

    def take(self, fields: Fields) -> None:
        """Take the motion of driven bodies: places at the middle of the step, mean velocities."""
        if "motion.position" not in fields:
            return
        # Nothing leaves a plane, not by rounding either.
        flat, across = np.ones(3), np.ones(3)
        if self.layout.planar:
            refuse_off_plane(fields["motion.position"], fields["motion.velocity"], self.driven)
            flat, across = np.array([1.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
        self.middle = fields["motion.position"] * flat
        self.pose.velocity[self.driven] = fields["motion.velocity"] * flat
        if "motion.angular_velocity" in fields:
            self.pose.spin[self.driven] = fields["motion.angular_velocity"] * across
        if self.params.axisymmetric:
            velocity, spin = self.pose.velocity[self.driven], self.pose.spin[self.driven]
            refuse_off_axis(self.middle, velocity, spin, self.driven)

    def begin(self, dt: float, primitive: Array, conservative: Array) -> None:
        """Move clouds to the step's start; cut holes again if bodies have moved far enough."""
        self.move_to_start(dt)
        if self.holes.are_old(self.pose.centre):
            self.cut_again(primitive, conservative)
        else:
            self.fringe.refit(self.pose.centre)

    def move_to_start(self, dt: float) -> None:
        """Move bodies and the nodes of their clouds to the start of a step of dt [s]."""
        if self.middle is not None:
            moved = self.middle - 0.5 * dt * self.pose.velocity[self.driven]
            near = self.layout.spacing[self.driven]
            refuse_jump(moved, self.pose.centre[self.driven], near, self.driven)
            self.pose.centre[self.driven] = moved
        refuse_places(self.layout, self.pose.centre + dt * self.pose.velocity)
        self._place(self.pose.centre)
        self._set_frame()
        self.summed[:] = 0.0

    def cut_again(self, primitive: Array, conservative: Array) -> Rows:
        """Cut holes; return the nodes that came back, whose states are written."""
        fresh = self._cut()
        if not len(fresh):
            return fresh
        fill_fresh_nodes(
            fresh, self.holes.active, self.pose.centre, self.domain.cloud, self.layout, self.team,
            primitive,
        )  # fmt: skip
        states = np.empty((len(fresh), 5))
        write_conservative(primitive[fresh], self.gamma, states)
        conservative[fresh] = states
        return fresh

    def place(self, stage: int, dt: float) -> None:
        """Move clouds to where they are at a stage, and fit coefficients across fringes again."""
        if stage > 0:
            self._move(self.pose.centre + STAGE_TIMES[stage] * dt * self.pose.velocity)

    def end(self, dt: float) -> None:
        """Move clouds to the step's end."""
        self.pose.centre[:] += dt * self.pose.velocity
        self._move(self.pose.centre)

    # Stages

    def write_walls(self, domain: Domain, primitive: Array) -> None:
        """Write the states of the bodies' walls."""
        layout = self.layout
        primitive[layout.leaving] = primitive[layout.before]
        write_slip_walls(
            layout.walls, layout.above, layout.heights, domain.cloud.normals[layout.walls],
            self.wall_velocity, self.gamma, primitive,
        )  # fmt: skip
        self.friction.write_walls(self.wall_velocity, primitive)

    def add_flows(self, domain: Domain, primitive: Array, flows: Array) -> None:
        """Compute the present loads on bodies, and add what the gas gets from them to `flows`."""
        layout, cloud, loads = self.layout, domain.cloud, self.loads
        loads[:] = 0.0
        add_loads(
            layout.walls, layout.body, cloud.areas[layout.walls], layout.arms, self.wall_velocity,
            primitive, loads,
        )  # fmt: skip
        self.friction.add_loads(cloud, self.wall_velocity, self.pose.spin, primitive, loads)
        if self.params.axisymmetric:  # whole circles have no force across the axis, and no torque
            loads[:, 1:3], loads[:, TORQUE] = 0.0, 0.0
        flows[1:4] -= loads[:, FORCE].sum(axis=0)
        flows[4] += (loads[:, POWER] - loads[:, HEAT]).sum()

    def flatten(self, gradients: Array) -> None:
        """Set gradients to zero at nodes that reach over a fringe, if the scene asks for it."""
        if self.params.fringe_order == 1:
            gradients[self.fringe.across] = 0.0

    def sum_loads(self, share: float) -> None:
        """Add the present loads to their mean over the step."""
        self.summed += share * self.loads

    def partner_power(self) -> float:
        """Energy [W] that links bring the gas now, from bodies that a partner moves or heats."""
        loads = self.loads[self.driven]
        return float((loads[:, POWER] - self.heat_is_joined * loads[:, HEAT]).sum())

    def readers(self, primitive: Array) -> Mapping[str, Reader]:
        """Readers of the bodies' ports."""
        outputs, positions = self.outputs, self.domain.cloud.positions
        return {
            "bodies": lambda: outputs.bodies(
                self.pose, self.summed, primitive, self.holes.fresh_count
            ),
            "surface": lambda: outputs.surface(positions, primitive, self.friction),
            "load": lambda: outputs.load(self.summed),
            "heat": lambda: outputs.heat(self.summed),
        }

    # Geometry

    def _move(self, centre: Array) -> None:
        """Move bodies' clouds to new centres (b, 3) m."""
        self._place(centre)
        self.fringe.refit(centre)

    def _place(self, centre: Array) -> None:
        """Place the nodes of all clouds round centres (b, 3) m, and images beyond the axis."""
        positions, layout, self.placed = self.domain.cloud.positions, self.layout, centre
        positions[layout.carried] = layout.offsets + centre[layout.carrier]
        positions[layout.images] = positions[layout.imaged] * np.array([1.0, 1.0, -1.0])

    def _set_frame(self) -> None:
        """Set the velocities of nodes; walls turn with their body."""
        layout = self.layout
        self.frame[layout.carried] = self.pose.velocity[layout.carrier]
        turning = np.cross(self.pose.spin[layout.body], layout.arms)
        self.wall_velocity[:] = self.pose.velocity[layout.body] + turning

    def _cut(self, is_first: bool = False) -> Rows:
        """Cut holes and find neighbours across fringes; return the nodes that came back."""
        fresh = self.holes.cut(self.pose.centre, is_first)
        self.fringe.join(self.holes.active, self.pose.centre)
        self.domain = without_holes(self.domain, self.holes, self.outflows)
        return fresh

    # State

    def _arrays(self) -> dict[str, Array]:
        """Arrays of the state that keep their shape."""
        stencils = self.domain.stencils
        return {
            "centre": self.pose.centre, "velocity": self.pose.velocity, "spin": self.pose.spin,
            "seen": self.holes.seen, "active": self.holes.active,
            "neighbours": stencils.neighbours, "coefficients": stencils.coefficients,
            "summed": self.summed, "volumes": self.holes.volumes,
        }  # fmt: skip

    def save(self) -> dict[str, Array]:
        """Copy out all that does not follow from the parameters."""
        saved = self._arrays() | {
            "touched": self.fringe.touched,
            "across": self.fringe.across,
            "fresh_count": np.array(self.holes.fresh_count),
        }
        return {f"moving/{name}": np.array(array) for name, array in saved.items()}

    def restore(self, saved: Fields) -> None:
        """Return to a saved state, bit for bit."""
        for name, array in self._arrays().items():
            array[:] = saved[f"moving/{name}"]
        self.fringe.touched = np.array(saved["moving/touched"], np.int64)
        self.fringe.across = np.array(saved["moving/across"], np.int64)
        self.holes.fresh_count = int(saved["moving/fresh_count"])
        self.middle = None
        self._place(self.pose.centre)
        self.fringe.fitted[:] = self.pose.centre
        self.fringe.weigh(self.domain.edges.astype(np.int64))
        self._set_frame()
        self.domain = without_holes(self.domain, self.holes, self.outflows)
