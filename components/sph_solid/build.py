"""Bodies as their parameters describe them: particles at rest in themselves."""

import numpy as np

from quintet.components.shared.materials.params import Material, material
from quintet.components.shared.materials.solid import Solid, solid
from quintet.components.shared.smoothing.smoothing import kernel, smoothing
from quintet.components.sph_solid.filling import filling, starting_velocity
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.method import method
from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.state import Array, State, Whole
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import Vector


def materials(params: SphSolidParams) -> tuple[list[Solid], list[int]]:
    """Laws of the materials, each once, and which one each body has."""
    found: list[Material] = []
    numbers = []
    for body in params.bodies:
        made = material(body.material)
        if made not in found:
            found.append(made)
        numbers.append(found.index(made))
    return [solid(one) for one in found], numbers


def pair_law(params: SphSolidParams) -> PairLaw:
    """Numbers of pairs."""
    is_plane = params.dimensions == 2 and not params.axisymmetric
    way = method(params)
    smooth = smoothing("cubic", 2 if is_plane else 3, params.length)
    return PairLaw(
        smoothing=smooth,
        softening=0.01 * params.length**2,
        linear=way.linear,
        quadratic=way.quadratic,
        plane=1.0 if is_plane else 0.0,
        corrected=True if way.kernel_correction else None,
        artificial=params.artificial_stress or None,
        per_spacing=1.0 / kernel(params.spacing**2, smooth),
    )


def initial_state(params: SphSolidParams, laws: list[Solid], numbers: list[int]) -> State:
    """Particles of all bodies, moving as these do; nothing is strained."""
    filled = [filling(body, params) for body in params.bodies]
    for number, one in enumerate(filled):
        _require(len(one.points), f"bodies.{number}: it must hold a particle; it holds none.")
    counts = [len(one.points) for one in filled]
    body = np.repeat(np.arange(len(counts)), counts)
    position = np.concatenate([one.points for one in filled])
    kind = np.array(numbers)[body]
    count = len(position)
    fixed: Whole = np.zeros(count, np.int64)
    for number, held in enumerate(params.fixed):
        found = inside(position, held.lowest, held.highest, params)
        _require(found.any(), f"fixed.{number}: its box must hold a particle; it holds none.")
        for axis in held.directions:
            fixed[found] |= 1 << "xyz".index(axis)
    hangs = np.zeros(count, bool)
    for number, region in enumerate(params.glued):
        found = inside(position, region.lowest, region.highest, params)
        _require(found.any(), f"glued.{number}: its box must hold a particle; it holds none.")
        hangs |= found
    glue: Whole = np.where(hangs, np.cumsum(hangs) - 1, -1)
    velocity = np.concatenate([
        starting_velocity(one, filled_body.points)
        for one, filled_body in zip(params.bodies, filled, strict=True)
    ])  # fmt: skip
    if params.dimensions == 2:
        velocity[:, 1] = 0.0
    for k in range(3):
        velocity[(fixed >> k) & 1 == 1, k] = 0.0
    zeros = np.zeros(count)
    speed = [np.sqrt(law.c2 + 4.0 / 3.0 * law.shear / law.density) for law in laws]
    return State(
        position=position,
        velocity=velocity,
        acceleration=np.zeros((count, 3)),
        heating=zeros.copy(),
        deviator=np.zeros((count, 6)),
        density_ratio=np.ones(count),
        pressure=zeros.copy(),
        energy=zeros.copy(),
        strain=zeros.copy(),
        temperature=np.array([law.temperature for law in laws])[kind],
        damage=zeros.copy(),
        failed=zeros.copy(),
        sound=np.array(speed)[kind],
        volume=np.concatenate([one.volume for one in filled]),
        material=kind,
        body=body,
        glue=glue,
        fixed=fixed,
        identity=np.arange(count),
        reference=position.copy(),
        pulled=velocity[hangs],
        active=np.ones(int(hangs.sum())),
        force=np.zeros((int(hangs.sum()), 3)),
        ranges=np.zeros((3, 2)),
        sums=np.zeros(3),
        viscous=np.zeros(2),
        torn=np.zeros(5),
    )


def nearest(points: Array, params: SphSolidParams) -> Whole:
    """Numbers (gauges,) of the points (n, 3) m that are nearest to gauges at the start."""
    places = [np.array(one) for one in params.gauges]
    if params.dimensions == 2:
        places = [place * (1.0, 0.0, 1.0) for place in places]
    return np.array([((points - one) ** 2).sum(axis=1).argmin() for one in places], np.int64)


def inside(points: Array, lowest: Vector, highest: Vector, params: SphSolidParams) -> Array:
    """Which of points (n, 3) m are in a box; in two dimensions wherever it is along y."""
    within = (points >= np.array(lowest)) & (points <= np.array(highest))
    if params.dimensions == 2:
        within[:, 1] = True
    return np.asarray(within.all(axis=1))


def _require(rule: object, sentence: str) -> None:
    if not rule:
        raise SceneError(f"{sentence} Correct it, or take a smaller spacing.")
