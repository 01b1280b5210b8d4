"""Lattices of mass points with drive, damping, baths, collisions; or spheres in free flight.

    m dv/dt = Σ F(r) e + δ (v_ij·e) e + …,   F = c Π(x - x_i) e(x) STEP(x, 2s, 1, 2, 0),   x = r/a

Arinchev's macromolecules: a simple cubic lattice whose stable roots 1, √2, √3, 2 stand at the
shells of neighbours. A pair of points is driven by a told distance, others are frozen; the hotness
of a point is its kinetic energy averaged over time. Results depend on f/f_top, δ/(m ω_top), D/a and
the number of cycles only, so that the strength c and the mass are no parameters of their own.

Velocity Verlet, or Yoshida's composition of fourth order; the damping acts on the velocity at the
step's end, to second order. The driven pair's constraint is eliminated: its distance is what is
told, its mean moves by the mean force. Langevin's baths are those of BAOAB. Random collisions turn
the relative velocity of nearest points into a random direction: momentum and energy stay, and heat
is conducted by Fourier's law at any length, which the lattice alone does not do.

Spheres move under the loads of a partner, constant over a step, gravity and tethers, by the same
schemes; they turn to fourth order (Magnus's series). Impacts among them and with walls are impulses
with restitution, without friction.

Energy is audited: kinetic + potential + dissipated - work of the drive - heat of the baths.

Papers: Arinchev, Simulation of the metal bar heating process using the macromolecule approach;
Yoshida, Phys. Lett. A 150 (1990) 262; Leimkuhler & Matthews, Appl. Math. Res. Express (2013) 34
(BAOAB); Malevanets & Kapral, J. Chem. Phys. 110 (1999) 8605 (collisions that rotate velocities).
"""

from quintet.components.particle_dynamics.params import ParticleDynamicsParams
from quintet.components.particle_dynamics.plan import plan
from quintet.components.particle_dynamics.ports import SHOWS, ports
from quintet.components.particle_dynamics.start import initial
from quintet.interfaces.manifest import Manifest

__all__ = ["MANIFEST", "ParticleDynamicsParams"]

MANIFEST = Manifest(
    kind="particle_dynamics",
    title="Lattices of mass points, driven and heated; spheres in flight",
    params=ParticleDynamicsParams,
    component="quintet.components.particle_dynamics.component:ParticleDynamics",
    ports=ports,
    shows=SHOWS,
    plan=plan,
    initial=initial,
    bench="quintet.components.particle_dynamics.bench:cases",
    conform="quintet.components.particle_dynamics.conform:cases",
)
