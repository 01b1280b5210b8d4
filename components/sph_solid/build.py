"""Bodies as their parameters describe them: particles at rest in themselves."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.geometry.selections import ByBox, in_box
from quintet.components.shared.materials.params import Material, material
from quintet.components.shared.materials.solid import Solid, solid
from quintet.components.shared.search.nearest import nearest_rows
from quintet.components.shared.smoothing.smoothing import kernel, smoothing
from quintet.components.sph_solid.filling import filling, starting_velocity
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.method import method
from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.state import Array, State, Whole
from quintet.interfaces.errors import SceneError

Mask = NDArray[np.bool_]


def materials(params: SphSolidParams) -> tuple[list[Solid], list[int]]:
    """Laws of the materials, each once, and which one each body has."""
    distinct: list[Material] = []
    numbers = []
    for body in params.bodies:
        law = material(body.material)
        if law not in distinct:
            distinct.append(law)
        numbers.append(distinct.index(law))
    return [solid(law) for law in distinct], numbers


def pair_law(params: SphSolidParams) -> PairLaw:
    """Numbers of pairs."""
    is_plane = params.dimensions == 2 and not params.axisymmetric
    settings = method(params)
    smooth = smoothing("cubic", 2 if is_plane else 3, params.length)
    return PairLaw(
        smoothing=smooth,
        softening=0.01 * params.length**2,
        linear=settings.linear,
        quadratic=settings.quadratic,
        plane=1.0 if is_plane else 0.0,
        corrected=True if settings.kernel_correction else None,
        artificial=params.artificial_stress or None,
        per_spacing=1.0 / kernel(params.spacing**2, smooth),
    )


def initial_state(params: SphSolidParams, laws: list[Solid], numbers: list[int]) -> State:
    """Particles of all bodies, moving as these do; nothing is strained."""
    fillings = [filling(body, params) for body in params.bodies]
    for number, particles in enumerate(fillings):
        _require(len(particles.points), f"bodies.{number}: it must hold a particle; it holds none.")
    body = np.repeat(np.arange(len(fillings)), [len(p.points) for p in fillings])
    position = np.concatenate([p.points for p in fillings])
    velocity = np.concatenate([
        starting_velocity(shape, particles.points)
        for shape, particles in zip(params.bodies, fillings, strict=True)
    ])  # fmt: skip
    fixed = _fixed_axes(position, params)
    for k in range(3):
        velocity[(fixed >> k) & 1 == 1, k] = 0.0
    speed = [np.sqrt(law.c2 + 4.0 / 3.0 * law.shear / law.density) for law in laws]
    kind, is_glued = np.array(numbers)[body], _is_glued(position, params)
    _refuse_held_twice(fixed, is_glued)
    glued, count = int(is_glued.sum()), len(position)
    return State(
        position=position,
        velocity=velocity,
        acceleration=np.zeros((count, 3)),
        heating=np.zeros(count),
        deviator=np.zeros((count, 6)),
        density_ratio=np.ones(count),
        pressure=np.zeros(count),
        energy=np.zeros(count),
        strain=np.zeros(count),
        temperature=np.array([law.temperature for law in laws])[kind],
        damage=np.zeros(count),
        failed=np.zeros(count),
        sound=np.array(speed)[kind],
        volume=np.concatenate([p.volume for p in fillings]),
        material=kind,
        body=body,
        glue=np.where(is_glued, np.cumsum(is_glued) - 1, -1),
        fixed=fixed,
        identity=np.arange(count),
        reference=position.copy(),
        pulled=velocity[is_glued],
        active=np.ones(glued),
        force=np.zeros((glued, 3)),
        ranges=np.zeros((3, 2)),
        sums=np.zeros(3),
        viscous=np.zeros(3),
        torn=np.zeros(5),
    )


def _fixed_axes(position: Array, params: SphSolidParams) -> Whole:
    """Axes along which particles keep their places, 1 2 4 added up (n,)."""
    axes: Whole = np.zeros(len(position), np.int64)
    for number, support in enumerate(params.fixed):
        rows = inside(position, support, params)
        _require(rows.any(), f"fixed.{number}: its box must hold a particle; it holds none.")
        for axis in support.directions:
            axes[rows] |= 1 << "xyz".index(axis)
    return axes


def _is_glued(position: Array, params: SphSolidParams) -> Mask:
    """Which particles (n,) are glued to a partner's mesh."""
    is_glued = np.zeros(len(position), bool)
    for number, region in enumerate(params.glued):
        rows = inside(position, region, params)
        _require(rows.any(), f"glued.{number}: its box must hold a particle; it holds none.")
        is_glued |= rows
    return is_glued


def _refuse_held_twice(fixed: Whole, is_glued: Mask) -> None:
    """Refuse particles that are held and glued: the mesh would not get their whole force."""
    count = int((is_glued & (fixed > 0)).sum())
    if count:
        raise SceneError(
            f"glued: particles must not be fixed too, as they move with a partner's mesh; found "
            f"{count} in boxes of both. Make the boxes of fixed smaller, and hold the mesh."
        )


def gauged(points: Array, params: SphSolidParams) -> Whole:
    """Numbers (gauges,) of the points (n, 3) m that are nearest to gauges at the start."""
    places = [np.array(gauge) for gauge in params.gauges]
    if params.dimensions == 2:
        places = [place * (1.0, 0.0, 1.0) for place in places]
    return nearest_rows(points, places)


def inside(points: Array, box: ByBox, params: SphSolidParams) -> Mask:
    """Which of points (n, 3) m are in a box; in two dimensions wherever it is along y."""
    return in_box(points, box, axes=(0, 2) if params.dimensions == 2 else (0, 1, 2))


def _require(rule: object, sentence: str) -> None:
    if not rule:
        raise SceneError(f"{sentence} Correct it, or take a smaller spacing.")
