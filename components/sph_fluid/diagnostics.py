"""Totals of the fluid, and the particle and place of a failure."""

import math

import numpy as np

from quintet.components.shared.finite_items import require_finite_items
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.mass_balance.losses import balance
from quintet.components.sph_fluid.mass_balance.sums import without_buffers
from quintet.components.sph_fluid.open_boundaries.crossings import potential_of_crossings
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.setup.tait import TAIT
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields, Totals
from quintet.interfaces.errors import SceneError, StepError
from quintet.interfaces.sums import finite

MACH = 0.5  # of the speed of sound: what strikes the fluid faster is refused
OTHERS = "a particle failed; rank 0 names it."  # message of the other ranks
MOST_LOST = 2000  # particles among which the first one is sought
FEW = 1e-3  # of the fluid: so many particles may be denser for no such reason


def totals(state: State, params: SphFluidParams, constants: Constants, ranks: Ranks) -> Totals:
    """Mass, momentum and energies of the fluid that is left on all ranks."""
    mass, rows = constants.mass * params.slab_thickness, slice(state.fluid)
    x, y, z = state.position_density[rows, :3].T
    u, v, w = state.velocity_pressure[rows, :3].T
    g = params.gravity
    # Written out: what a library makes of several columns depends on how many rows there are.
    columns = [
        *(u, v, w),
        *(y * w - z * v, z * u - x * w, x * v - y * u),
        u * u + v * v + w * w,
        x * g[0] + y * g[1] + z * g[2],
        _elastic(state.position_density[rows, 3], params, constants),
    ]
    count, columns = without_buffers(state, ranks.fluid(state), columns)
    sums = mass * ranks.sums(state, columns)
    return Totals(
        mass=mass * count,
        momentum=sums[:3],
        angular_momentum=sums[3:6],
        kinetic=0.5 * float(sums[6]),
        potential=-float(sums[7]) + potential_of_crossings(state, params, mass),
        internal=float(sums[8]),
        work=mass * state.carried,
        mass_balance={reason: mass * count for reason, count in balance(state, params).items()},
    )


def _elastic(density: Array, params: SphFluidParams, constants: Constants) -> Array:
    """∫ p/ρ² dρ from ρ₀ [J/kg]."""
    ratio = density / constants.density
    if not params.negative_pressure:
        ratio = np.maximum(ratio, 1.0)
    cube = ratio * ratio * ratio
    power = (cube * cube - 1.0) / (TAIT - 1)
    return np.asarray(constants.stiffness / constants.density * (power + 1.0 / ratio - 1.0))


def failure(state: State, params: SphFluidParams, dt: float, ranks: Ranks) -> StepError:
    """Say which particle of all ranks a step [s] failed on, and what to do; rank 0 alone knows."""
    gathered = ranks.whole(state)
    worst = 0 if ranks.rank else _worst(gathered, params.spacing, dt)
    owner = ranks.owner(state, 0 if ranks.rank else int(gathered.identity[worst]))
    if ranks.rank:
        return StepError(OTHERS)
    x, y, z, density = gathered.position_density[worst].tolist()
    if not math.isfinite(x + y + z) and len(gathered.reference) > worst:
        x, y, z = gathered.reference[worst].tolist()  # where it was in the last lists
    speed = math.hypot(*gathered.velocity_pressure[worst, :3].tolist())
    text = (
        f"step {state.steps} of {dt:.3g} s: a fluid particle must stay finite, have a positive "
        f"density and move less than a spacing ({params.spacing:.3g} m); particle "
        f"{gathered.identity[worst]}{owner} at ({x:.4g}, {y:.4g}, {z:.4g}) m has {speed:.4g} m/s "
        f"and {density:.4g} kg/m3. Lower courant (now {params.courant}), raise "
        "viscosity.artificial or sound_speed, or look for a surface that moves too fast."
    )
    return StepError(text, (x, y, z))


def check(state: State, params: SphFluidParams) -> None:
    """Refuse velocities that are not finite: the next step alone would find them."""
    rows = slice(state.fluid)
    motion = state.velocity_pressure[rows]
    if finite(motion):
        return
    fields = {"velocity": motion[:, :3], "pressure over squared density": motion[:, 3]}
    places = state.position_density[rows, :3]
    advice = f"Lower courant (now {params.courant}), or check the surfaces near it."
    require_finite_items("particle", fields, state.identity, places, advice)


def _origin(listed: Array, lost: Whole) -> int:
    """Find the particle that failed first: the other lost ones are its listed neighbours.

    Parameters
    ----------
    listed : (fluid, 3) float array, m
        Where the neighbour lists were made.
    lost : (k,) int array
        Rows of particles at no place.
    """
    if len(listed) <= lost[-1] or len(lost) > MOST_LOST:
        return int(lost[0])
    low, high = listed[lost].min(axis=0), listed[lost].max(axis=0)
    size = float(np.linalg.norm(high - low))
    near_rows = np.flatnonzero(((listed >= low - size) & (listed <= high + size)).all(axis=1))
    is_lost = np.isin(near_rows, lost)
    distances = (np.linalg.norm(listed[near_rows] - listed[row], axis=1) for row in lost)
    nearest = (np.argsort(distance, kind="stable")[: len(lost)] for distance in distances)
    return int(lost[np.argmax([int(is_lost[rows].sum()) for rows in nearest])])


