"""What stands in a panel of a picture: walls, points, spheres, faces, and their colours.

Matplotlib is loaded by the functions that draw: a run without pictures does not need it.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quintet.coupler.report.field_drawing import draw_field, is_field
from quintet.coupler.report.view_steps import Quantity, Shown, Still, spacing
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.faces import CLAMPED, SYMMETRY
from quintet.interfaces.faces import WALL as WALL_FACE

LIGHT = np.array([-0.4, -0.8, 0.6])  # towards the light; the eye looks along the second axis
PLAIN = ("#ccaa7a", "#8fb0c9", "#b5c98f", "#c99a8f")  # of what no field colours, by component
MAPS = ("viridis", "plasma", "cividis", "inferno")  # of quantities
PHOTOGRAPHS = ("schlieren", "shadowgraph")  # quantities in grey, as on photographs of flows
WALL, BACK = "#444444", "#9aa5ad"  # walls seen from their edge, and from their face
LINES: dict[int, dict[str, Any]] = {  # what stands still, seen from its edge
    WALL_FACE: {"linewidths": 2.0},
    CLAMPED: {"linewidths": 2.0},
    SYMMETRY: {"linewidths": 1.5, "linestyles": "dashdot"},
}
STROKE = 0.015  # of the picture: strokes behind what is clamped
BEHIND = 0.12  # opacity of the shade of walls
CLIPPED = 0.5  # % of all values that may be beyond either end of the colours
ENOUGH = 1000  # values, of which a few may be clipped
OVERLAP = 1.3  # diameter of a particle over the spacing: hardly any white between them
MARK = 0.05  # of the picture: diameter of points of which no size is known
NAMED = 3  # points of a component that have its name beside them
FEW = 3000  # spheres or faces that have an outline


def is_mark(shown: Shown) -> bool:
    """Whether points of a component are few and of no size, so that they are drawn as marks."""
    return bool(len(shown.points)) and not shown.radius.any() and not spacing(shown.points)


def _is_named(shown: Shown) -> bool:
    """Whether a component's name stands beside its points."""
    return is_mark(shown) and len(shown.points) <= NAMED


def colour_scales(
    views: Sequence[Sequence[Shown]], ranges: Mapping[str, tuple[float, float]]
) -> dict[Quantity, Any]:
    """Colours of each quantity, the same in all panels; `ranges` are those of components."""
    # A run without pictures does not load matplotlib.
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    chosen = {shown.quantity: ranges[shown.name] for shown in views[0] if shown.name in ranges}
    scales: dict[Quantity, Any] = {}
    for quantity in dict.fromkeys(shown.quantity for view in views for shown in view):
        values = _values(views, quantity)
        if quantity is None or not len(values):
            continue
        norm = Normalize(*(chosen.get(quantity) or _range(values)))
        colours = "gray" if quantity.name in PHOTOGRAPHS else MAPS[len(scales) % len(MAPS)]
        scales[quantity] = ScalarMappable(norm, colours)
    plain = {shown.name for shown in views[0] if shown.quantity not in scales}
    if useless := [name for name in ranges if name in plain]:
        raise SceneError(
            f"--range {useless[0]}=...: nothing of {useless[0]} has colours that stand for values. "
            f"Choose them by --colour {useless[0]}.FIELD."
        )
    return scales


def _range(values: Array) -> tuple[float, float]:
    """Lowest and highest value of the colours, but for a few values far away."""
    clipped = CLIPPED if len(values) > ENOUGH else 0.0
    low, high = np.percentile(values, [clipped, 100.0 - clipped]).tolist()
    if not high > low:  # nearly all are equal: the few that are not are what is to be seen
        low, high = float(values.min()), float(values.max())
    low = min(low, 0.0) if values.min() >= 0.0 and low < 0.3 * high else low
    if high > low:
        return low, high
    return (high - abs(high), high + abs(high)) if high else (0.0, 1.0)


def _values(views: Sequence[Sequence[Shown]], quantity: Quantity | None) -> Array:
    """All finite values of a quantity."""
    same = [shown for view in views for shown in view if shown.quantity == quantity]
    parts = [part for shown in same for part in (shown.values, shown.face_values)]
    values = np.concatenate([np.zeros(0), *(part for part in parts if part is not None)])
    return np.asarray(values[np.isfinite(values)])


def clipped_ends(scale: Any, views: Sequence[Sequence[Shown]], quantity: Quantity) -> str:
    """Ends of a colour bar beyond which there are values: they have the colour of that end."""
    values = _values(views, quantity)
    ends = bool(values.min() < scale.norm.vmin), bool(values.max() > scale.norm.vmax)
    return {(True, True): "both", (True, False): "min", (False, True): "max"}.get(ends, "neither")


