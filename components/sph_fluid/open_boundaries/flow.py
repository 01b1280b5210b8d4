"""Fluid that comes and goes through faces of the tank; imported only by a scene that asks.

Buffers of particles after Tafuni, Domínguez, Vacondio & Crespo, Comput. Methods Appl. Mech. Eng.
342 (2018) 604. They lie in the tank, behind each inflow and before each outflow, and are as deep as
pairs act. Their particles move straight on, at constant velocity and density, and act on the fluid
as fluid does; nothing acts on them. Whenever neighbour lists are made,

- a particle that leaves the buffer of an inflow is fluid from then on, and another one begins a
  buffer's length behind it, so that rows of the buffer have no gaps whatever their speeds;
- a particle that enters the buffer of an outflow has left the fluid, and one that passes the face
  is removed; fluid that is driven back into an inflow by more than a layer has left too;
- what a buffer takes from the fluid is fitted to the particles before it: velocity and density of
  an outflow, density of an inflow, constant along the axis (Tafuni et al. carry on gradients).

Buffers are no part of the fluid: its mass and energies are those of what is between them. What
particles carry in and out of kinetic and potential energy is work from outside; what buffers do by
their pressure is not counted.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.sph_fluid.boundary.kernels.mirrored_density import NO_FLUID
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.kernels import Rates, write_pressure
from quintet.components.sph_fluid.open_boundaries.kernels import fit_fields, near_rows
from quintet.components.sph_fluid.open_boundaries.rows import NewRows, add_rows, take_out
from quintet.components.sph_fluid.open_boundaries.saved_faces import (
    numbers_of,
    refuse_other_faces,
)
from quintet.components.sph_fluid.open_boundaries.zones import (
    Zone,
    at_rest,
    sites,
    under_pressure,
    zones,
)
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.inflow_outflow import Inflow, Outflow, buffer_layers
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import StepError

BEFORE = 1.0  # smoothing lengths before a buffer, where it takes values of the fluid
AROUND = 2.0  # smoothing lengths around that place that are looked at: the kernel's radius


class Flow:
    """The inflows and outflows of one fluid."""

    def __init__(self, params: SphFluidParams) -> None:
        self.params, self.constants, self.zones = params, constants(params), zones(params)
        self.inflow, self.outflow = params.boundary.inflow, params.boundary.outflow
        self._gravity = params.gravity
        self.layers = buffer_layers(params.smoothing)
        self.buffer_rows: Whole = np.zeros(0, np.int64)  # (k,) rows of particles in buffers

    def start(self, state: State) -> None:
        """Fill the buffers of inflows; what begins in those of outflows is part of these."""
        state.role = np.zeros(state.fluid, np.int64)
        state.passed = np.zeros(len(self.zones), np.int64)
        in_inflow = np.zeros(state.fluid, bool)
        for number, zone in enumerate(self.zones):
            inside = zone.holds(state.position_density[: state.fluid])
            if number < len(self.inflow):
                in_inflow |= inside
            else:
                state.role[inside & ~in_inflow] = number + 1
        take_out(state, in_inflow)
        state.identity, state.born = np.arange(state.fluid), state.fluid
        for number, inflow in enumerate(self.inflow):
            self._fill(state, number, inflow)
        state.at_start = int((state.role == 0).sum())
        self._follow_fluid(state)

    def _fill(self, state: State, number: int, inflow: Inflow) -> None:
        """Put particles into the buffer of an inflow."""
        zone, places = self.zones[number], sites(self.params, inflow)
        inflow.check_speed(places)
        points = np.tile(places, (self.layers, 1))
        depth = (np.repeat(np.arange(self.layers), len(places)) + 0.5) * zone.step
        points[:, zone.axis] += zone.inward * depth
        self._enter(state, number, points, np.full(len(points), self.params.density))

    def _enter(self, state: State, number: int, points: Array, density: Array) -> None:
        """Add particles at points (n, 3) m of a density (n,) kg/m3 to the buffer of an inflow."""
        zone, inflow = self.zones[number], self.inflow[number]
        at_face = points.copy()
        at_face[:, zone.axis] = zone.face
        velocity = np.zeros_like(points)
        velocity[:, zone.axis] = zone.inward * inflow.speed_at(at_face)
        role = np.full(len(points), number + 1)
        add_rows(state, NewRows(np.column_stack([points, density]), velocity, role))

    def renew(self, state: State) -> None:
        """Let particles come and go, before neighbour lists are made."""
        for number, zone in enumerate(self.zones):
            if number < len(self.inflow):
                self._let_in(state, number, zone)
            else:
                self._let_out(state, number, zone)
        self._follow_fluid(state)

    def _let_in(self, state: State, number: int, zone: Zone) -> None:
        """Let particles of an inflow's buffer into the fluid; begin others behind them."""
        depth = zone.depth(state.position_density[: state.fluid])
        is_back = (state.role == 0) & (depth < zone.length - zone.step)
        entering = np.flatnonzero((state.role == number + 1) & (depth >= zone.length))
        state.passed[number] += len(entering)
        state.returned += int(is_back.sum())
        state.carried += self._energy(state, entering) - self._energy(state, is_back)
        state.role[entering] = 0
        new_rows = state.position_density[entering]
        new_rows[:, zone.axis] -= zone.inward * zone.length
        take_out(state, is_back)
        self._enter(state, number, new_rows[:, :3], new_rows[:, 3])

    def _let_out(self, state: State, number: int, zone: Zone) -> None:
        """Hold fluid that enters an outflow's buffer; remove particles that passed its face."""
        points = state.position_density[: state.fluid]
        leaving = (state.role == 0) & zone.holds(points)
        state.passed[number] += int(leaving.sum())
        state.carried -= self._energy(state, leaving)
        state.role[leaving] = number + 1
        state.previous_density_rate[: state.fluid][leaving] = 0.0
        take_out(state, (state.role == number + 1) & (zone.depth(points) < 0.0))

    def _energy(self, state: State, rows: NDArray[Any]) -> float:
        """Kinetic and potential energy [J/kg] of rows, as if each had the mass 1."""
        velocity = state.velocity_pressure[: state.fluid][rows, :3]
        place = state.position_density[: state.fluid][rows, :3]
        weight = [float(g) * float(place[:, axis].sum()) for axis, g in enumerate(self._gravity)]
        return 0.5 * float((velocity * velocity).sum()) - sum(weight)

    def _follow_fluid(self, state: State) -> None:
        """Give buffers the velocity and density of the fluid before them, or those prescribed."""
        for number, zone in enumerate(self.zones):
            rows = np.flatnonzero(state.role == number + 1)
            points = state.position_density[rows, :3]
            if number < len(self.inflow) and self.inflow[number].density == "hydrostatic":
                fields = np.zeros((len(rows), 5))  # the fluid gives this buffer nothing
            else:
                fields = self._before(state, zone, points)
            has_fluid = fields[:, 4] >= NO_FLUID
            density = np.where(has_fluid, fields[:, 3], state.position_density[rows, 3])
            if number < len(self.inflow):
                density = self._inflow_density(self.inflow[number], points, density)
            else:
                self._straighten(
                    state, zone, rows, np.where(has_fluid, fields[:, zone.axis], np.nan)
                )
                outflow = self.outflow[number - len(self.inflow)]
                density = self._outflow_density(outflow, points, density)
            state.position_density[rows, 3] = density
            motion = state.velocity_pressure[rows]
            write_pressure(self.constants, state.position_density[rows], motion)
            state.velocity_pressure[rows] = motion

    def reads_to(self, zone: Zone) -> float:
        """Depth [m] behind its face to which a buffer reads the fluid."""
        return zone.length + (BEFORE + AROUND) * self.constants.smoothing.length

    def _before(self, state: State, zone: Zone, points: Array) -> Array:
        """Velocity and density of the fluid before a buffer, beside points (n, 3) m; (n, 5)."""
        h = self.constants.smoothing.length
        inside = zone.length + BEFORE * h  # m, from the face
        depth = zone.depth(state.position_density[: state.fluid])
        is_near: NDArray[np.bool_] = np.abs(depth - inside) < AROUND * h
        rows = np.flatnonzero(is_near & (state.role == 0))
        beside = points.copy()
        beside[:, zone.axis] = zone.face + zone.inward * inside
        # Layers of an inflow are behind each other: one fit serves all.
        places, place_of = np.unique(beside, axis=0, return_inverse=True)
        places = np.ascontiguousarray(places[:, np.newaxis])
        fields = np.empty((len(places), 5))
        position, velocity = state.position_density[rows], state.velocity_pressure[rows]
        near = near_rows(places, position, AROUND * h)
        fit_fields(places, *near, position, velocity, self.constants, fields)
        return fields[place_of.ravel()]

    def _straighten(self, state: State, zone: Zone, rows: Whole, speed: Array) -> None:
        """Let rows move straight out, as fast as the fluid, or, where that is nan, as they do."""
        own_speed = state.velocity_pressure[rows, zone.axis]
        outward = -zone.inward * np.where(np.isnan(speed), own_speed, speed)
        state.velocity_pressure[rows, :3] = 0.0
        state.velocity_pressure[rows, zone.axis] = -zone.inward * np.maximum(outward, 0.0)

    def _inflow_density(self, inflow: Inflow, points: Array, density: Array) -> Array:
        """Density (n,) kg/m3 of an inflow's buffer; `density` is that of the fluid."""
        if inflow.density == "extrapolated":
            return density
        top = inflow.level
        if top is None:
            assert self.params.boundary.tank is not None
            top = self.params.boundary.tank[1][2]
        return at_rest(points, top, self.params)

    def _outflow_density(self, outflow: Outflow, points: Array, density: Array) -> Array:
        """Density (n,) kg/m3 of an outflow's buffer; `density` is that of the fluid."""
        if outflow.level is not None:
            return at_rest(points, outflow.level, self.params)
        if outflow.pressure is not None:
            return under_pressure(np.full(len(points), outflow.pressure), self.params)
        return density

    def resize(self, state: State) -> None:
        """Find the particles of buffers in a state with new lists."""
        self.buffer_rows = np.flatnonzero(state.role)

    def hold(self, state: State, rates: Rates) -> None:
        """Keep the velocity and density of buffer particles: set their rates to 0."""
        rates.rate[self.buffer_rows] = 0.0
        if len(rates.xsph_velocity):
            rates.xsph_velocity[self.buffer_rows] = 0.0
        if len(state.minus_rho_div_u):
            state.minus_rho_div_u[self.buffer_rows] = 0.0

    def refuse_samples(self, points: Array) -> None:
        """Refuse samples (n, 3) m of bodies in buffers, which would pass through them."""
        for zone in self.zones:
            if (inside := zone.holds(points)).any():
                x, y, z = points[np.argmax(inside)].tolist()
                raise StepError(
                    f"bodies must stay outside of the buffer of {zone.name}, {zone.length:.4g} m "
                    f"from its face; found {int(inside.sum())} of {len(points)} surface samples "
                    f"in it, the first at ({x:.4g}, {y:.4g}, {z:.4g}) m. Move the face or the "
                    "body, or end the run earlier.",
                    (x, y, z),
                )

    def save(self) -> dict[str, Whole]:
        """Copy out which faces have buffers."""
        return numbers_of([zone.name for zone in self.zones])

    def refuse_other(self, saved: Fields) -> None:
        """Refuse a saved state with buffers at other faces."""
        refuse_other_faces(saved, [zone.name for zone in self.zones])
