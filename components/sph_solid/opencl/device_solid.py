"""Bodies of particles as a component whose steps run on an OpenCL device.

An `SphSolid` on the host makes the particles, and reads gauges, totals, views, checks and
snapshots: rows are copied into its state before. Between these, a step copies back only partial
extremes, 24 kB, and the forces on glued particles; where particles touch a partner's faces, their
places and velocities both ways.
"""

from dataclasses import replace

from quintet.components.shared.opencl.device_component import DeviceComponent
from quintet.components.shared.opencl.devices import require_doubles
from quintet.components.shared.opencl.limits import refuse_parts
from quintet.components.shared.opencl.ranks import device_and_queue
from quintet.components.sph_solid import MANIFEST
from quintet.components.sph_solid.component import LOAD, REACTION, SphSolid
from quintet.components.sph_solid.diagnostics import failure
from quintet.components.sph_solid.glue import add_work, glued_rows
from quintet.components.sph_solid.judgement import ENERGY_EVERY
from quintet.components.sph_solid.opencl.features import copies_on_device, has_device_sums
from quintet.components.sph_solid.opencl.partner_faces import kick_by_faces
from quintet.components.sph_solid.opencl.stepping import Stepping
from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.ports import SHOWS
from quintet.components.sph_solid.ranks.method import extremes
from quintet.interfaces.component import Fields, Keys, Resources

FIRST_DEVICE = Resources(device="opencl")
RANKS = ("OneRank", "SeveralRanks")  # not both are imported
FORCES = frozenset({LOAD, REACTION})  # known on the host after each step


class DeviceSolid(DeviceComponent):
    """Elastic-plastic bodies of particles, and what of them is glued to a mesh, on a device."""

    Params: type[SphSolidParams] = SphSolidParams
    manifest = MANIFEST
    shows = SHOWS
    host: SphSolid

    def __init__(self, params: SphSolidParams, resources: Resources = FIRST_DEVICE) -> None:
        device, queue = device_and_queue(resources)
        require_doubles(device, resources.device)
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.host = SphSolid(params, replace(resources, device="cpu"))
        self._refuse_other_parts(resources.device)
        host = self.host
        self.stepping = Stepping(
            queue, device.is_processor, host.law, host.materials.laws, host.lists, host.sums,
            params.gravity, copies_on_device(host.all_ranks, resources, queue),
        )  # fmt: skip
        self._put()

    def _refuse_other_parts(self, device: str) -> None:
        """Refuse parts that only a step on the processor calls."""
        host = self.host
        known = (
            (host.sums, has_device_sums(host.sums)),
            (host.all_ranks, type(host.all_ranks).__name__ in RANKS),
        )
        other_parts = [type(part).__name__ for part, is_known in known if not is_known]
        refuse_parts(other_parts, device, "bodies")

    def take(self, fields: Fields) -> None:
        """Set which particles are still glued, their velocities, and faces in the coming step."""
        state = self.host.state
        if not len(state.active):
            self.host.take(fields)
            return
        if (fields.get("glue_activity.active", state.active) < state.active).any():
            self._get()  # what is released brings its motion
        self.host.take(fields)
        self.stepping.rows.put_glue(state)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]; stresses follow the motion in the step's middle."""
        host, state, stepping = self.host, self.host.state, self.stepping
        host.all_ranks.begin_step()
        if state.steps % ENERGY_EVERY == 0:
            self._get()
            mass, gravity = host.materials.mass(state), self.params.gravity
            touching = host.faces.penalty.numbers if host.faces else None
            host.judge.note(state, mass, host.sums, gravity, host.all_ranks, touching)
        add_work(state, dt)
        if host.faces:
            kick_by_faces(host.faces, stepping.rows, state, self._is_read, dt)
        self._is_read = False
        low, high = (end[None] for end in stepping.kick(dt))
        low, high = extremes(host.all_ranks, low, high)
        if stepping.pairs.is_unstable(low, high):
            raise self._failure(dt)
        if stepping.may_miss(state, low, high, dt):
            self._search(dt)
        minus_bound, failures = host.all_ranks.greatest(stepping.finish(dt))
        state.bound = -float(minus_bound)
        if len(state.active):
            rows = glued_rows(state)
            force = stepping.rows.force.get()[state.glue[rows]]
            state.force[:] = host.all_ranks.all_rows(state.glue[rows], force)
        state.time += dt
        state.steps += 1
        add_work(state, dt)
        if failures:
            raise self._failure(dt)
        host.all_ranks.end_step()

    def _search(self, dt: float) -> None:
        """Sort particles by their places in the middle of a step of dt [s], and list neighbours."""
        rows, lists, state = self.stepping.rows, self.host.lists, self.host.state
        if rows.copies:  # hosts bring particles to their ranks
            self._read()
            if not lists.sort(state, dt):
                raise self._failure(dt)
            self.stepping.put(state)
            return
        rows.reflect(dt)
        low, high, _ = rows.extremes_of(rows.motion)
        spread = dt * lists.spread(low, high)
        if lists.is_unstable(spread) or rows.extremes_of(rows.place)[2]:
            raise self._failure(dt)
        lists.widen(state, spread)
        rows.sort(state)
        if self.host.faces:  # its rows are those of the host's state
            self._read()
            self.host.faces.make(state, self.host.materials)

    def _failure(self, dt: float) -> Exception:
        """Say which particle a step of dt [s] failed on."""
        self._get()
        return failure(self.host.state, self.params, dt, self.host.all_ranks)

    def _put(self) -> None:
        """Copy the host's state to the device."""
        self.stepping.put(self.host.state)
        self._is_read = True

    def _read(self) -> None:
        """Copy the particles into the host's state."""
        self.stepping.rows.get(self.host.state)

    def _is_finite(self) -> bool:
        """Whether energies, strains, temperatures and damages are finite."""
        return self.stepping.rows.is_finite()

    def give(self, wanted: Keys) -> Fields:
        """Copy out forces on glued particles, and readings of bodies, gauges and levels."""
        if not wanted <= FORCES:
            self._get()
        return self.host.give(wanted)
