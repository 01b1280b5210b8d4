"""What a picture shows of spheres."""

from quintet.components.particle_dynamics.spheres.state import Spheres, State
from quintet.interfaces.component import Fields


def view(spheres: Spheres, state: State) -> Fields:
    """Spheres with velocity and temperature."""
    return {
        "points": state.position.copy(),
        "radius": spheres.radius.copy(),
        "velocity": state.velocity.copy(),
        "temperature": state.temperature.copy(),
    }
