"""A picture of what a run shows at one time, seen along all three axes."""

import textwrap
from pathlib import Path

from quintet.coupler.report.axes_units import fit
from quintet.coupler.report.panels import place_panels, save
from quintet.coupler.report.picture import Picture, add_colour_bars, limits, turned_views
from quintet.coupler.report.view_drawing import (
    add_legend,
    colour_scales,
    diameters,
    draw_view,
    draw_walls,
)
from quintet.coupler.report.view_steps import view_files, walls
from quintet.coupler.report.viewpoint import VIEWPOINTS

LETTERS = 24  # of a line of a title: the front view of a long tank is narrow


def draw_three_views(run: Path, out: Path, colours: tuple[str, ...] = (), title: str = "") -> Path:
    """Draw the first step of a run from the side, from the front and from above; return `out`.

    Parameters
    ----------
    run : Path
        Folder with view files.
    out : Path
        The picture; its ending chooses the format.
    colours : sequence of str
        ``component.field``, what components are coloured by.
    title : str
        Above all panels.
    """
    files, still = view_files(run), walls(run)
    drawn = []
    for viewpoint in VIEWPOINTS.values():
        cut, (view,) = turned_views(files, [0.0], Picture([0.0], colours, viewpoint=viewpoint))
        around = [viewpoint.turned_wall(wall) for wall in still]
        drawn.append((viewpoint, view, around, limits([view], around, None), cut.text))
    extents = [high - low for _, _, _, (low, high), _ in drawn]
    heights = [float(tall / wide) for wide, tall in extents]
    scales = colour_scales([view for _, view, *_ in drawn], {})
    figure, panels = place_panels(len(drawn), sorted(heights)[1], title)
    for panel, (viewpoint, view, around, (low, high), text) in zip(panels, drawn, strict=True):
        panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect=1.0)
        for axis, name in zip((panel.xaxis, panel.yaxis), viewpoint.names, strict=True):
            fit(axis, name, "m", float((high - low).max()))
        lines = [f"{viewpoint.name} view", *textwrap.wrap(text, LETTERS)]
        panel.set_title("\n".join(lines), fontsize=10)
        panel.locator_params(axis="x", nbins=4)
        draw_walls(panel, around)
        draw_view(panel, view, scales, diameters(view))
    add_colour_bars(figure, panels, scales, [view for _, view, *_ in drawn])
    add_legend(figure, drawn[0][1], drawn[0][2])
    return save(figure, out)
