"""Side views of a run, x to the right and z up: particles, bodies and walls at a few times.

Matplotlib is loaded by the functions that draw: a run without pictures does not need it.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.report.panels import place_panels, save
from quintet.coupler.report.view_drawing import (
    MARK,
    add_legend,
    bar_label,
    clipped_ends,
    colour_scales,
    diameters,
    draw_view,
    draw_walls,
    is_mark,
)
from quintet.coupler.report.view_steps import Shown, Still, moments, read, view_files, walls
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

MARGIN, BEYOND = 0.03, 0.12  # of the picture: around all that moves; how far walls may reach
WITHIN = 0.08  # of an edge: margin at most, as of long tanks
TALL, LOWEST = 2.0, 0.22  # height over width of a panel: at most; what is lower is stretched
FLATTEST = 0.05  # height over width of what is shown, at least
Region = tuple[tuple[float, float, float], tuple[float, float, float]]


def side_views(
    run: Path,
    out: Path,
    times: Sequence[float],
    title: str = "",
    colours: Sequence[str] = (),
    region: Region | None = None,
    displacement_scale: float = 1.0,
) -> Path:
    """Draw the side view of a run, one panel for each time.

    Parameters
    ----------
    run : Path
        Folder of a run; the view file of every component in it is drawn.
    out : Path
        The picture; its ending chooses the format.
    times : sequence of float, s
        The nearest step is taken; times after the run's end are its end.
    title : str
        Above all panels.
    colours : sequence of str
        What components are coloured by: ``component.field``. Points of others take the first field
        of their view; faces of others have a plain colour.
    region : two corners, m, optional
        Of the box that is shown; particles, and faces that show a field, are cut away in front of
        it, along y.
    displacement_scale : float
        How many times as large displacements are drawn, of components that show them.

    Returns
    -------
    Path
        `out`.
    """
    files = view_files(run)
    if not files or not len(times):
        raise SceneError(f"run {run}: a picture needs a .vtkhdf file with steps, and a time.")
    fields = dict(name.split(".", 1) for name in colours)
    instants = moments(files, times)
    views = [
        [_within(read(path, time, fields, displacement_scale), region) for path in files]
        for time in instants
    ]
    still = walls(run)
    low, high = _limits(views, still, region)
    wide, tall = high - low
    stretch = max(1.0, wide / tall * LOWEST)
    text = f"{title}\n{_said(region, stretch, displacement_scale)}".strip()
    figure, panels = place_panels(len(views), stretch * tall / wide, text)
    scales = colour_scales(views)
    sizes = diameters(views[0])
    for panel, time, view in zip(panels, instants, views, strict=True):
        panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect=stretch)
        panel.set(xlabel="x [m]", ylabel="z [m]")
        panel.set_title(f"t = {time:.4g} s", fontsize=10)
        panel.locator_params(axis="x", nbins=_ticks(figure, panel))
        draw_walls(panel, still)
        draw_view(panel, view, scales, sizes)
    _add_colour_bars(figure, panels, scales, views)
    add_legend(figure, views[0], still)
    return save(figure, out)


def _add_colour_bars(
    figure: Any, panels: Sequence[Any], scales: Mapping[Any, Any], views: Sequence[Sequence[Shown]]
) -> None:
    """Say beside the panels what colours stand for."""
    for quantity, scale in scales.items():
        bar = figure.colorbar(
            scale, ax=panels, label=bar_label(scale, views, quantity),
            extend=clipped_ends(scale, views, quantity), shrink=0.8, aspect=30, pad=0.02,
        )  # fmt: skip
        bar.formatter.set_powerlimits((-3, 4))


def _said(region: Region | None, stretch: float, displacement_scale: float) -> str:
    """Where one looks from, what is cut off, and what is not drawn to scale."""
    said = ["side view along y"]
    if region is not None:
        said.append(
            f"a part of the scene, with particles from y = {region[0][1]:g} to {region[1][1]:g} m"
        )
    if displacement_scale != 1.0:
        said.append(f"displacements drawn {displacement_scale:g} times as large")
    if stretch > 1.0:
        said.append(f"z drawn {stretch:.2g} times as long as x")
    return ", ".join(said)


def _ticks(figure: Any, panel: Any) -> int:
    """Numbers that have room along the x axis of a panel."""
    return max(2, int(1.2 * figure.get_figwidth() / panel.get_subplotspec().get_gridspec().ncols))


def _within(shown: Shown, region: Region | None) -> Shown:
    """Leave out what is in front of a region, or behind it; sort all, the farthest first.

    Plain bodies stay whole; faces that are coloured by a field are cut as particles are, so that
    solids that show the faces of all their elements are seen from within.
    """
    keep = np.isfinite(shown.points).all(axis=1)
    if region is not None:
        keep &= (shown.points[:, 1] >= region[0][1]) & (shown.points[:, 1] <= region[1][1])
    order = np.flatnonzero(keep)
    order = order[np.argsort(-shown.points[order, 1], kind="stable")]
    depth = np.array([float(face[:, 1].mean()) for face in shown.faces])
    faces = np.argsort(-depth, kind="stable")
    if region is not None and shown.face_values is not None:  # what shows a field inside a solid
        faces = faces[(depth[faces] >= region[0][1]) & (depth[faces] <= region[1][1])]
    return Shown(
        shown.name,
        shown.quantity,
        shown.points[order],
        shown.radius[order],
        None if shown.values is None else shown.values[order],
        [shown.faces[k] for k in faces],
        None if shown.face_values is None else shown.face_values[faces],
        None if shown.spacing is None else shown.spacing[order],
    )


def _limits(
    views: Sequence[Sequence[Shown]], still: Sequence[Still], region: Region | None
) -> tuple[Array, Array]:
    """Lowest and highest corner (2,) m, x and z, of all panels: what moves, and walls around it."""
    if region is not None:
        return np.array(region[0])[[0, 2]], np.array(region[1])[[0, 2]]
    every = np.concatenate([_reach(shown) for view in views for shown in view])
    if not len(every):
        raise SceneError("a picture needs at least one point; no step has any.")
    low, high = every.min(axis=0), every.max(axis=0)
    size = max(float((high - low).max()), 1e-6)
    if any(is_mark(shown) for shown in views[0]):
        low, high = low - 0.5 * MARK * size, high + 0.5 * MARK * size
    if still:
        corners = np.concatenate([wall.corners for wall in still])[:, [0, 2]]
        low = np.minimum(low, np.maximum(corners.min(axis=0), low - BEYOND * size))
        high = np.maximum(high, np.minimum(corners.max(axis=0), high + BEYOND * size))
    margin = np.minimum(MARGIN * size, WITHIN * (high - low))
    low, high = low - margin, high + margin
    middle, (wide, tall) = 0.5 * (low + high), high - low
    half = 0.5 * np.array([max(wide, tall / TALL), max(tall, wide * FLATTEST)])
    return middle - half, middle + half


def _reach(shown: Shown) -> Array:
    """Points (n, 2) m, x and z, between which all of a component lies."""
    centre, radius = shown.points[:, [0, 2]], shown.radius[:, None]
    corners = [face[:, [0, 2]] for face in shown.faces]
    ends = np.concatenate([np.zeros((0, 2)), centre - radius, centre + radius, *corners])
    return np.asarray(ends[np.isfinite(ends).all(axis=1)])
