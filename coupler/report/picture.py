"""Pictures of a run: particles, bodies and walls at a few times, seen along an axis.

Matplotlib is loaded by the functions that draw: a run without pictures does not need it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from quintet.coupler.report.axes_units import fit, with_unit
from quintet.coupler.report.cut import cut_and_sorted, depth_of_bodies
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
from quintet.coupler.report.viewpoint import SIDE, Box, Viewpoint
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

MARGIN, BEYOND = 0.03, 0.12  # of the picture: around all that moves; how far walls may reach
WITHIN = 0.08  # of an edge: margin at most, as of long tanks
TALL, LOWEST = 2.0, 0.22  # height over width of a panel: at most; what is lower is stretched
FLATTEST = 0.05  # height over width of what is shown, at least
NARROWEST = 20.0  # height over width of a region, at most


@dataclass(frozen=True)
class Picture:
    """What a picture shows, one panel for each time.

    Attributes
    ----------
    times : sequence of float, s
        The nearest step is taken; times after the run's end are its end.
    colours : sequence of str
        What components are coloured by: ``component.field``. Points of others take the first field
        of their view; faces of others have a plain colour.
    ranges : mapping
        Lowest and highest value of the colours of a component, by its name; from the values
        themselves where it has none.
    region : two corners, m, optional
        Of the box that is shown; particles, and faces that show a field, are cut away outside of
        it, along the axis along which one looks.
    section : float, m, optional
        Coordinate on that axis in front of which the same is cut away. Without both, particles in
        front of the middle of bodies are left out, where they would hide them.
    displacement_scale : float
        How many times as large displacements are drawn, of components that show them.
    viewpoint : Viewpoint
    """

    times: Sequence[float]
    colours: Sequence[str] = ()
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    region: Box | None = None
    section: float | None = None
    displacement_scale: float = 1.0
    viewpoint: Viewpoint = SIDE


class Cut(NamedTuple):
    """What is shown of the depth of a picture, in a turned view [m]."""

    near: float
    far: float
    text: str  # what is left out
    keeps_bodies: bool = False


def draw_run(run: Path, out: Path, picture: Picture, title: str = "") -> Path:
    """Draw a run at some times, one panel each; return `out`.

    Parameters
    ----------
    run : Path
        Folder of a run; the view file of every component in it is drawn.
    out : Path
        The picture; its ending chooses the format.
    picture : Picture
    title : str
        Above all panels.
    """
    files = view_files(run)
    if not files or not len(picture.times):
        raise SceneError(f"run {run}: a picture needs a .vtkhdf file with steps, and a time.")
    instants, viewpoint = moments(files, picture.times), picture.viewpoint
    cut, views = turned_views(files, instants, picture)
    stills = [[viewpoint.turned_wall(wall) for wall in walls(run, time)] for time in instants]
    every = [wall for still in stills for wall in still]
    low, high = limits(views, every, picture.region and viewpoint.turned_box(picture.region))
    wide, tall = high - low
    if not wide * NARROWEST >= tall > 0.0:
        raise SceneError(
            f"a picture in the {viewpoint.name} view shows {viewpoint.names[0]} and "
            f"{viewpoint.names[1]}, and a region must extend along both, along "
            f"{viewpoint.names[0]} by a {NARROWEST:g}th of {viewpoint.names[1]} or more; found "
            f"{wide:g} and {tall:g} m. Choose another region or view."
        )
    stretch = max(1.0, wide / tall * LOWEST)
    text = f"{title}\n{_said(picture, cut, stretch)}".strip()
    figure, panels = place_panels(len(views), stretch * tall / wide, text)
    scales = colour_scales(views, picture.ranges)
    sizes = diameters(views[0])
    extent = float((high - low).max())
    for panel, time, view, still in zip(panels, instants, views, stills, strict=True):
        panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect=stretch)
        for axis, name in zip((panel.xaxis, panel.yaxis), viewpoint.names, strict=True):
            fit(axis, name, "m", extent)
        panel.set_title(f"t = {with_unit(time, 's')}", fontsize=10)
        panel.locator_params(axis="x", nbins=_ticks(figure, panel))
        draw_walls(panel, still)
        draw_view(panel, view, scales, sizes)
    add_colour_bars(figure, panels, scales, views)
    add_legend(figure, views[0], stills[0])
    return save(figure, out)


def turned_views(
    files: Sequence[Path], instants: Sequence[float], picture: Picture
) -> tuple[Cut, list[list[Shown]]]:
    """Read what all components show at some times, turned, cut, and sorted by depth."""
    fields = dict(name.split(".", 1) for name in picture.colours)
    turn = picture.viewpoint.turned_view
    whole = [
        [turn(read(path, time, fields, picture.displacement_scale)) for path in files]
        for time in instants
    ]
    cut = _cut(picture, whole)
    between = cut.near, cut.far
    views = [[cut_and_sorted(shown, between, cut.keeps_bodies) for shown in v] for v in whole]
    return cut, views


def _cut(picture: Picture, views: Sequence[Sequence[Shown]]) -> Cut:
    """Choose what is left out of turned views."""
    viewpoint = picture.viewpoint
    axis, infinite = viewpoint.looks_along, float("inf")
    if picture.region is not None:
        low, high = viewpoint.turned_box(picture.region)
        ends = (picture.region[k][viewpoint.depth] for k in (0, 1))
        text = "a part of the scene, with particles from {} = {:g} to {:g} m".format(axis, *ends)
        if picture.section is None:
            return Cut(low[1], high[1], text)
        return Cut(viewpoint.ahead * picture.section, high[1], text)
    if picture.section is not None:
        text = f"cut open at {axis} = {picture.section:g} m"
        return Cut(viewpoint.ahead * picture.section, infinite, text)
    depths = [depth for view in views if (depth := depth_of_bodies(view)) is not None]
    if not depths:
        return Cut(-infinite, infinite, "")
    depth = min(depths)  # one for all panels
    text = f"particles in front of {axis} = {viewpoint.ahead * depth:.3g} m left out"
    return Cut(depth, infinite, text, keeps_bodies=True)


def add_colour_bars(
    figure: Any, panels: Sequence[Any], scales: Mapping[Any, Any], views: Sequence[Sequence[Shown]]
) -> None:
    """Say beside the panels what colours stand for."""
    for quantity, scale in scales.items():
        bar = figure.colorbar(
            scale, ax=panels, label=bar_label(scale, views, quantity),
            extend=clipped_ends(scale, views, quantity), shrink=0.8, aspect=30, pad=0.02,
        )  # fmt: skip
        bar.formatter.set_powerlimits((-3, 4))


def _said(picture: Picture, cut: Cut, stretch: float) -> str:
    """Where one looks from, what is cut off, and what is not drawn to scale."""
    viewpoint = picture.viewpoint
    against = "" if viewpoint.ahead > 0.0 else "against "
    remarks = [f"{viewpoint.name} view {against or 'along '}{viewpoint.looks_along}"]
    remarks += [cut.text] if cut.text else []
    if picture.displacement_scale != 1.0:
        remarks.append(f"displacements drawn {picture.displacement_scale:g} times as large")
    if stretch > 1.0:
        across, upwards = viewpoint.names
        remarks.append(f"{upwards} drawn {stretch:.2g} times as long as {across}")
    return ", ".join(remarks)


def _ticks(figure: Any, panel: Any) -> int:
    """Numbers that have room along the horizontal axis of a panel."""
    return max(2, int(1.2 * figure.get_figwidth() / panel.get_subplotspec().get_gridspec().ncols))


def limits(
    views: Sequence[Sequence[Shown]], still: Sequence[Still], region: tuple[Array, Array] | None
) -> tuple[Array, Array]:
    """Lowest and highest corner (2,) m, right and up, of all panels: what moves, and walls."""
    if region is not None:
        return region[0][[0, 2]], region[1][[0, 2]]
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
    """Points (n, 2) m, right and up, between which all of a component lies."""
    centre, radius = shown.points[:, [0, 2]], shown.radius[:, None]
    corners = [face[:, [0, 2]] for face in shown.faces]
    ends = np.concatenate([np.zeros((0, 2)), centre - radius, centre + radius, *corners])
    return np.asarray(ends[np.isfinite(ends).all(axis=1)])
