"""Weakly compressible smoothed-particle hydrodynamics, with walls of particles.

    dρ_i/dt = Σ_j m_j u_ij·∇_iW_ij                                       continuity
    du_i/dt = -Σ_j m_j (p_i/ρ_i² + p_j/ρ_j² + Π_ij) ∇_iW_ij + g          momentum
    Π_ij    = -α c₀ μ_ij/ρ̄_ij where μ_ij = h u_ij·r_ij/(r²+0.01h²) < 0   artificial viscosity
    p       = (c₀²ρ₀/γ)[(ρ/ρ₀)^γ - 1], γ = 7                             Tait
    dr_i/dt = u_i + ε Σ_j (m_j/ρ̄_ij)(u_j - u_i) W_ij                     XSPH

Walls and moving surface samples are particles that obey the continuity equation (from fluid
neighbours alone) and Tait's, but move as they are told; their density never falls below ρ₀, so that
they never pull. With `boundary.method` "mdbc" their density is the fluid's, mirrored
(`boundary/mirrored.py`); with "potential" they have no pressure, and a contact potential stands for
it (`boundary/contact_potential.py`), as it may for single links of a fluid with mirrored walls
(`ports.py`).

Kinematic viscosity acts as a Laplacian (Lo & Shao 2002), close beside walls, or with
`viscosity.form` "stress" along the line between particles (Monaghan & Gingold 1983), without which
a free surface is not free of stress (Colagrossi et al. 2011); in shear on a lattice it is 6 % low.
At mirrored walls the fluid comes to rest: viscosity sees its velocity there mirrored too.
`wall_velocity` moves a face in its own plane. Along axes on which the tank is open below nothing
bears the fluid: it starts without weight.

Pressure below zero is cut unless `negative_pressure` is on, which thin fast layers need to hold
together; `density_diffusion` levels the density between particles (Fourtakas et al. 2019), `kernel`
"wendland" keeps still water calm, `lubrication_films` are in gaps narrower than 1.25 spacings, and
press what particles leave of their faces (`boundary/lubrication.py`), an
`acoustic_damper` takes the ringing out of strikes (`pairs/acoustic_damper.py`). Of what is off,
nothing is compiled.

Samples have the mass of fluid that their volume would hold, so that a body displaces its own volume
whether or not the spacing divides it.

In time, a particle's momentum changes in a step by exactly dt times the force of that step, uⁿ⁺¹ =
uⁿ + dt aⁿ, so that no link loses any. The density advances with its rate at a time past the step's
end, extrapolated from the last two: with one pass over pairs a step, sound waves are then damped,
not amplified (`integration/extrapolated.py`).

With `integration` "symplectic" there are two passes a step, of second order; rest stays stable up
to a `courant` of 1.3 to 1.6 instead of 0.57 to 0.60, by kernel, dimensions and viscosity
(`analysis/lattice_limit.py`).

What strikes the fluid faster than half the speed of sound, so that its density rises by a quarter,
is an error: a weakly compressible fluid allows a tenth (Monaghan 1994).

A particle that goes further than half of the tank's longest edge beyond the walls is lost and
removed; without walls none is. The mass balance of `totals` has its mass under the face of the tank
through which it went: a wall, or an open face (`mass_balance/losses.py`). Where more of the
fluid is lost than `lost_limit`, the run ends and names the place.

Particles of fluid weigh together what its boxes and `shapes` hold, whether or not the spacing
divides these (`setup/mass.py`). Fluid starts at rest under hydrostatic pressure, or as `initial`
says (`setup/initial.py`). Fluid that joined bodies stand in is removed with
`remove_inside_bodies`, and refused without.

`obstacles` are boxes of wall particles that stand still in the tank; a `wave` sets level water into
the motion of a standing wave at the start. `staggered` rows of the lattice that fluid begins with
are moved against each other along x, so that they do not strike a face as one (`build.py`).

With `boundary.motion` the tank moves with all that stands in it, by a table or harmonically; the
fluid is computed in its frame, with gravity turned and the forces of inertia
(`motion/moving_frame.py`). `boundary.pistons` are parts of it that move by themselves
(`boundary/pistons.py`). With `waves` such a part is a paddle that makes waves, by theory of first
or second order (`setup/wave_theory.py`), and may absorb those that come back
(`waves/absorption.py`);
`boundary.damping` has zones in which waves end (`waves/damping.py`).

A face of the tank named in `boundary.symmetry` has no walls and is a plane of symmetry: what is
near it acts from behind it too, mirrored, so that half of a symmetric flow moves as the whole does.
Nothing rubs there, nothing passes, and the plane takes the momentum across it
(`boundary/symmetry.py`). Surfaces stay before it, gravity lies in it, and films in narrow gaps do
not know it.

Along an axis in `boundary.periodic` the tank repeats: particles near one face act from behind the
opposite one too, and fluid that leaves there enters here (`open_boundaries/periodic.py`). Gravity
along x or y then drives the flow.

Fluid enters by faces in `boundary.inflow`, with a profile of speeds, and leaves by those in
`boundary.outflow`; both have buffers of particles (Tafuni et al. 2018) that are no part of the
fluid (`open_boundaries/flow.py`).

Gauges (`pressure_gauges`, `level_gauges`, `velocity_gauges`, `discharge_gauges`, `front_gauge`,
`motion_gauge`, `mass_gauge`) give what a scene compares with a reference, each in a port of its
own; see `gauges/gauges.py` and `gauges/flow.py` for what they read.

Papers: Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543; Monaghan, J. Comput. Phys. 82
(1989) 1 (XSPH) and 110 (1994) 399 (Tait); Monaghan & Kos, J. Waterway Port Coast. Ocean Eng. 125
(1999) 145 (time step); Panizzo, PhD thesis, L'Aquila (2004) (Shepard filter); Crespo,
Gómez-Gesteira & Dalrymple, CMC 5 (2007) 173 (walls); Lo & Shao, Appl. Ocean Res. 24 (2002) 275;
Monaghan & Gingold, J. Comput. Phys. 52 (1983) 374; Colagrossi et al., Phys. Rev. E 84 (2011)
026705; Tafuni, Domínguez, Vacondio & Crespo, Comput. Methods Appl. Mech. Eng. 342 (2018) 604.
"""

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.plan import plan
from quintet.components.sph_fluid.ports import SHOWS, ports, requests, still_water
from quintet.interfaces.manifest import Manifest

__all__ = ["MANIFEST", "SphFluidParams"]


MANIFEST = Manifest(
    kind="sph_fluid",
    title="Weakly compressible SPH fluid",
    params=SphFluidParams,
    component="quintet.components.sph_fluid.component:SphFluid",
    ports=ports,
    plan=plan,
    initial=requests,
    surroundings=still_water,
    bench="quintet.components.sph_fluid.bench:cases",
    conform="quintet.components.sph_fluid.conform:cases",
    shows=SHOWS,
    ranks=True,
    ranks_limits="quintet.components.sph_fluid.ranks.refusal:refuse_what_needs_one_rank",
    opencl="quintet.components.sph_fluid.opencl.device_fluid:DeviceFluid",
    opencl_ranks="quintet.components.sph_fluid.ranks.refusal:refuse_what_needs_one_rank",
)
