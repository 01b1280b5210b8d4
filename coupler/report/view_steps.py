"""What components show at the times of pictures, read from their view files."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.files.run_files import FAILURE, VIEWS, WALLS
from quintet.interfaces.component import Array
from quintet.interfaces.faces import WALL

SAMPLE = 24  # points from whose nearest neighbours the spacing is estimated; fewer have none
DISPLACEMENT = "displacement"  # from where points were at the start
SPACING = "spacing"  # of nodes that sample a continuum; points without it are particles
NAMES = {"velocity": "speed"}  # of the magnitude of a vector


@dataclass(frozen=True, slots=True)
class Quantity:
    """What colours stand for."""

    name: str
    unit: str  # "" where it is not known

    @property
    def label(self) -> str:
        """Name and unit, for a colour bar."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True, slots=True)
class Shown:
    """A component at one time: points or spheres, and faces; values where they are coloured."""

    name: str
    quantity: Quantity | None
    points: Array  # (n, 3) m, of no face
    radius: Array  # (n,) m, 0 where they are no spheres
    values: Array | None  # (n,)
    faces: list[Array]  # (k, 3) m each
    face_values: Array | None  # (faces,)
    spacing: Array | None = None  # (n,) m, of nodes that sample a continuum


def view_files(run: Path) -> list[Path]:
    """Files of a run that show components, by name, but for those of walls and of failures."""
    others = (WALLS, FAILURE)
    files = sorted(path for path in Path(run).glob(f"*{VIEWS}") if not path.name.endswith(others))
    return [path for path in files if len(vtkhdf_reader.times(path))]


class Still(NamedTuple):
    """A face that stands still: a wall, a clamped face of a body, or a plane of symmetry."""

    corners: Array  # (k, 3) m
    support: int = WALL  # one of those of `interfaces.faces`


def walls(run: Path, time: float = 0.0) -> list[Still]:
    """All faces that stand still in a run, and those that move at the step next to a time [s]."""
    stills = []
    for path in sorted(Path(run).glob(f"*{WALLS}")):
        times = vtkhdf_reader.times(path)
        if len(times):
            view = vtkhdf_reader.read_step(path, int(np.abs(times - time).argmin()))[1]
            faces = corners_of(view)
            kinds = view.get("support", np.full(len(faces), WALL)).astype(int).tolist()
            stills += [Still(*wall) for wall in zip(faces, kinds, strict=True)]
    return stills


def moments(files: Sequence[Path], wanted: Sequence[float]) -> list[float]:
    """Times [s] of the steps next to those wanted, each once; none is later than the last step."""
    known = np.unique(np.concatenate([vtkhdf_reader.times(path) for path in files]))
    return sorted({float(known[np.abs(known - time).argmin()]) for time in wanted})


def read(
    path: Path, time: float, fields: Mapping[str, str], displacement_scale: float = 1.0
) -> Shown:
    """Read what a component shows at the step next to a time [s].

    `fields` names what components are coloured by. Where it does not name one, points take the
    first field of their view, and faces have no values. Displacements, where they are shown, are
    taken so many times as large.
    """
    step = int(np.abs(vtkhdf_reader.times(path) - time).argmin())
    view, units = vtkhdf_reader.read_step(path, step)[1], vtkhdf_reader.units(path)
    if displacement_scale != 1.0 and DISPLACEMENT in view:
        moved = view["points"] + (displacement_scale - 1.0) * view[DISPLACEMENT]
        view = {**view, "points": moved}
    name = path.name.removesuffix(VIEWS)
    first = "velocity" if "velocity" in units else next(iter(units), "")
    field = fields.get(name, first if any(units.values()) or first == "velocity" else "")
    array = view.get(field)
    cells = view.get("cells")
    count = len(view["points"])
    loose = np.ones(count, bool)
    if cells is not None:
        loose[cells[cells >= 0]] = False
    values = None if array is None else magnitude(array)
    over_points = values is not None and len(values) == count
    return Shown(
        name,
        None if array is None else quantity(field, array, units.get(field, "")),
        view["points"][loose],
        view.get("radius", np.zeros(count))[loose],
        values[loose] if values is not None and over_points else None,
        corners_of(view),
        _of_faces(values, cells, over_points) if name in fields else None,
        view[SPACING][loose] if SPACING in view else None,
    )


def quantity(field: str, array: Array, unit: str) -> Quantity:
    """Name what a field stands for; vectors are shown by their magnitude."""
    plain = field.replace("_", " ")
    if array.ndim > 1 and array.shape[1] > 1:
        return Quantity(NAMES.get(field, f"magnitude of {plain}"), unit)
    return Quantity(plain, unit)


def magnitude(array: Array) -> Array:
    """Values (n,) of scalars as they are, of vectors their length."""
    flat = array.reshape(len(array), math.prod(array.shape[1:]))  # also of no rows
    return flat[:, 0] if flat.shape[1] == 1 else np.linalg.norm(flat, axis=1)


def _of_faces(values: Array | None, cells: Array | None, over_points: bool) -> Array | None:
    """Values of faces: their own, or the mean of their corners."""
    if values is None or cells is None:
        return None
    if not over_points:
        return values
    used = cells >= 0
    return np.asarray((values[cells] * used).sum(axis=1) / used.sum(axis=1))


def corners_of(view: Mapping[str, Array]) -> list[Array]:
    """Corners (k, 3) m of each face of a view."""
    return [view["points"][cell[cell >= 0]] for cell in view.get("cells", ())]


def spacing(points: Array) -> float:
    """Median distance [m] of nearest neighbours, of a sample of particles; 0 if they are few."""
    if len(points) < SAMPLE:
        return 0.0
    nearest = []
    for point in points[np.linspace(0, len(points) - 1, SAMPLE).astype(int)]:
        distance = np.sum((points - point) ** 2, axis=1)
        nearest.append(np.min(distance[distance > 0.0], initial=np.inf))
    distance_between = float(np.sqrt(np.median(nearest)))
    return distance_between if np.isfinite(distance_between) else 0.0
