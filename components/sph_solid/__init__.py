"""Elastic-plastic bodies of particles: smoothed-particle hydrodynamics of solids under shocks.

    dη/dt = -tr ηL,   ρ dv/dt = ∇·σ,   ρ de/dt = σ:D,   σ = -p I + s,   η = ρ/ρ₀

Particles move with the material; gradients are sums over neighbours with the cubic spline, if asked
for corrected to be exact for linear fields (Bonet and Lok). Stress by Jaumann's rate and the return
to the flow stress of Johnson and Cook, equation of state of Mie and Grüneisen with temperatures
from the energy on the isentrope, Monaghan's artificial viscosity; where the greatest principal
stress passes its limit a particle has failed for good: it bears neither shear nor tension.

Stretched material of particles forms clumps; if asked for an artificial stress, a share of the
tensions along principal axes, holds the nearest apart (Monaghan; Gray, Monaghan and Swift), or
pairs are those of the start, stresses nominal, and a force holds what no gradient sees
(Ganzenmüller).

Velocity Verlet; strains follow from places and velocities in the middle of the step, works from the
forces at its two ends, so that energy is kept at second order in the step and momentum to rounding.
Bodies of rings about an axis see cuts of each other, turned about it.
Bodies touch as their particles come near. Planes of symmetry mirror what is near them.

Papers: Libersky, Petschek, Carney, Hipp & Allahdadi, J. Comput. Phys. 109 (1993) 67; Monaghan, Rep.
Prog. Phys. 68 (2005) 1703; Bonet & Lok, Comput. Methods Appl. Mech. Eng. 180 (1999) 97; Gray,
Monaghan & Swift, Comput. Methods Appl. Mech. Eng. 190 (2001) 6641 (artificial stress);
Ganzenmüller, Comput. Methods Appl. Mech. Eng. 286 (2015) 87 (total Lagrangian); Dyanov,
Kazantsev & Chelakov (LOGOS), whose impacts of balls on plates it repeats.
"""

from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.plan import plan
from quintet.components.sph_solid.ports import SHOWS, ports
from quintet.interfaces.manifest import Manifest

__all__ = ["MANIFEST", "SphSolidParams"]

MANIFEST = Manifest(
    kind="sph_solid",
    title="Elastic-plastic bodies of particles",
    params=SphSolidParams,
    component="quintet.components.sph_solid.component:SphSolid",
    ports=ports,
    shows=SHOWS,
    ranks=True,
    ranks_limits="quintet.components.sph_solid.ranks.refusal:refuse_what_needs_one_rank",
    plan=plan,
    bench="quintet.components.sph_solid.bench:cases",
    conform="quintet.components.sph_solid.conform:cases",
    opencl="quintet.components.sph_solid.opencl.device_solid:DeviceSolid",
    opencl_ranks="quintet.components.sph_solid.ranks.refusal:refuse_what_needs_one_rank",
)
