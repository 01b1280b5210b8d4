"""Lattices of mass points with drive, damping, baths and collisions.

    m dv/dt = Σ F(r) e + δ (v_ij·e) e + …,   F = c Π(x - x_i) e(x) STEP(x, 2s, 1, 2, 0),   x = r/a

Arinchev's macromolecules: a simple cubic lattice whose stable roots 1, √2, √3, 2 are the distances
of the nearest four shells of neighbours. A pair of points is driven at a prescribed distance,
others are frozen; the hotness of a point is its kinetic energy averaged over time. Results depend
only on f/f_top, δ/(m ω_top), D/a and the number of cycles.

Velocity Verlet, or Yoshida's composition of fourth order; the damping acts on the velocity at the
step's end, to second order. The constraint of the driven pair is eliminated: its distance is
prescribed, and the mean force moves its mean position. Langevin baths are those of BAOAB. Random
collisions turn the relative velocity of nearest points into a random direction: they conserve
momentum and energy, and the lattice then conducts heat by Fourier's law at any length.

Energy is audited: kinetic + potential + dissipated - work of the drive - heat of the baths.

Papers: Arinchev, Simulation of the metal bar heating process using the macromolecule approach;
Yoshida, Phys. Lett. A 150 (1990) 262; Leimkuhler & Matthews, Appl. Math. Res. Express (2013) 34
(BAOAB); Malevanets & Kapral, J. Chem. Phys. 110 (1999) 8605 (collisions that rotate velocities).
"""

from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.particle_dynamics.plan import plan
from quintet.components.particle_dynamics.ports import SHOWS, ports
from quintet.interfaces.manifest import Manifest

__all__ = ["MANIFEST", "SUCCESSORS", "ParticleLatticeParams"]

MANIFEST = Manifest(
    kind="particle_lattice",
    title="Lattices of mass points, driven and heated",
    params=ParticleLatticeParams,
    component="quintet.components.particle_dynamics.component:ParticleLattice",
    ranks=True,
    ranks_limits="quintet.components.particle_dynamics.ranks.refusal:refuse_what_needs_one_rank",
    ports=ports,
    shows=SHOWS,
    plan=plan,
    bench="quintet.components.particle_dynamics.bench:cases",
    conform="quintet.components.particle_dynamics.conform:cases",
    opencl="quintet.components.particle_dynamics.component:ParticleLattice",
    opencl_limits=(
        "quintet.components.particle_dynamics.opencl.refusal:refuse_what_needs_the_processor"
    ),
    opencl_ranks="quintet.components.particle_dynamics.opencl.refusal:refuse_what_needs_one_rank",
)
SUCCESSORS = ("particle_lattice", "particle_spheres")  # of the kind particle_dynamics
