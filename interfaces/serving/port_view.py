"""What there is to see of a component: its own view, or the items of a port with positions."""

import numpy as np

from quintet.interfaces.component import Array, Component, Field, Fields, Port
from quintet.interfaces.errors import StepError
from quintet.interfaces.faces import CORNERS, FACES, stacked
from quintet.interfaces.ports import BOX, DISC, MESH, POLYGON, POSITION, SPHERE
from quintet.interfaces.rotation import matrix

RADIUS = Field("radius", (), "m")
MESH_CORNER = next(one for one in MESH if one.name == "corner")


def look_at(component: Component) -> tuple[Fields, dict[str, str]]:
    """View of a component, and the units of its fields."""
    shown, told = component.view(), component.shows
    if not shown and (port := shown_port(component.gives)):
        told = port_fields(component.gives)
        keys = {f"{port.name}.{one.name}" for one in port.fields if one.centring == "instant"}
        try:
            shown = port_view(port, component.give(frozenset(keys)), component.describe())
        except StepError:  # a recording between two of its rows: not shown at this time
            shown = {}
    return shown, {one.name: one.unit for one in told if one.name in shown}


def shown_port(gives: tuple[Port, ...]) -> Port | None:
    """First port whose own items have a position."""
    for port in gives:
        for one in port.fields:
            if (one.name, one.shape, one.unit) == (POSITION.name, POSITION.shape, POSITION.unit):
                if port.items == "own" and one.centring == "instant":
                    return port
    return None


def port_fields(gives: tuple[Port, ...]) -> tuple[Field, ...]:
    """Fields of the view of a component that gives these ports."""
    port = shown_port(gives)
    if port is None:
        return ()
    plain = (one for one in port.fields if one.kind == "value" and one.centring == "instant")
    fields = tuple(one for one in plain if one.name != POSITION.name)
    return (*fields, RADIUS) if _has(port, "shape") else fields


def _has(port: Port, static: str) -> bool:
    return any(one.name == static for one in port.static)


def port_view(port: Port, given: Fields, static: Fields) -> Fields:
    """Bodies, faces or points of a port, from its fields and what its component described."""
    now, told = _of_port(port, given), _of_port(port, static)
    fields = [one.name for one in port_fields((port,)) if one.name in now]
    if "shape" in told and "size" in told:
        return _bodies(now, told, fields)
    view = {"points": now["position"], **{name: now[name] for name in fields}}
    if MESH_CORNER in port.static and "corner" in told:
        view["cells"] = np.asarray(told["corner"], np.int64)
    return view


def _of_port(port: Port, fields: Fields) -> Fields:
    """Fields of a port, by their names in it."""
    keys = [key for key in fields if key.startswith(f"{port.name}.")]
    return {key.partition(".")[2]: fields[key] for key in keys}


def _bodies(now: Fields, told: Fields, fields: list[str]) -> Fields:
    """Corners and faces of boxes and polygons, centres and radii of spheres and discs."""
    shape, size, centre = told["shape"].astype(int), told["size"], now["position"]
    axes = np.tile(np.eye(3), (len(shape), 1, 1))
    if "orientation" in now:
        axes = matrix(now["orientation"])
    round_ones = np.flatnonzero(np.isin(shape, (SPHERE, DISC)))
    plain = np.flatnonzero(~np.isin(shape, (SPHERE, DISC, BOX, POLYGON)))
    loose = np.concatenate([round_ones, plain])
    owners, arms = [loose], [np.zeros((len(loose), 3))]  # body of each point; m, in its frame
    cells, count = [], len(loose)
    for k in np.flatnonzero(np.isin(shape, (BOX, POLYGON))).tolist():
        corners = 0.5 * size[k] * CORNERS if shape[k] == BOX else _polygon(told, k)
        cells.append(count + (FACES if shape[k] == BOX else np.arange(len(corners))[None]))
        owners.append(np.full(len(corners), k))
        arms.append(corners)
        count += len(corners)
    owner = np.concatenate(owners)
    arm = np.einsum("nij,nj->ni", axes[owner], np.concatenate(arms))
    view: dict[str, Array] = {"points": centre[owner] + arm}
    view |= {name: now[name][owner] for name in fields}
    if "velocity" in view and "angular_velocity" in now:
        view["velocity"] = view["velocity"] + np.cross(now["angular_velocity"][owner], arm)
    radius = np.zeros(count)
    radius[: len(round_ones)] = 0.5 * size[round_ones, 0]
    view["radius"] = radius
    return view | ({"cells": stacked(cells)} if cells else {})


def _polygon(told: Fields, k: int) -> Array:
    first = int(told["corners"][:k].sum())
    return np.asarray(told["corner"][first : first + int(told["corners"][k])])
