"""Pictures of a run: side views of particles and bodies, time series against references.

Matplotlib is loaded by the functions that draw: a run without pictures does not need it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.files import vtkhdf
from quintet.coupler.files.recording import Recording
from quintet.coupler.measures.expectation import (
    DISTANCES,
    Expectation,
    Outcome,
    curve,
    reference_curve,
)
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

IN_UNIT = ("rms", "at", "max", "min", "mean")  # measures that have the unit of their curve
PANEL_WIDTH = 5.2  # inches
COLUMNS = 2
DOTS = 150  # per inch
SAMPLE = 24  # points from whose nearest neighbours the spacing is estimated
LIGHT = np.array([-0.4, -0.8, 0.6])  # towards the light; the eye looks along +y
SOLID = np.array([0.80, 0.66, 0.48])  # colour of faces


@dataclass(frozen=True, slots=True)
class SideView:
    """Particles and faces in a side view at one time."""

    time: float  # s
    points: Array  # (n, 3) m, particles, the farthest first
    speed: Array  # (n,) m/s
    faces: list[Array]  # (3 or 4, 2) m each, the farthest first
    shades: Array  # (faces, 3) colours


def side_views(run: Path, out: Path, times: Sequence[float]) -> Path:
    """Draw the side view, x to the right and z up, one panel for each time.

    Parameters
    ----------
    run : Path
        Folder of a run; every ``.vtkhdf`` file in it is drawn.
    out : Path
        The picture; its ending chooses the format.
    times : sequence of float, s
        The nearest step of each file is taken.

    Returns
    -------
    Path
        `out`.
    """
    files = sorted(Path(run).glob("*.vtkhdf"))
    files = [path for path in files if len(vtkhdf.times(path))]
    if not files or not len(times):
        raise SceneError(f"run {run}: a picture needs a .vtkhdf file with steps, and a time.")
    views = [_side_view(files, time) for time in times]
    low, high = _bounds(views)
    figure, panels = panels_of(len(views), (high - low)[1] / (high - low)[0])
    drawn = None
    top = max((float(view.speed.max(initial=0.0)) for view in views), default=0.0) or 1.0
    for panel, view in zip(panels, views, strict=True):
        panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
        panel.set_title(f"t = {view.time:.4g} s", fontsize=10)
        panel.set(xlabel="x [m]", ylabel="z [m]")
        drawn = _draw(panel, view, top) or drawn
    if drawn is not None:
        figure.colorbar(drawn, ax=panels, label="speed [m/s]", shrink=0.8, aspect=30, pad=0.02)
    return save(figure, out)


def comparison(
    folder: Path,
    expectations: Sequence[Expectation],
    outcomes: Sequence[Outcome],
    recording: Recording,
    out: Path,
) -> Path | None:
    """Draw computed curves against their references, one panel for each that has a file.

    Parameters
    ----------
    folder : Path
        Of the scene, where the reference curves are.
    expectations, outcomes : sequences
        Matched by name.
    recording : Recording
    out : Path
        The picture; its ending chooses the format.

    Returns
    -------
    Path or None
        `out`, or None when no expectation has a reference curve, and nothing is drawn.
    """
    wanted = [one for one in expectations if one.csv is not None]
    if not wanted:
        return None
    results = {outcome.name: outcome for outcome in outcomes}
    figure, panels = panels_of(len(wanted), 0.62)
    for panel, one in zip(panels, wanted, strict=True):
        _compare(panel, one, results.get(one.name), recording, Path(folder))
    return save(figure, out)


def _compare(
    panel: Any, one: Expectation, outcome: Outcome | None, recording: Recording, folder: Path
) -> None:
    reference = reference_curve(one, folder)
    assert reference is not None
    computed = curve(one, recording)
    panel.plot(*computed, color="tab:blue", linewidth=1.5, label="computed")
    panel.plot(*reference, "o", color="black", markersize=3.5, fillstyle="none", label="reference")
    panel.set_title(_title(one, outcome), fontsize=9)
    end = max(reference.times[-1], one.end or 0.0)
    panel.set_xlim(min(reference.times[0], one.begin), end * 1.02)
    # Of other measures the unit is not that of the curve, which only the field can say.
    unit = f" [{one.unit}]" if one.measure in IN_UNIT else ""
    panel.set(xlabel="t [s]", ylabel=f"{one.component} {one.field}{unit}")
    if one.level is not None:
        panel.axhline(one.level, color="grey", linewidth=0.8, linestyle="--")
    panel.grid(alpha=0.3)
    panel.legend(fontsize=8, frameon=False)


def _title(one: Expectation, outcome: Outcome | None) -> str:
    measure = one.measure.replace("rms", "RMS").replace("_", " ")
    if outcome is None or outcome.value is None:
        return f"{one.name}: {measure} has no value"
    against = "" if one.measure in DISTANCES else f" against {outcome.reference:.4g}"
    verdict = "met" if outcome.met else "NOT met"
    return (
        f"{one.name}: {measure} {outcome.value:.3g}{against}, "
        f"within {outcome.within:.3g} {one.unit}: {verdict}"
    )


def panels_of(count: int, height: float) -> tuple[Any, list[Any]]:
    """Make a figure of panels; `height` is that of one panel over its width."""
    # A run without pictures does not load matplotlib.
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    columns = min(count, COLUMNS)
    rows = -(-count // columns)
    tall = PANEL_WIDTH * min(max(height, 0.2), 2.0) + 0.7
    figure = Figure(figsize=(PANEL_WIDTH * columns + 0.9, tall * rows), layout="constrained")
    FigureCanvasAgg(figure)  # no window, and none of the global state of pyplot
    panels = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
    for unused in panels[count:]:
        unused.remove()
    return figure, panels[:count]


def save(figure: Any, out: Path) -> Path:
    """Write a figure in the format of the file's ending."""
    Path(out).parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(out, dpi=DOTS)
    return Path(out)


