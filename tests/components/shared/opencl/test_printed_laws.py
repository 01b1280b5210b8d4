"""Laws of all solvers, printed for a device, have the bits of numba.

The exceptions call transcendental functions, which PoCL rounds differently from the C library;
`ulp` is the allowed difference.
"""

import importlib
import inspect
from functools import cache
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pyopencl")
from gas_laws import GAS_LAWS
from printed_laws import (
    ROWS,
    Between,
    Law,
    draw,
    run_by_numba,
    run_on_device,
    scale_of,
    ulps,
    vector,
)

from quintet.components.dem_bodies import laws as dem
from quintet.components.dem_bodies.kernels import ball_laws as balls
from quintet.components.dem_bodies.kernels import rolling_resistance as rolling
from quintet.components.fe_plate import laws as plate
from quintet.components.particle_dynamics import laws as lattice
from quintet.components.particle_dynamics.coefficients import PairDamping, SevenRoots
from quintet.components.particle_dynamics.kernels import generator
from quintet.components.particle_dynamics.spheres import laws as spheres
from quintet.components.particle_dynamics.state import Driven
from quintet.components.shared import elementary, rotations, smoothing
from quintet.components.shared.contact import laws as contact
from quintet.components.shared.materials import equation_of_state as state
from quintet.components.shared.materials import fracture, strength, tension
from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.refusal import PrintError
from quintet.components.shared.search.cells import Grid, cell_of, key_of
from quintet.components.shared.smoothing import cubic_spline, quintic_spline, wendland
from quintet.components.shared.smoothing import smoothing as smooth
from quintet.components.sph_fluid import laws as fluid
from quintet.components.sph_fluid.boundary.kernels import mirrored_density as mirrored
from quintet.components.sph_fluid.integration.kernels import failed
from quintet.components.sph_fluid.motion import laws as motion
from quintet.components.sph_fluid.waves import laws as waves
from quintet.components.sph_solid import laws as solid
from quintet.components.sph_solid.kernels import azimuthal_images as images
from quintet.components.sph_solid.kernels import point, sums, touching
from quintet.components.sph_solid.kernels import reference_laws as start

ANY, PART, LARGE = Between(-1.0, 1.0), Between(0.01, 1.0), Between(0.5, 2.0)
SIX, NINE, TEN = (ANY,) * 6, (ANY,) * 9, (PART,) * 10
NEAR = Between(0.0, 5e-3)  # m2
CUBIC, QUINTIC, WENDLAND = (smooth.smoothing(name, 3, 0.03) for name in smooth.KERNELS)
DENSITY = Between(900.0, 1100.0)
CONSTANTS = fluid.Constants(0.008, CUBIC, 9e-6, 1000.0, 1e6, 0.0, 0.0)
CALM = CONSTANTS._replace(smoothing=WENDLAND, lowest=-np.inf)
DIFFUSION = fluid.DensityDiffusion(True, ANY, ANY, ANY, ANY)
CONTACT = fluid.ContactPotential(True, True, PART, 1e-5, 1.0, 0.0, 1.0)
REPULSION = fluid.WallRepulsion(True, 1e3, 2e-3)
NO_DIFFUSION = fluid.DensityDiffusion(None, 0.0, 0.0, 0.0, 0.0)
LAPLACIAN, STRESS, NONE = (
    fluid.KinematicViscosity(on, stress, 1e-3)
    for on, stress in ((True, None), (True, True), (None, None))
)
TERMS = fluid.PairTerms(0.5, NONE, DIFFUSION, REPULSION._replace(on=None), CONTACT, None, None)
PAIR = (*(vector(1.0),) * 4, NEAR, ANY, ANY, ANY, PART, PART)
SOLID = solid.PairLaw(WENDLAND, 9e-6, 1.0, 2.0, 1.0, True, 0.3, 1e-5)
PLAIN = SOLID._replace(artificial=None)
METAL = Solid(
    2700.0, 27e9, 77e9, True, 2.9e7, 1.34, 0.1, 0.0, 2.0, 0.5, 3e8, 4e8, 0.34, 0.01, 1.7, 1.0,
    300.0, 600.0, 1e-7, -1e9, 0.5, 0.1, 0.2, -1.5, 0.01, 0.5, 300.0, 900.0, -1.0, 0.01, None,
)  # fmt: skip
BRITTLE = METAL._replace(shocks=False, spall=5e8, failure_strain=1.0)
PAIR_OF_SOLID = ((ANY,) * 4, vector(1.0), vector(1.0), ANY, ANY, NINE, PART, vector(1.0))
PULL = Between(-5e8, 5e8)  # Pa
POINT = point.Point(
    (PULL,) * 6, Between(0.95, 1.1), PULL, Between(0.0, 1e5), PART, Between(300.0, 800.0),
    PART, 0.0,
)  # fmt: skip
RATE = ((Between(-1e5, 1e5),) * 9, (Between(-1e5, 1e5),) * 9, Between(-1e-3, 1e-3))
STRAINED = (Between(-0.1, 0.3), Between(0.0, 1e5), Between(1e6, 1e9), METAL)
PLACES = (1.0, 1.2, 1.4, 1.6, 1.7, 2.0, 2.2)
ROOTS = SevenRoots(1.5, 10.0, PLACES, 1.0, (1.0,) * 3, 1.8, 5.0, 2.0, None, None)
HELD = Driven(0, 1, 2, ANY, ANY, LARGE, 0.5, 0.5, False, ANY, ANY)
FREE = HELD._replace(is_free=True)
COUNTERS = (1, 2**62, -(2**63))
GRID = Grid(-1.0, -1.0, -1.0, 7.3, 9, 11, 13, 1, 2, 0)
MODULUS = Between(1e9, 1e11)
SPHERE = (LARGE, LARGE, LARGE, MODULUS, MODULUS, PART, Between(1e-6, 1e-3), ANY)
TOUCHING = (
    (PART,) * 7, vector(1.0), PART, vector(1.0), PART, (PART,) * 3, PART, vector(1.0), vector(1.0),
    PART,
)  # fmt: skip