def bar_label(scale: Any, views: Sequence[Sequence[Shown]], quantity: Quantity) -> str:
    """Name and unit of a quantity, and how many of its values are beyond the colours."""
    values = _values(views, quantity)
    beyond = np.mean((values < scale.norm.vmin) | (values > scale.norm.vmax))
    return (
        f"{quantity.label}; {100.0 * beyond:.2g} % of values are beyond"
        if beyond
        else quantity.label
    )


def draw_walls(panel: Any, still: Sequence[Still]) -> None:
    """Draw faces that stand still: those seen from their edge as lines, others as a shade.

    Clamped faces have strokes behind them; planes of symmetry are seen from their edge alone.
    """
    # A run without pictures does not load matplotlib.
    from matplotlib.collections import LineCollection, PolyCollection

    stroke = STROKE * float(np.ptp(panel.get_xlim()))
    lines: dict[int, list[Array]] = {WALL_FACE: [], CLAMPED: [], SYMMETRY: []}
    shaded, strokes = [], []
    for face, support in still:
        flat = face[:, [0, 2]]
        if not _is_flat(flat):
            shaded += [flat] if support != SYMMETRY else []
            continue
        lines[support].append(_ends(flat))
        if support == CLAMPED:
            strokes += _strokes(lines[support][-1], _outwards(face), stroke)
    panel.add_collection(PolyCollection(shaded, facecolors=BACK, alpha=BEHIND, zorder=0), False)
    for support, segments in lines.items():
        if not segments and support != WALL_FACE:
            continue
        drawn = LineCollection(segments, colors=WALL, zorder=4, **LINES[support])
        panel.add_collection(drawn, False)
    if strokes:
        panel.add_collection(LineCollection(strokes, colors=WALL, linewidths=0.8, zorder=4), False)


def _outwards(face: Array) -> Array:
    """Unit normal (2,) in x and z of a face (k, 3) m, to where it is seen from."""
    normal = np.cross(face[1] - face[0], face[2] - face[1])[[0, 2]]
    return np.asarray(normal / np.linalg.norm(normal))


def _strokes(line: Array, outwards: Array, length: float) -> list[Array]:
    """Strokes [m] behind a line (2, 2) m, aslant, as far apart as they are long."""
    along = line[1] - line[0]
    span = float(np.linalg.norm(along))
    along = along / span
    starts = line[0] + np.linspace(0.0, span, 1 + max(1, round(span / length)))[:, None] * along
    aslant = length * (outwards - along) / np.sqrt(2.0)
    return [np.array([start, start + aslant]) for start in starts]


def _is_flat(corners: Array) -> bool:
    """Whether a polygon (k, 2) m is seen from its edge."""
    (x, z), (u, v) = corners.T, np.roll(corners, -1, axis=0).T
    area = 0.5 * abs(float((x * v - z * u).sum()))
    return area < 1e-6 * float(np.ptp(corners, axis=0).max()) ** 2


def _ends(face: Array) -> Array:
    """Both ends (2, 2) m of a face that is seen from its edge."""
    along = face[np.linalg.norm(face - face[0], axis=1).argmax()] - face[0]
    places = (face - face[0]) @ along
    return np.array([face[places.argmin()], face[places.argmax()]])


def diameters(view: Sequence[Shown]) -> dict[str, float]:
    """Diameters [m] of particles, by component; 0 of what are no particles."""
    return {shown.name: OVERLAP * spacing(shown.points) for shown in view}


def draw_view(
    panel: Any,
    view: Sequence[Shown],
    scales: Mapping[Quantity, Any],
    sizes: Mapping[str, float],
) -> None:
    """Draw all components: particles, then spheres, then faces; later ones hide earlier ones."""
    for place, shown in sorted(enumerate(view), key=lambda item: bool(item[1].radius.any())):
        if is_field(shown):
            draw_field(panel, shown, scales)
            continue
        _draw_points(panel, shown, scales, sizes[shown.name], PLAIN[place % len(PLAIN)])
    for place, shown in enumerate(view):
        _draw_faces(panel, shown, scales, PLAIN[place % len(PLAIN)])