def _side_view(files: Sequence[Path], time: float) -> SideView:
    points, speeds, faces, depths, shades = [], [], [], [], []
    found = time
    for path in files:
        step = int(np.argmin(np.abs(vtkhdf.times(path) - time)))
        found, fields = vtkhdf.read_step(path, step)
        if "cells" in fields:
            for corners in _corners(fields):
                faces.append(corners[:, [0, 2]])
                depths.append(corners[:, 1].mean())
                shades.append(_shade(corners))
        else:
            points.append(fields["points"])
            speeds.append(_speed(fields))
    cloud = np.concatenate([np.zeros((0, 3)), *points])
    speed = np.concatenate([np.zeros(0), *speeds])
    far = np.argsort(-cloud[:, 1], kind="stable")
    order = np.argsort(-np.array(depths), kind="stable")
    ordered = [faces[i] for i in order]
    return SideView(found, cloud[far], speed[far], ordered, np.array(shades).reshape(-1, 3)[order])


def _corners(view: Mapping[str, Array]) -> list[Array]:
    return [view["points"][cell[cell >= 0]] for cell in view["cells"]]


def _speed(view: Mapping[str, Array]) -> Array:
    velocity = view.get("velocity")
    if velocity is None:
        return np.zeros(len(view["points"]))
    return np.linalg.norm(velocity.reshape(len(velocity), -1), axis=1)


def _shade(corners: Array) -> Array:
    """Colour of a face under diffuse light."""
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    cosine = abs(float(normal @ LIGHT)) / max(float(np.linalg.norm(normal)), 1e-300)
    return SOLID * (0.55 + 0.45 * min(cosine / float(np.linalg.norm(LIGHT)), 1.0))


def _bounds(views: Sequence[SideView]) -> tuple[Array, Array]:
    """Bounds (2,) m common to all panels: of all points and faces, with a margin."""
    seen = [view.points[:, [0, 2]] for view in views] + [f for view in views for f in view.faces]
    every = np.concatenate(seen)
    every = every[np.isfinite(every).all(axis=1)]
    if not len(every):
        raise SceneError("a picture needs at least one point; no step has any.")
    low, high = every.min(axis=0), every.max(axis=0)
    margin = 0.03 * max(float((high - low).max()), 1e-6)
    return low - margin, high + margin


def _spacing(points: Array) -> float:
    """Median distance [m] of nearest neighbours, of a sample of particles; 0 if unknown."""
    if len(points) < 2:
        return 0.0
    nearest = []
    for one in points[np.linspace(0, len(points) - 1, SAMPLE).astype(int)]:
        distance = np.sum((points - one) ** 2, axis=1)
        nearest.append(np.min(distance[distance > 0.0], initial=np.inf))
    spacing = float(np.sqrt(np.median(nearest)))
    return spacing if np.isfinite(spacing) else 0.0


def _draw(panel: Any, view: SideView, top: float) -> Any:
    # A run without pictures does not load matplotlib.
    from matplotlib.collections import PolyCollection

    drawn = None
    if len(view.points):
        width = panel.get_xlim()[1] - panel.get_xlim()[0]
        across = 72.0 * (PANEL_WIDTH - 1.0) * _spacing(view.points) / width  # typographic points
        x, z = view.points[:, 0], view.points[:, 2]
        drawn = panel.scatter(
            x, z, max(1.3 * across, 0.8) ** 2, view.speed, cmap="viridis", vmin=0.0, vmax=top,
            linewidths=0, rasterized=True,
        )  # fmt: skip
    # Bodies are drawn last, although fluid may be in front: they would be hidden by it.
    faces = PolyCollection(view.faces, facecolors=view.shades, edgecolors="black", linewidths=0.3)
    faces.set_zorder(3)
    panel.add_collection(faces, autolim=False)
    return drawn