def _worst(state: State, spacing: float, dt: float) -> int:
    """Row of the fluid particle at no place, or not finite, or the fastest, or the thinnest."""
    rows = slice(state.fluid)
    position, velocity = state.position_density[rows], state.velocity_pressure[rows]
    has_place = np.isfinite(position[:, :3]).all(axis=1)
    if not has_place.all():
        return _origin(state.reference[rows], np.flatnonzero(~has_place))
    finite = np.isfinite(position).all(axis=1) & np.isfinite(velocity).all(axis=1)
    if not finite.all():
        return int(np.argmin(finite))
    speed = np.linalg.norm(velocity[:, :3], axis=1)
    fast = float(speed.max()) * dt > spacing
    return int(np.argmax(speed) if fast else np.argmin(position[:, 3]))


def refuse_other_particles(saved: Fields, fluid: float, boundary: int) -> None:
    """Refuse a state of another fluid, or of other walls and surface samples.

    Particles may have left the domain since the start: those that ever were there count. `fluid`
    is infinite where more of them may come.
    """
    count, born = len(saved["identity"]), int(np.max(saved["identity"], initial=-1)) + 1
    walls = len(saved["sample"])
    if count > fluid or born > fluid:
        raise SceneError(
            f"the state that it begins from must be of a fluid with {fluid:.0f} particles or fewer "
            f"at the start; found {count} particles, of at least {born} that there were. Make "
            "fluid and spacing as they were in that run."
        )
    if walls != boundary:
        raise SceneError(
            f"the state that it begins from must be of its {boundary} wall and surface particles; "
            f"found {walls}. Make spacing, walls, obstacles, meshes and bodies as they were in "
            "that run."
        )


def refuse_other_samples(saved: Fields, samples: int) -> None:
    """Refuse a state with another number of samples of bodies and pistons."""
    count = int((saved["sample"] >= 0).sum())
    if count != samples:
        raise SceneError(
            f"the state that it begins from must have its {samples} samples of bodies and pistons; "
            f"found {count}. Have the same bodies and boundary.pistons in both scenes; a piston "
            "that stands still in the first run has a table with displacements of 0."
        )


def refuse_other_reach(saved: Fields, reach: float) -> None:
    """Refuse a state whose rows are in the order of neighbour lists with another reach [m]."""
    before = float(saved.get("reach", reach))
    if before != reach:
        raise SceneError(
            f"the state that it begins from must have neighbour lists that reach {reach:.6g} m, by "
            f"spacing, smoothing and integration; found {before:.6g} m. Take those of that run, or "
            "leave the fluid out of begin_from.components."
        )


def refuse_dense(state: State, params: SphFluidParams, ranks: Ranks) -> None:
    """Raise where the fluid was struck faster than a weakly compressible one can be.

    A surface that meets it with a velocity u raises its pressure by ρ₀c₀u, whatever moves: that of
    u = c₀/2 is a density that nothing slower reaches. Single drops of spray that walls squeeze are
    let go.
    """
    densest = params.density * (1.0 + TAIT * MACH) ** (1.0 / TAIT)
    (dense,) = ranks.count(int((state.position_density[: state.fluid, 3] > densest).sum()))
    if dense <= FEW * ranks.fluid(state):
        return
    gathered = ranks.whole(state)
    worst = 0 if ranks.rank else int(np.argmax(gathered.position_density[: gathered.fluid, 3]))
    owner = ranks.owner(state, 0 if ranks.rank else int(gathered.identity[worst]))
    if ranks.rank:
        raise StepError(OTHERS)
    raise StepError(
        f"step {state.steps}: what strikes the fluid must be slower than half its sound_speed "
        f"({MACH * params.sound_speed:.3g} m/s), a tenth to be right, so that its density stays "
        f"below {densest:.4g} kg/m3; {_met(gathered, worst, owner)} Raise sound_speed to ten times "
        "the largest velocity, or slow what moves.",
        gathered.position_density[worst, :3],
    )


def _met(state: State, worst: int, owner: str) -> str:
    x, y, z, density = state.position_density[worst].tolist()
    speed = math.hypot(*state.velocity_pressure[worst, :3].tolist())
    fastest = float(np.linalg.norm(state.velocity_pressure[:, :3], axis=1).max())
    return (
        f"particle {state.identity[worst]}{owner} at ({x:.4g}, {y:.4g}, {z:.4g}) m has "
        f"{density:.4g} kg/m3 and {speed:.3g} m/s, and the fastest of all, surfaces too, "
        f"{fastest:.3g} m/s."
    )
