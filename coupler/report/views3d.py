"""Views of a run in three dimensions, still or moving, drawn off the screen by PyVista.

PyVista is loaded by the functions that draw: it belongs to the extra views3d.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.files.disk import reporting_disk
from quintet.coupler.report.axes_units import with_unit
from quintet.coupler.report.picture import Picture
from quintet.coupler.report.view_drawing import BACK, PLAIN, bar_label, colour_scales
from quintet.coupler.report.view_steps import (
    Quantity,
    Shown,
    Still,
    moments,
    read,
    spacing,
    view_files,
    walls,
)  # fmt: skip
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.libraries import require

STILLS, MOVIES = (".png", ".jpg"), (".gif", ".mp4")
SIZE = 720, 600  # pixels of a panel
COLUMNS = 2  # of panels
FRAMES_PER_SECOND = 12
SAMPLED = 6  # steps from which the colours of an animation are ranged
BLOCK = 16  # pixels, by which both edges of a film must be divisible
OBLIQUE = (0.9, -1.7, 0.8)  # from the middle of the scene towards the eye
ALONG = {"side": (0.0, -1.0, 0.0), "front": (1.0, 0.0, 0.0), "top": (0.0, 0.0, 1.0)}
FLAT = 1e-3  # depth over size of a scene up to which it is a plane, seen along its normal
OF_POINTS = 0.02  # of the scene: diameter of points of which no size is known
THROUGH = 0.15  # opacity of walls
NEAR = 0.3  # of the scene: how far walls beyond it are still looked at
CLOSER = 1.15  # zoom: all is seen, with little around it
BAR = {"position_x": 0.3, "width": 0.55, "color": "black", "n_labels": 4}  # of colours
ROUND = 10  # corners around a sphere
Bounds = tuple[Array, Array]


def draw_3d(run: Path, out: Path, picture: Picture, view: str = "", title: str = "") -> Path:
    """Draw a run in three dimensions at some times, one panel each; return `out`.

    Parameters
    ----------
    run : Path
        Folder of a run; all that its components show is drawn, nothing is cut away.
    out : Path
        The picture, .png or .jpg.
    picture : Picture
        Its times, colours, ranges and displacement scale count.
    view : "", "side", "front" or "top"
        Where one looks from; obliquely from above if not given.
    title : str
        Above the time of the first panel.
    """
    require("pyvista", "a view in three dimensions")
    # Start-up: only this function and the next need it.
    import pyvista

    files, still = _files(run), walls(run)
    times = moments(files, picture.times)
    views = [_read(files, time, picture) for time in times]
    columns = min(COLUMNS, len(times))
    rows = -(-len(times) // columns)
    size = [columns * SIZE[0], rows * SIZE[1]]
    scales, bounds = colour_scales(views, picture.ranges), _bounds(views, still)
    with hidden_warnings():
        plotter = pyvista.Plotter(off_screen=True, shape=(rows, columns), window_size=size)
        for place, (time, shown) in enumerate(zip(times, views, strict=True)):
            plotter.subplot(*divmod(place, columns))
            _fill(plotter, shown, walls(run, time), scales, bounds, views)
            _look(plotter, bounds, view)
            name = f"{title}\n" if title and not place else ""
            plotter.add_text(f"{name}t = {with_unit(time, 's')}", font_size=9, color="black")
        with reporting_disk(out):
            Path(out).parent.mkdir(parents=True, exist_ok=True)
            plotter.screenshot(str(out))
        plotter.close()
    return out


def animate(
    run: Path, out: Path, picture: Picture, view: str = "", title: str = "", every: bool = True
) -> Path:
    """Make a film of a run, a frame for each step of its views; return `out`.

    Parameters
    ----------
    run, picture, view, title
        As of `draw_3d`.
    out : Path
        The film, .gif or .mp4.
    every : bool
        All steps that the run left, in place of the times of the picture.
    """
    require("pyvista", "an animation")
    require("imageio", "an animation")
    if out.suffix.lower() == ".mp4":
        require("imageio_ffmpeg", "an animation in .mp4")
    # Start-up: only this function and the one before need it.
    import pyvista

    files, still = _files(run), walls(run)
    known = np.unique(np.concatenate([vtkhdf_reader.times(path) for path in files])).tolist()
    times = known if every else moments(files, picture.times)
    if len(times) < 2:
        raise SceneError(
            f"run {run}: an animation needs two steps or more; found {len(times)}. Give the scene "
            "output.interval, or name more --times."
        )
    chosen = np.linspace(0, len(times) - 1, min(SAMPLED, len(times))).round().astype(int)
    sample = [_read(files, times[k], picture) for k in chosen]
    scales, bounds = colour_scales(sample, picture.ranges), _bounds(sample, still)
    size = [edge - edge % BLOCK for edge in SIZE]
    with hidden_warnings():
        plotter = pyvista.Plotter(off_screen=True, window_size=size)
        with reporting_disk(out):
            Path(out).parent.mkdir(parents=True, exist_ok=True)
            if out.suffix.lower() == ".gif":
                plotter.open_gif(str(out), fps=FRAMES_PER_SECOND)
            else:
                plotter.open_movie(str(out), framerate=FRAMES_PER_SECOND)
            for time in times:
                plotter.clear()
                shown, around = _read(files, time, picture), walls(run, time)
                _fill(plotter, shown, around, scales, bounds, sample)
                _look(plotter, bounds, view)
                name = f"{title}\n" if title else ""
                plotter.add_text(f"{name}t = {with_unit(time, 's')}", font_size=9, color="black")
                plotter.write_frame()
            plotter.close()
    return out


def _files(run: Path) -> list[Path]:
    if files := view_files(run):
        return files
    raise SceneError(
        f"run {run}: it has no view with steps to draw. Name the folder of a run whose scene has "
        "output.interval or output.pictures."
    )


def _read(files: Sequence[Path], time: float, picture: Picture) -> list[Shown]:
    fields = dict(name.split(".", 1) for name in picture.colours)
    return [read(path, time, fields, picture.displacement_scale) for path in files]


def _bounds(views: Sequence[Sequence[Shown]], still: Sequence[Still]) -> Bounds:
    """Lowest and highest corner (3,) m of all that moves, and of walls that are near."""
    parts: list[Array] = []
    for shown in (shown for view in views for shown in view):
        radius = shown.radius[:, None]
        parts += [shown.points - radius, shown.points + radius, *shown.faces]
    every = np.concatenate([np.zeros((0, 3)), *parts])
    every = every[np.isfinite(every).all(axis=1)]
    if not len(every):
        raise SceneError("a view in three dimensions needs at least one point; no step has any.")
    low, high = every.min(axis=0), every.max(axis=0)
    if still:
        corners = np.concatenate([wall.corners for wall in still])
        rim = NEAR * max(float((high - low).max()), 1e-6)
        low = np.minimum(low, np.maximum(corners.min(axis=0), low - rim))
        high = np.maximum(high, np.minimum(corners.max(axis=0), high + rim))
    return low, high


def _look(plotter: Any, bounds: Bounds, view: str) -> None:
    """Turn the camera so that all of the run fits, from the same place at all times."""
    low, high = bounds
    flat = np.flatnonzero(high - low <= FLAT * float((high - low).max()))
    towards = ALONG[view] if view else OBLIQUE
    if not view and len(flat):
        towards = (ALONG["front"], ALONG["side"], ALONG["top"])[int(flat[0])]
    upwards = (0.0, 1.0, 0.0) if towards == ALONG["top"] else (0.0, 0.0, 1.0)
    plotter.set_background("white")
    plotter.view_vector(towards, viewup=upwards)
    plotter.reset_camera(bounds=np.column_stack(bounds).ravel().tolist())
    plotter.camera.zoom(CLOSER)
    plotter.show_axes()


@contextmanager
def hidden_warnings() -> Iterator[None]:
    """Hide VTK's warning that there is no screen: views are drawn off the screen.

    VTK tells only the largest verbosity of all its outputs. If another one, as a log file, has a
    larger verbosity than the standard error stream, that of the stream becomes VTK's default.
    """
    # Start-up: only views in three dimensions need it.
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    if before <= vtkLogger.VERBOSITY_ERROR:
        yield
        return
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    is_of_stream = vtkLogger.GetCurrentVerbosityCutoff() < before
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before if is_of_stream else vtkLogger.VERBOSITY_INFO)


def _fill(
    plotter: Any, view: Sequence[Shown], still: Sequence[Still], scales: Mapping[Quantity, Any],
    bounds: Bounds, views: Sequence[Sequence[Shown]],
) -> None:  # fmt: skip
    """Add all components and walls to the present panel."""
    size = float((bounds[1] - bounds[0]).max())
    if still:
        mesh = polygons([wall.corners for wall in still])
        plotter.add_mesh(mesh, color=BACK, opacity=THROUGH, show_edges=True, edge_color="#444444")
    for place, shown in enumerate(view):
        colour = PLAIN[place % len(PLAIN)]
        for mesh, values in meshes(shown, OF_POINTS * size):
            style: dict[str, Any] = {"color": colour}
            if values is not None and shown.quantity and shown.quantity in scales:
                scale = scales[shown.quantity]
                label = bar_label(scale, views, shown.quantity)
                style = {
                    "scalars": values, "cmap": scale.cmap.name,
                    "clim": [scale.norm.vmin, scale.norm.vmax],
                    "scalar_bar_args": {"title": label, **BAR},
                }  # fmt: skip
            plotter.add_mesh(mesh, smooth_shading=False, **style)


def meshes(shown: Shown, smallest: float) -> list[tuple[Any, Array | None]]:
    """Meshes of a component, each with the values of its cells or points, or None.

    Parameters
    ----------
    shown : Shown
    smallest : float, m
        Diameter of points of which no size is known.

    Returns
    -------
    list of (pyvista.PolyData, array or None)
    """
    # Start-up: only views in three dimensions need it.
    import pyvista

    parts: list[tuple[Any, Array | None]] = []
    finite = np.isfinite(shown.points).all(axis=1)
    if finite.any():
        usual = spacing(shown.points[finite]) or smallest
        diameter = np.where(shown.radius > 0.0, 2.0 * shown.radius, usual)[finite]
        cloud = pyvista.PolyData(np.asarray(shown.points[finite], np.float32))
        cloud["diameter"] = diameter
        if shown.values is not None:
            cloud["values"] = shown.values[finite]
        ball = pyvista.Sphere(radius=0.5, theta_resolution=ROUND, phi_resolution=ROUND)
        balls = cloud.glyph(orient=False, scale="diameter", factor=1.0, geom=ball)
        parts.append((balls, balls["values"] if shown.values is not None else None))
    if shown.faces:
        parts.append((polygons(shown.faces), shown.face_values))
    return parts


def polygons(corners: Sequence[Array]) -> Any:
    """A mesh of polygons, each given by its corners (k, 3) m."""
    # Start-up: only views in three dimensions need it.
    import pyvista

    counts = [len(face) for face in corners]
    firsts = np.cumsum([0, *counts[:-1]])
    cells = [
        np.r_[count, first : first + count] for count, first in zip(counts, firsts, strict=True)
    ]
    return pyvista.PolyData(np.concatenate(corners), np.concatenate(cells))