ROLLING = (
    *(vector(1.0),) * 2, PART, LARGE, PART, PART, *(vector(1.0),) * 3, PART,
)  # fmt: skip
FORCES = motion.FrameForces(1e-3, vector(9.0), (vector(9.0), vector(9.0), vector(9.0)), vector(9.0))
LAWS = [
    Law(cubic_spline.shape, (Between(0.0, 2.5),)),
    Law(cubic_spline.slope, (Between(0.0, 2.5),)),
    Law(quintic_spline.pieces, (Between(0.0, 2.5),)),
    Law(quintic_spline.shape, (Between(0.0, 2.5),)),
    Law(quintic_spline.slope, (Between(0.0, 2.5),)),
    Law(wendland.shape, (Between(0.0, 2.5),)),
    Law(wendland.slope, (Between(0.0, 2.5),)),
    Law(smooth.kernel, (NEAR, CUBIC)),
    Law(smooth.gradient, (NEAR, LARGE, WENDLAND)),
    Law(smooth.gradient, (NEAR, LARGE, CUBIC), name=" of the cubic spline"),
    Law(smooth.kernel, (NEAR, QUINTIC), name=" of the quintic spline"),
    Law(smooth.gradient, (NEAR, LARGE, QUINTIC), name=" of the quintic spline"),
    Law(smooth.with_length, (CUBIC, PART, 3)),
    Law(fluid.tait, (DENSITY, CONSTANTS)),
    Law(fluid.tait, (DENSITY, CALM), name=" below zero"),
    Law(fluid.pressure_term, (DENSITY, CALM)),
    Law(waves.damping_strength, (ANY, -1.0, 2.0, True)),
    Law(waves.damped_share, (PART, 9.0, 1e-3)),
    Law(motion.cross, (vector(9.0), vector(9.0))),
    Law(motion.later, (vector(9.0), vector(9.0), vector(9.0), PART)),
    Law(motion.frame_acceleration, (vector(9.0), vector(9.0), vector(9.0), FORCES)),
    Law(fluid.damped_pressure_term, (DENSITY, ANY, PART, CALM)),
    Law(fluid.inverses, (NEAR, DENSITY, CALM)),
    Law(fluid.pair_pressure, (ANY, ANY, PART, TERMS)),
    Law(fluid.diffusive_flux, (ANY, ANY, ANY, ANY, DIFFUSION)),
    Law(fluid.repulsion_force, (NEAR, REPULSION)),
    Law(fluid.contact_factor, (NEAR, PART, CONTACT, CUBIC)),
    Law(fluid.add_pair_force, (*PAIR, TERMS)),
    Law(fluid.add_pair_force, (*PAIR, TERMS._replace(viscosity=LAPLACIAN)), name=", Laplacian"),
    Law(
        fluid.add_pair_force, (*PAIR, TERMS._replace(viscosity=STRESS, repulsion=REPULSION)),
        name=", stress and repulsion",
    ),
    Law(mirrored.distance, (vector(1.0), ANY, ANY, ANY)),
    Law(mirrored.add_moments, (TEN, PART, ANY, ANY, ANY)),
    Law(mirrored.mean_and_variance, (TEN,)),
    Law(mirrored.solve, (SIX, ANY, ANY, ANY)),
    Law(failed, (Between(-1.0, 1000.0), PART, PART)),
    Law(cell_of, (Between(-1.5, 0.5), Between(-1.5, 0.5), Between(-1.5, 1.0), GRID)),
    Law(solid.inverses, (NEAR, DENSITY, SOLID)),
    Law(solid.viscous_pressure, (PART, DENSITY, PART, DENSITY, SOLID)),
    Law(solid.nearness, (NEAR, SOLID)),
    Law(solid.repelled, (SIX, vector(1.0), NEAR, SOLID)),
    Law(solid.inverse, (SIX, SOLID)),
    Law(solid.add_outer, (NINE, vector(1.0), vector(1.0))),
    Law(solid.add_moments, (SIX, vector(1.0), vector(1.0))),
    Law(solid.add_force, (*PAIR_OF_SOLID, SOLID)),
    Law(solid.add_force, (*PAIR_OF_SOLID, PLAIN), name=" of stresses alone"),
    Law(solid.stable_step, (LARGE, PART, SOLID)),
    Law(sums.corrected, (NINE, SIX, True, SOLID)),
    Law(point.rates, (NINE, (LARGE, LARGE), ANY, PART)),
    Law(point.corrected_scales, (PART, ANY, PART)),
    Law(point.plain_scales, (LARGE, ANY, PART)),
    Law(point.advanced, (POINT, RATE, LARGE, 1e-8, METAL)),
    Law(point.advanced, (POINT, RATE, LARGE, 1e-8, BRITTLE), ulp=4, name=" that is brittle"),
    Law(point.sound_speed, (POINT, METAL)),
    Law(point.divided_stress, (SIX, ANY, PART)),
    Law(point.corrected_stress, (SIX, PART, SIX)),
    Law(point.artificial_stress, (SIX, 0.3)),
    Law(tension.rotation, (ANY,) * 5),
    Law(tension.rotation, (ANY, ANY, 0.0, ANY, ANY), name=" of a diagonal matrix"),
    Law(tension.rotated_pair, (vector(1.0), vector(1.0), ANY, ANY)),
    Law(tension.positive_part, (SIX,)),
    Law(images.turns_of_pair, (7, True, 40)),
    Law(images.turned_square, (PART, PART, PART, ANY)),
    Law(images.turned_vector, (ANY, ANY, ANY, ANY)),
    Law(images.turned_six, SIX),
    Law(images.turned_nine, (ANY,) * 7),
    Law(solid.times, (NINE, SIX)),
    Law(start.product, (NINE, NINE)),
    Law(start.inverse_of, (NINE,)),
    Law(start.transposed, (NINE,)),
    Law(start.deformation, (NINE, SIX, SOLID)),
    Law(start.rate_of_deformation, (NINE, SIX, NINE)),
    Law(start.nominal_stress, (SIX, PART, NINE, SIX)),
    Law(start.along, (NINE, vector(1.0))),
    Law(start.approach, (ANY, PART, SOLID)),
    Law(start.push_less_drag, (NEAR, NEAR, *(PART,) * 5, 1.0, SOLID)),
    Law(touching.is_touching, (NEAR, 0.05)),
    Law(touching.stiffness, (DENSITY, LARGE)),
    Law(touching.contact_force, (vector(1.0), PART, PART, PART, LARGE)),
    Law(touching.plane_force, (ANY, PART, PART)),
    Law(state.reference_pressure, (STRAINED[0], METAL)),
    Law(state.fractions, (STRAINED[0], METAL)),
    Law(state.pressure_and_energy, (STRAINED[0], STRAINED[1], Between(-1e-5, 1e-5), METAL)),
    Law(state.sound_speed_squared, STRAINED),
    Law(state.place_in_table, (STRAINED[0], 513, METAL)),
    Law(state.temperature_between, (*STRAINED[:2], PART, (ANY, ANY), (ANY, ANY), METAL)),
    Law(strength.turned_and_strained, (SIX, NINE, LARGE, PART)),
    Law(strength.equivalent, (SIX,)),
    Law(strength.softening, (Between(200.0, 1000.0), METAL)),
    Law(strength.flow_stress, (PART, Between(0.1, 1e4, True), PART, METAL)),
    Law(strength.returned, ((PULL,) * 6, PART, Between(200.0, 800.0), 1e-6, METAL)),
    Law(fracture.greatest_principal, (SIX, ANY), ulp=2, cancels=True),
    Law(fracture.is_torn, (SIX, ANY, PART)),
    Law(fracture.damage_growth, (SIX, ANY, PART, Between(200.0, 800.0), PART, METAL), ulp=4),
    Law(plate.to_middle, (NINE, PART)),
    Law(plate.strain_rate, (NINE,)),
    Law(plate.deviatoric_power, (SIX, SIX, NINE)),
    Law(plate.damping_power, (NINE, METAL)),
    Law(elementary.logarithm, (Between(1e-9, 1e9, True),)),
    Law(elementary.exponential, (Between(-100.0, 100.0),)),
    Law(elementary.logarithm_of_few_digits, (Between(1e-9, 1e9, True),)),
    Law(elementary.exponential_of_few_digits, (Between(-100.0, 100.0),)),
    Law(elementary.power, (LARGE, ANY)),
    Law(rotations.product, ((ANY,) * 4, (ANY,) * 4)),
    Law(rotations.exponential, vector(2.0), ulp=3),
    Law(rotations.exponential, vector(3e-4), name=" of a small turn"),
    Law(rotations.rotated, ((ANY,) * 4, ANY, ANY, ANY), ulp=11, cancels=True),
    Law(rotations.matrix, ((ANY,) * 4,)),
    Law(rotations.to_world, (NINE, ANY, ANY, ANY)),
    Law(rotations.to_body, (NINE, ANY, ANY, ANY)),
    Law(rotations.cross, (vector(1.0), vector(1.0))),
    Law(rotations.scaled, (ANY, vector(1.0))),
    Law(dem.pair_constants, (LARGE,) * 6),
    Law(dem.first_step_weight, (PART,), ulp=2),
    Law(dem.rotate_tangential_force, (vector(1.0), vector(1.0), PART)),
    Law(dem.limit_friction, (vector(1.0), vector(1.0), PART, PART)),
    Law(dem.damping_weight, (0.0, PART, LARGE, LARGE), ulp=2),
    Law(dem.contact_force, TOUCHING),
    Law(dem.limit_rolling, (vector(1.0), vector(1.0), PART)),
    Law(balls.half_kick, (*(vector(1.0),) * 3, PART, PART, PART, *(vector(1.0),) * 4)),
    Law(
        balls.drifted, (vector(1.0), (ANY,) * 4, *(vector(1.0),) * 4, 0.01), ulp=11, cancels=True
    ),
    Law(balls.from_plane, (vector(1.0), PART, vector(1.0), ANY)),
    Law(balls.velocity_at_contact, (*(vector(1.0),) * 4, PART, PART)),
    Law(balls.kinematics, (vector(1.0), LARGE, PART, *(vector(1.0),) * 6)),
    Law(balls.relative_depth, (ANY, PART, PART)),
    Law(balls.relative_depth, (ANY, PART, 0.0), name=" on a plane"),
    Law(rolling.resistance, ROLLING),
    Law(rolling.inverse_surface_inertia, (LARGE,) * 3),
    Law(rolling.in_contact_plane, (vector(1.0), vector(1.0))),
    Law(key_of, (ANY, ANY, ANY, 0.03)),
    Law(contact.layer_law, (PART,) * 5),
    Law(contact.sphere_law, SPHERE, ulp=3),
    Law(contact.in_series, (PART, PART)),
    Law(contact.hertz_stiffness, (PART, PART, PART)),
    Law(contact.deepest_overlap, (PART,) * 5, ulp=1),
    Law(lattice.falling_step, (Between(-0.5, 1.5),)),
    Law(lattice.force_of_roots, (ROOTS, Between(0.005, 0.06))),
    Law(lattice.weight_of_damping, (PairDamping(2.0, 10.0, 1.0, 3.0), PART)),
    Law(lattice.damping_over_distance, (LARGE, ANY, PART)),
    Law(lattice.nearest_image, (Between(-3.0, 3.0), 1.7, 1.0 / 1.7)),
    Law(lattice.tether_force, (LARGE, ANY, ANY)),
    Law(lattice.prescribed_motion, (FREE, Between(0.0, 9.0)), ulp=1, cancels=True),
    *(Law(lattice.driven_places, (pair, ANY, ANY, ANY), name=f" {k}")
      for k, pair in enumerate((HELD, FREE))),
    *(Law(lattice.driven_rates, (pair, ANY, ANY, ANY), name=f" {k}")
      for k, pair in enumerate((HELD, FREE))),
    Law(lattice.bath_factors, (LARGE, LARGE, LARGE, LARGE, PART), ulp=3, cancels=True),
    Law(lattice.heat_gained, (LARGE, ANY, ANY)),
    Law(lattice.half_turn, (vector(1.0), vector(1.0))),
    *(Law(generator.counter_after, (counter, 7), name=f" {counter}") for counter in COUNTERS),
    *(Law(generator.uniform_of, (counter,), name=f" {counter}") for counter in COUNTERS),
    Law(generator.normal_of, (PART, PART), ulp=2, cancels=True),
    Law(generator.direction_of, (PART, PART), ulp=1, cancels=True),
    Law(spheres.unit, (vector(1.0), LARGE)),
    Law(spheres.past, (vector(1.0), vector(1.0), vector(1.0), PART)),
    Law(spheres.time_since_contact, (vector(0.5), vector(1.0), vector(0.1), Between(1.0, 2.0))),
    Law(spheres.impact_of_spheres, (vector(0.5), vector(1.0), vector(0.1), LARGE, PART, PART)),
    Law(spheres.impact_on_wall, (PART, LARGE, ANY, LARGE, PART, PART)),
    *GAS_LAWS,
]  # fmt: skip
MODULES = {inspect.getmodule(getattr(law.function, "py_func", law.function)) for law in LAWS}
SMOOTHING = {
    importlib.import_module(f"{smoothing.__name__}.{path.stem}")
    for path in Path(next(iter(smoothing.__path__))).glob("[!_]*.py")
}
LAW_FILES = SMOOTHING | {module for module in MODULES if module.__name__.split(".")[-1] == "laws"}
# Laws that cannot be printed, as they read or write arrays, or choose a law by its type.
NOT_PURE = {
    "change_stiffness", "friction", "force_over_distance", "pair_energy", "force", "energy",
    # Called once, on the host.
    "normalisation", "smoothing",
}  # fmt: skip


