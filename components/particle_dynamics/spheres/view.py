"""What a picture shows of spheres."""

from quintet.components.particle_dynamics.spheres.ranks.method import Ranks
from quintet.interfaces.component import Fields


def view(ranks: Ranks) -> Fields:
    """Spheres of all ranks with velocity and temperature."""
    state = ranks.state
    return {
        "points": ranks.whole(state.position),
        "radius": ranks.whole(ranks.spheres.radius),
        "velocity": ranks.whole(state.velocity),
        "temperature": ranks.whole(state.temperature),
    }
