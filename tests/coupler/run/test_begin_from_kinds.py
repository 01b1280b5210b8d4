"""Components of every kind that begin from another run's state go on with the same bits.

Fluids and bodies do so in test_begin_from.py.
"""

import pytest
from stages import is_the_end_of, two_stages

STEADY = "components.bar.pressures.0.pulse=false"
# Scene, preset, half of a short run [s], and settings. In a second run the times of pressures and
# the factors of heat links begin again: here neither changes.
SCENES = {
    "particles of a solid": ("rubber_rings", "quick", 1e-4),
    "lattice": ("lattice_in_motion", None, 0.2),
    "spheres": ("newtons_cradle", "quick", 0.02),
    "gas": ("shock_tube", "quick", 0.01),
    "elements": ("plate_modes", "quick", 2e-4),
    "heat in elements": ("heated_slab", None, 0.25),
    "lattice and elements": ("hot_bar_coupled", "quick", 40.0, "links.0.relaxation=0.5"),
    "gas and spheres": ("dusty_shock", "quick", 2.0**-13),
    "solid and elements, glued": ("glued_bar", None, 2.0**-20, STEADY),
    "bodies and elements in contact": ("sphere_on_plate", None, 2.0**-18),
}
ALONE = list(SCENES)[:6]
COUPLED = [pytest.param(name, marks=pytest.mark.full) for name in list(SCENES)[6:]]
ZENOH = pytest.param("zenoh", marks=pytest.mark.zenoh)
MPI = pytest.param("mpi", marks=pytest.mark.mpi)


@pytest.mark.parametrize("name", ALONE + COUPLED)
def test_components_go_on_with_the_same_bits(tmp_path, name):
    scene, preset, half, *settings = SCENES[name]
    whole, continued = two_stages(scene, tmp_path, half, *settings, preset=preset)
    assert is_the_end_of(continued, whole)


@pytest.mark.full
@pytest.mark.parametrize("transport", [ZENOH, MPI])
@pytest.mark.parametrize("name", SCENES)
def test_components_go_on_with_the_same_bits_in_processes(tmp_path, name, transport):
    scene, preset, half, *settings = SCENES[name]
    whole, continued = two_stages(
        scene, tmp_path, half, *settings, transport=transport, preset=preset
    )
    assert is_the_end_of(continued, whole)
