"""The fluid as a component whose steps run on an OpenCL device.

An `SphFluid` on the host makes the particles, and reads gauges, totals, views, checks and
snapshots: rows are copied into its state before. Between these a step brings back four numbers;
with bodies the forces on their samples too, with damping zones and moving tanks a number per
particle. With inflows and outflows each sort brings back a byte per particle, and the rows of
buffers and beside them.

Samples of bodies are placed in the host's state and copied to the device. Where there are samples,
the host's rows of the boundary have the order of the device's.

On several ranks each has a device, or a share of one, with the rows of its part and copies of those
that are near. Then, and with planes of symmetry or periods, rows are sorted on the host.
"""

from dataclasses import replace
from functools import partial

import numpy as np

from quintet.components.shared.opencl.device_component import DeviceComponent
from quintet.components.shared.opencl.devices import require_doubles
from quintet.components.shared.opencl.ranks import device_and_queue
from quintet.components.shared.search.verlet_list import longest
from quintet.components.sph_fluid import MANIFEST, diagnostics, judgement
from quintet.components.sph_fluid.boundary.method import NoFilms
from quintet.components.sph_fluid.component import LOADS, SphFluid
from quintet.components.sph_fluid.mass_balance.losses import refuse_many_lost
from quintet.components.sph_fluid.opencl.copies import copies_on_device
from quintet.components.sph_fluid.opencl.stepping import Extremes, Stepping
from quintet.components.sph_fluid.pairs.interaction import relative_volume
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ports import SHOWS
from quintet.components.sph_fluid.setup.tait import TAIT
from quintet.interfaces.component import Fields, Keys, Resources, Totals

FIRST_DEVICE = Resources(device="opencl")