def _draw_points(
    panel: Any, shown: Shown, scales: Mapping[Quantity, Any], size: float, plain: str
) -> None:
    # A run without pictures does not load matplotlib.
    from matplotlib.collections import EllipseCollection

    if not len(shown.points):
        return
    edges = np.ptp([panel.get_xlim(), panel.get_ylim()], axis=1)
    across = 2.0 * shown.radius if shown.radius.any() else np.zeros(len(shown.points))
    across = np.where(across > 0.0, across, size or MARK * float(edges.max()))
    outline = 0.25 if (shown.radius.any() or not size) and len(across) <= FEW else 0.0
    circles = EllipseCollection(
        across, across, np.zeros(len(across)), units="xy", offsets=shown.points[:, [0, 2]],
        offset_transform=panel.transData, linewidths=outline, edgecolors="white",
        rasterized=True, zorder=2,
    )  # fmt: skip
    if shown.values is not None and shown.quantity and shown.quantity in scales:
        circles.set_facecolor(scales[shown.quantity].to_rgba(shown.values))
    else:
        circles.set_facecolor(plain)
    panel.add_collection(circles, autolim=False)
    if _is_named(shown):
        for x, _, z in shown.points:
            panel.annotate(shown.name, (x, z), (14, 0), textcoords="offset points", va="center")


def _draw_faces(panel: Any, shown: Shown, scales: Mapping[Quantity, Any], plain: str) -> None:
    # A run without pictures does not load matplotlib.
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_rgb

    if not shown.faces:
        return
    colour = np.tile(to_rgb(plain), (len(shown.faces), 1))
    if shown.face_values is not None and shown.quantity and shown.quantity in scales:
        colour = scales[shown.quantity].to_rgba(shown.face_values)[:, :3]
    shades = colour * np.array([[_shade(face)] for face in shown.faces])
    outline = 0.4 if len(shown.faces) <= FEW else 0.1
    flat = [face[:, [0, 2]] for face in shown.faces]
    faces = PolyCollection(flat, facecolors=shades, edgecolors="black", linewidths=outline)
    faces.set_zorder(3)
    panel.add_collection(faces, autolim=False)


def _shade(corners: Array) -> float:
    """Brightness of a face under diffuse light."""
    return _brightness(np.cross(corners[1] - corners[0], corners[2] - corners[0]))


def _brightness(normal: Array) -> float:
    cosine = abs(float(normal @ LIGHT)) / max(float(np.linalg.norm(normal)), 1e-300)
    return 0.65 + 0.35 * min(cosine / float(np.linalg.norm(LIGHT)), 1.0)


FRONT = _brightness(np.array([0.0, -1.0, 0.0]))  # of faces towards the eye


def add_legend(figure: Any, view: Sequence[Shown], still: Sequence[Still]) -> None:
    """Say below the panels which component is what; points with names beside them need no more."""
    # A run without pictures does not load matplotlib.
    from matplotlib.colors import to_rgb
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Any] = []
    for place, shown in enumerate(view):
        plain, coloured = PLAIN[place % len(PLAIN)], shown.quantity is not None
        if shown.faces:
            front: Any = (FRONT * np.array(to_rgb(plain))).tolist()
            by = ""
            if shown.face_values is not None and shown.quantity:
                front, by = "none", f" (coloured by {shown.quantity.name})"
            handles.append(Patch(facecolor=front, edgecolor="black", label=shown.name + by))
        elif is_field(shown) and shown.quantity:
            by = f"{shown.name}: {shown.quantity.name}"
            handles.append(Patch(facecolor="none", edgecolor="#999999", label=by))
        elif len(shown.points) and not _is_named(shown):
            by = f" (coloured by {shown.quantity.name})" if coloured and shown.quantity else ""
            kind = "spheres" if shown.radius.any() else "particles" if len(shown.points) > 1 else ""
            text = shown.name if kind in ("", shown.name) else f"{shown.name}: {kind}"
            colour = "none" if coloured else plain
            handles.append(
                Line2D([], [], marker="o", linestyle="", markerfacecolor=colour,
                       markeredgecolor="black", label=text + by)
            )  # fmt: skip
    known = {wall.support for wall in still}
    if WALL_FACE in known:
        shaded = any(not _is_flat(wall.corners[:, [0, 2]]) for wall in still)
        if shaded:
            back = (*to_rgb(BACK), BEHIND)
            handles.append(Patch(facecolor=back, edgecolor=WALL, linewidth=2.0, label="walls"))
        else:
            handles.append(Line2D([], [], color=WALL, linewidth=2.0, label="walls"))
    if CLAMPED in known:
        handles.append(Patch(facecolor="none", edgecolor=WALL, hatch="////", label="clamped"))
    edge_on = [wall for wall in still if _is_flat(wall.corners[:, [0, 2]])]
    if any(wall.support == SYMMETRY for wall in edge_on):
        label = "plane of symmetry"
        handles.append(Line2D([], [], color=WALL, linewidth=1.5, linestyle="dashdot", label=label))
    if not handles:
        return
    figure.legend(handles=handles, loc="outside lower center", ncols=6, frameon=False, fontsize=9)
