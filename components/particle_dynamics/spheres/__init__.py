"""Spheres in free flight: loads of a partner, gravity, tethers, impacts.

The loads of a partner are constant over a step. Spheres move by velocity Verlet or Yoshida's scheme
and rotate to fourth order (Magnus series). Impacts among spheres and with walls are impulses with
restitution, without friction.

Papers: Yoshida, Phys. Lett. A 150 (1990) 262; Iserles et al., Acta Numer. 9 (2000) 215 (Magnus).
"""

from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams
from quintet.components.particle_dynamics.spheres.plan import plan
from quintet.components.particle_dynamics.spheres.ports import SHOWS, ports
from quintet.components.particle_dynamics.spheres.start import initial
from quintet.interfaces.manifest import Manifest

__all__ = ["MANIFEST", "ParticleSpheresParams"]

MANIFEST = Manifest(
    kind="particle_spheres",
    title="Spheres in free flight, which bounce from each other and from walls",
    params=ParticleSpheresParams,
    component="quintet.components.particle_dynamics.spheres.component:ParticleSpheres",
    ports=ports,
    shows=SHOWS,
    plan=plan,
    initial=initial,
    bench="quintet.components.particle_dynamics.spheres.bench:cases",
    ranks=True,
    conform="quintet.components.particle_dynamics.spheres.conform:cases",
)