class DeviceFluid(DeviceComponent):
    """A weakly compressible fluid in a tank, and the surfaces that move in it, on a device."""

    Params: type[SphFluidParams] = SphFluidParams

    manifest = MANIFEST
    shows = SHOWS
    host: SphFluid

    def __init__(self, params: SphFluidParams, resources: Resources = FIRST_DEVICE) -> None:
        device, queue = device_and_queue(resources)
        require_doubles(device, resources.device)
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.host = SphFluid(params, replace(resources, device="cpu"))
        self.walls_move, self.items_vary = self.host.walls_move, self.host.items_vary
        repeats = bool(params.boundary.periodic)
        copies = copies_on_device(self.host.symmetry, resources.communicator, repeats)
        parts = (self.host.frame, self.host.damping, copies, self.host.open_boundaries)
        reach = self.host.lists.reach
        self.stepping = Stepping(params, queue, device.is_processor, reach, *parts)
        self._speed = 0.0  # m/s, of the fastest fluid, where the scheme looks ahead by it
        self.host.make_film_rows = self.stepping.make_film_rows
        self._put()

    def bind(self, static: Fields, joined: Keys) -> None:
        """Make room for the samples of the surfaces joined."""
        self.host.bind(static, joined)
        self._put()

    def prime(self, fields: Fields) -> None:
        """Refuse bodies that begin out of place; remove fluid inside them, where a scene asks."""
        if self.host.pistons.links:
            super().prime(fields)

    def take(self, fields: Fields) -> None:
        """Put the surface samples where they are in the coming step."""
        if self.host.pistons.links:
            self.host.take(fields)
            self.stepping.rows.place(self.host.state, self.host.samples.row)

    def step(self, dt: float) -> None:
        """Advance by dt [s]."""
        host = self.host
        host.samples.require_placed()
        host.all_ranks.begin_step()
        if self.walls_move:
            self._place_pistons(dt)
        if host.lists.need_rebuild(host.state, host.boundary, dt, self._speed):
            self._sort()
        state = host.state
        if self.stepping.filter and host.filter and host.filter.is_due(state):
            self.stepping.filter.apply()
            self._is_read = False
        if state.steps % judgement.EVERY == 0:
            isolated = not len(host.samples.volume) and self.params.boundary.is_still
            judgement.note(state, self.params, self.totals(), isolated, host.all_ranks)
        extremes = self.stepping.step(state, dt, partial(self._apply_forces, dt))
        extremes = Extremes(*host.all_ranks.greatest(*extremes))
        self._is_read = False
        if extremes.failures:
            self._get()
            raise diagnostics.failure(state, self.params, dt, host.all_ranks)
        self.stepping.rows.reflect_crossed()
        state.moved = extremes.moved
        state.largest_acceleration, state.largest_approach = extremes[:2]
        state.last_dt, state.steps = dt, state.steps + 1
        self._speed = self.stepping.damp(state, dt, extremes.speed)
        host.frame.advance(dt)
        host.pistons.advance(state, dt)
        host.all_ranks.end_step()

    def _place_pistons(self, dt: float) -> None:
        """Place pistons at the middle of a step; those that absorb waves read the fluid first."""
        if any(piston.absorbs for piston in self.params.boundary.pistons):
            self._get()
        self.host.pistons.place(self.host.state, self.host.boundary, dt)
        self.stepping.rows.place(self.host.state, self.host.samples.row)

    def _apply_forces(self, dt: float) -> None:
        """Push the samples as they pushed the fluid; move the fluid with its neighbours (XSPH)."""
        host = self.host
        if len(host.samples.volume):
            host.state.force[host.samples.number] = self.stepping.passes.push_samples()
            host.all_ranks.gather_forces(host.state, host.samples.number)
            host.films.advance(host.state, host.lists.arrays, dt)
        self.stepping.passes.read_power()
        host.frame.count_work(host.state, dt)
        self.stepping.passes.move_with_neighbours(dt)

    def _sort(self) -> None:
        """Bring near rows together and list neighbours.

        It is done on the host where there are several ranks, planes of symmetry or periods, and
        where fluid left the tank.
        """
        rows, state = self.stepping.rows, self.host.state
        if rows.copies.are_there:
            self._sort_on_host()
            return
        if self.stepping.renew(state):
            self._is_read = False
        low, high, densest, is_outside = rows.survey()
        densest_allowed = self.params.density * (1.0 + TAIT * diagnostics.MACH) ** (1.0 / TAIT)
        if is_outside or densest > densest_allowed:
            self._sort_on_host()
        else:
            rows.sort(low, high, state)
            self.stepping.passes.centre(low, high)
            self._is_read = False
            self._follow_lists()

    def _sort_on_host(self) -> None:
        """Sort on the host, which drops fluid that left the tank and brings rows to their ranks.

        Particles that were added or removed on the device are not changed again.
        """
        self._get()
        state = self.host.state
        diagnostics.refuse_dense(state, self.params, self.host.all_ranks)
        self.host.symmetry.wrap(state)
        self.host.open_boundaries.renew(state)
        self.host.lists.sort(state)
        refuse_many_lost(state, self.params)
        self._put()

    def _follow_lists(self) -> None:
        """Let the host and the passes over pairs follow new lists, if the state has lists."""
        host, rows, self._is_listed = self.host, self.stepping.rows, False
        host.samples.find_rows(host.state)
        if not len(host.state.reference):
            return  # without lists there are no copies and images
        volume = relative_volume(host.samples, host.state, self.params)
        if len(volume):
            host.symmetry.write_values(volume, host.state.particles)
        host.boundary.resize(host.state, host.symmetry)
        self.stepping.passes.follow(volume, host.boundary)
        if not isinstance(host.films, NoFilms):
            host.samples.listed = rows.listed(host.samples.row)
            host.films.resize(host.state, rows.lengths())

    def _put(self) -> None:
        """Copy the host's state to the device."""
        host, rows, state = self.host, self.stepping.rows, self.host.state
        rows.by_potential = host.boundary.by_potential
        rows.put(state, rows.copies.around(state, rows.reach, host.boundary))
        self.stepping.passes.resize()
        if len(state.reference):
            points = state.reference[: state.fluid]
            corners = host.all_ranks.greatest(*-points.min(axis=0), *points.max(axis=0))
            self.stepping.passes.centre(-np.array(corners[:3]), np.array(corners[3:]))
        self._is_read, self._speed = True, longest(state.velocity_pressure[: state.fluid])
        self._follow_lists()

    def _read(self) -> None:
        """Copy the rows into the host's state."""
        self.stepping.rows.get(self.host.state)

    def _is_finite(self) -> bool:
        """Whether velocities are finite."""
        return self.stepping.rows.is_finite()

    def _list_on_host(self) -> None:
        """List what is near, for gauges and energies, from where the rows were last sorted."""
        host = self.host
        if len(host.state.reference):
            host.lists.make(host.state, host.boundary, host.symmetry, host.team)
        self._is_listed = True

    def totals(self) -> Totals:
        """Mass, momentum and energies; that of a contact potential is summed over lists."""
        self._get()
        if self.host.boundary.contact.on and not self._is_listed:
            self._list_on_host()
        return self.host.totals()

    def give(self, wanted: Keys) -> Fields:
        """Copy out the mean force of the last step on each sample, and what gauges read now."""
        if not wanted <= LOADS:
            self._get()
            if not self._is_listed:
                self._list_on_host()
        return self.host.give(wanted)
