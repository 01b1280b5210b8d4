"""What spheres take and give: loads and heat; motion, and particles for a gas."""

from dataclasses import replace

from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import HEAT, LOAD, MOTION, PARTICLES, RADIUS, TEMPERATURE, VELOCITY

ROUND_BODIES = replace(MOTION, static=(*MOTION.static, RADIUS))
SPHERES = replace(PARTICLES, name="spheres")
SHOWS = (VELOCITY, TEMPERATURE)  # of the view, at points


def ports(params: ParticleSpheresParams) -> Ports:
    """Ports taken and given."""
    return (LOAD, HEAT), (ROUND_BODIES, SPHERES)
