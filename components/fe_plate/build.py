"""A structure as its parameters describe it: mesh, masses, supports."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from quintet.components.fe_plate.kernels.eight_points import write_point_volumes
from quintet.components.fe_plate.kernels.geometry import write_volumes
from quintet.components.fe_plate.meshes.mesh import Mesh, chosen, faces_in, mesh
from quintet.components.fe_plate.meshes.tetrahedra import point_volumes
from quintet.components.fe_plate.params import FePlateParams, RigidWall
from quintet.components.fe_plate.points import points_of
from quintet.components.fe_plate.state import (
    LANES,
    TEMPERATURE,
    Array,
    Flags,
    Index,
    Model,
    Parted,
    Places,
    Resistance,
    Sizes,
    Span,
    State,
    Whole,
    node_shares,
    state_at_rest,
)
from quintet.components.shared.geometry.selections import ByBoxOrSet
from quintet.components.shared.materials.params import material
from quintet.components.shared.materials.solid import NEVER, Solid, solid
from quintet.interfaces.errors import SceneError

AXES = ("x", "y", "z")


class Structure(NamedTuple):
    """All that is known before the first step."""

    mesh: Mesh
    model: Model
    parted: Parted
    places: Places  # of the elements' points
    laws: list[Solid]  # of the parts
    inner: list[Span]  # blocks stepped first, without nodes that another rank moves
    border: list[Span]  # others
    volume: Array  # (e,) m3
    mass: Array  # (n,) kg, without added mass
    coupled: Whole  # (f,) numbers of the outer faces that partners see
    pressed: list[Whole]  # for each pressure the outer faces that it acts on
    face_places: Places  # of the elements of all outer faces
    element_mass: Array  # (e,) kg
    resistance: Resistance
    shortest: float  # m, least edge of cubes, or squares, as large as the elements

    def corners(self, elements: Whole | slice) -> Index:
        """Nodes (k, c) at the corners of some elements, where `mesh` need not have them."""
        point = self.places.point[elements, 0]
        return self.model.corner[point // self.places.point.shape[1]]


def structure(
    params: FePlateParams, ends: Callable[[int], list[int]] = lambda blocks: [0, blocks]
) -> Structure:
    """Build a structure; `ends` gives the ends of the shares of a number of blocks, from 0 on."""
    grid = mesh(params.parts, params.dimensions, params.node_sets)
    depth = 1.0 if params.dimensions == 2 else 0.0  # m
    laws = [eroding(solid(material(part.material)), params.erosion) for part in params.parts]
    volume = _volumes(grid, depth)
    element_mass = np.array([law.density for law in laws])[grid.part] * volume
    nodes, points = len(grid.node), points_of(params)
    share = element_mass[:, None] * node_shares(grid.corner.shape[1])
    mass = np.bincount(grid.corner.ravel(), share.ravel(), nodes).astype(np.float64)
    place, element, first = in_blocks(grid.part, len(laws), LANES // points)
    corner = grid.corner[element].astype(np.uint32)
    point_volume = _point_volumes(grid, corner, volume[element], points, depth)
    spans = [Span(part, *pair) for part, pair in enumerate(pairwise(first))]
    filled = filled_places(place, first[-1], LANES // points)
    target, acts, parted = targets(corner, filled, spans, ends, nodes)
    model = Model(
        corner=target[: len(corner)],
        target=target,
        acts=acts,
        filled=filled,
        volume=point_volume,
        depth=depth,
        inverse_mass=1.0 / mass,
        free=_free_axes(grid, params),
        gravity=np.array(params.gravity),
        walls=_walls(params.rigid_walls),
        moving=nodes,
    )
    places = _places(place, point_volume, points)
    coupled, pressed = _loaded_faces(grid, params)
    shortest = float(volume.min() ** (1.0 / params.dimensions))
    return Structure(
        grid, model, parted, places, laws, spans, [], volume, mass, coupled, pressed,
        places.subset(grid.owner), element_mass, _resistance(params), shortest,
    )  # fmt: skip


def _point_volumes(grid: Mesh, corner: Index, volume: Array, points: int, depth: float) -> Array:
    """Volumes [m3] of the points of all places, from those (places,) of their elements."""
    if points == 1:
        return volume
    if grid.has_tetrahedra:
        return point_volumes(grid.node, corner.astype(np.int64)).ravel()
    volumes = np.empty(points * len(corner))
    write_point_volumes(grid.node, corner, depth, volumes)
    return volumes


def _places(place: Whole, point_volume: Array, points: int) -> Places:
    """Points of each element, and their shares of its mass."""
    point = points * place[:, None] + np.arange(points)
    volumes = point_volume[point]
    return Places(point, volumes / volumes.sum(axis=1, keepdims=True))


def _resistance(params: FePlateParams) -> Resistance:
    return Resistance(
        params.hourglass,
        params.viscosity_linear,
        params.viscosity_quadratic,
        params.stiffness_damping,
    )


def _volumes(grid: Mesh, depth: float) -> Array:
    """Volume (e,) m3 of the elements, of a depth [m] along y in a plane; all must be positive."""
    if grid.has_tetrahedra:  # checked as they were read
        return np.asarray(point_volumes(grid.node, grid.corner).sum(axis=1))
    volume = np.empty(len(grid.corner))
    write_volumes(grid.node, grid.corner.astype(np.uint32), depth, volume)
    if not (volume > 0.0).all():
        worst = int(np.argmin(volume))
        middle = np.array2string(grid.node[grid.corner[worst]].mean(axis=0), precision=4)
        raise SceneError(
            f"element {worst} at {middle} m must have a volume above 0; found "
            f"{volume[worst]:.3g} m3: it is inside out. Reverse its corners, or remesh it."
        )
    return volume


def _walls(rigid_walls: Sequence[RigidWall]) -> Array:
    """Unit normal and offset (w, 4) of rigid walls."""
    walls = np.zeros((len(rigid_walls), 4))
    for row, wall in zip(walls, rigid_walls, strict=True):
        row[:3] = np.array(wall.normal) / np.linalg.norm(wall.normal)
        row[3] = row[:3] @ wall.point
    return walls


def _free_axes(grid: Mesh, params: FePlateParams) -> Flags:
    """1 or 0 (n, 3): whether a node moves along an axis."""
    free: Flags = np.ones((len(grid.node), 3), np.uint8)
    for number, support in enumerate(params.fixed):
        nodes = chosen(grid, support, f"fixed.{number}")
        _require(nodes.any(), f"fixed.{number}: it must hold a node; it holds none.", [support])
        for axis in support.directions:
            free[nodes, AXES.index(axis)] = 0
    if params.dimensions == 2:
        free[:, 1] = 0
    return free


def _loaded_faces(grid: Mesh, params: FePlateParams) -> tuple[Whole, list[Whole]]:
    """Numbers of the outer faces that partners see, and of those that each pressure acts on."""
    coupled: Whole = np.arange(len(grid.side))
    if params.coupled_faces:
        coupled = faces_in(grid, params.coupled_faces, "coupled_faces")
        sentence = "coupled_faces: they must hold an outer face; none does."
        _require(len(coupled) > 0, sentence, params.coupled_faces)
    pressed = [faces_in(grid, [load.faces], "pressures") for load in params.pressures]
    for number, faces in enumerate(pressed):
        sentence = f"pressures.{number}: it must hold an outer face; it holds none."
        _require(len(faces) > 0, sentence, [params.pressures[number].faces])
    return coupled, pressed


def eroding(law: Solid, by: Sequence[str]) -> Solid:
    """Numbers of a material that fails only by what a scene names."""
    if "plastic_strain" not in by:
        law = law._replace(failure_strain=NEVER)
    if "damage" not in by:
        law = law._replace(d1=0.0, d2=0.0)
    return law if "spall" in by else law._replace(spall=NEVER)


def in_blocks(part: Whole, parts: int, size: int) -> tuple[Whole, Whole, list[int]]:
    """Place of each element, element at each place, and first block of each part.

    A block holds `size` elements. Parts begin with a block; places beyond their last element
    repeat it.
    """
    place, element, first = [], [], [0]
    for k in range(parts):
        mine = np.flatnonzero(part == k)
        blocks = -(-len(mine) // size)
        place.append(first[-1] * size + np.arange(len(mine)))
        element.append(np.pad(mine, (0, blocks * size - len(mine)), mode="edge"))
        first.append(first[-1] + blocks)
    return np.concatenate(place), np.concatenate(element), first


def filled_places(place: Whole, blocks: int, size: int) -> Index:
    """Places of each block (blocks,) that elements fill, from the place of each element."""
    return np.bincount(place // size, minlength=blocks).astype(np.uint32)


def targets(
    corner: Index,
    filled: Index,
    spans: Sequence[Span],
    ends: Callable[[int], list[int]],
    nodes: int,
) -> tuple[Index, Index, Parted]:
    """Rows of forces that corners act on, where those of each block begin, and parted nodes.

    A node all of whose elements one thread steps one after another is acted on at once; of others
    each corner has a row of its own, in the order of the elements, so that the sum is the same.
    Blocks with such corners have rows of their own behind all corners; others act on their nodes.

    Parameters
    ----------
    corner : (places, c) int array
    filled : (b,) int array
    spans : sequence of Span
        All blocks, in the order in which they are stepped.
    ends : function
        Ends of the shares of a number of blocks, from 0 on.
    nodes : int
    """
    blocks = len(filled)
    size, corners = len(corner) // blocks, corner.shape[1]
    acts = size * np.arange(blocks, dtype=np.uint32)
    none: Whole = np.zeros(0, np.int64)
    filled_spans = [span for span in spans if span.last > span.first]
    rising = sorted(filled_spans, key=lambda span: span.first)
    shares = [span.first + end for span in rising for end in ends(span.last - span.first)[1:]]
    # One thread steps all, one after another.
    if len(shares) == len(rising) and rising == filled_spans:
        return corner, acts, Parted(none, none)
    used = (np.arange(size) < filled[:, None]).ravel()
    share = np.repeat(np.searchsorted(shares, np.arange(blocks), "right"), size)
    flat, number = corner[used].ravel(), np.repeat(share[used], corners)
    lowest, highest = np.full(nodes, len(shares)), np.zeros(nodes, np.int64)
    np.minimum.at(lowest, flat, number)
    np.maximum.at(highest, flat, number)
    is_parted = lowest < highest
    at = np.flatnonzero(is_parted[corner.ravel()] & np.repeat(used, corners))
    at = at[np.argsort(corner.ravel()[at], kind="stable")]
    detached, row = np.unique(at // (corners * size), return_inverse=True)  # blocks
    behind = corner.reshape(blocks, -1)[detached]
    behind[row, at % (corners * size)] = nodes + np.arange(len(at))
    acts[detached] = len(corner) + size * np.arange(len(detached))
    node = np.flatnonzero(is_parted)
    begin = nodes + np.searchsorted(corner.ravel()[at], np.append(node, nodes))
    return np.concatenate([corner, behind.reshape(-1, corners)]), acts, Parted(node, begin)


def initial_state(params: FePlateParams, built: Structure) -> State:
    """Temperatures and velocities that the parts have at the start; nothing is strained."""
    model, node = built.model, built.mesh.node
    blocks, nodes = len(model.filled), len(node)
    sizes = Sizes(
        springs=blocks if points_of(params) == 1 else 0,
        forces=max(nodes, int(model.target.max()) + 1),
        walls=len(model.walls),
        pressed=nodes if params.pressures else 0,
        damped=nodes if params.mass_damping else 0,
    )
    state = state_at_rest(node, blocks, sizes)
    size = len(model.corner) // blocks  # elements of a block
    for part, first, last in (*built.inner, *built.border):
        state.points[first:last, TEMPERATURE] = built.laws[part].temperature
        nodes_here = np.unique(model.corner[first * size : last * size])
        of_part, of_file = params.parts[part].velocity, built.mesh.velocity
        if of_part is not None:
            state.velocity[nodes_here] = of_part
        elif of_file is not None:
            state.velocity[nodes_here] = of_file[nodes_here]
    state.velocity[:] *= model.free
    state.mean_velocity[:] = state.velocity
    return state


def _require(rule: object, sentence: str, selections: Sequence[ByBoxOrSet]) -> None:
    if not rule:
        cures = dict.fromkeys(selection.cure for selection in selections)
        raise SceneError(f"{sentence} {' '.join(cures)}")