# Solvers that compute on devices today; the laws of others are tried before a release.
ON_DEVICES = (
    "sph_fluid", "sph_solid", "meshless_gas", "particle_dynamics", "dem_bodies",
    "shared.smoothing", "shared.search", "shared.materials",
)  # fmt: skip


def solver(law):
    """Return the folder whose laws are tried together."""
    parts = law.name.split(".")
    return ".".join(parts[:2]) if parts[0] == "shared" else parts[0]


@cache
def results(folder):
    """Largest differences of the laws of a folder, by name; all results must be finite."""
    laws, random = [law for law in LAWS if solver(law) == folder], np.random.default_rng(11)
    rows = [
        [tuple(draw(argument, random) for argument in law.arguments) for _ in range(ROWS)]
        for law in laws
    ]
    differences = {}
    for law, arguments, printed in zip(laws, rows, run_on_device(laws, rows), strict=True):
        of_processor = run_by_numba(law, arguments)
        assert of_processor.shape == printed.shape and np.isfinite(of_processor).all(), law.name
        scale = scale_of(law, arguments, of_processor)
        differences[law.name] = ulps(of_processor, printed, scale)
    return differences


def case_of(law):
    is_used = law.name.startswith(ON_DEVICES)
    return pytest.param(law, id=law.name, marks=[] if is_used else pytest.mark.full)


@pytest.mark.parametrize("law", [case_of(law) for law in LAWS])
def test_printed_laws_have_the_bits_of_numba(law):
    assert results(solver(law))[law.name] <= law.ulp


def test_every_law_is_tried_or_is_not_pure():
    tried_laws = {getattr(law.function, "py_func", law.function) for law in LAWS}
    for module in LAW_FILES:
        for name, law in vars(module).items():
            python = getattr(law, "py_func", law)
            if inspect.isfunction(python) and python.__module__ == module.__name__:
                assert python in tried_laws or name in NOT_PURE or name.startswith("_"), name


@pytest.mark.parametrize("name", ["change_stiffness", "friction"])
def test_a_law_that_changes_arrays_is_refused(name):
    law = getattr(importlib.import_module("quintet.components.shared.contact.laws"), name)
    parameters = inspect.signature(law.py_func).parameters
    with pytest.raises(PrintError, match=r"no tuple|index that varies|in the kernel"):
        Program().add(law, *(0.0 for _ in parameters))
