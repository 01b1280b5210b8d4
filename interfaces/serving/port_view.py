"""What there is to see of a component: its own view, or the items of a port with positions."""

import numpy as np

from quintet.interfaces.component import Component, Field, Fields, Port
from quintet.interfaces.errors import StepError
from quintet.interfaces.ports import MESH, POSITION, RADIUS, RANK

MESH_CORNER = next(field for field in MESH if field.name == "corner")


def look_at(component: Component) -> tuple[Fields, dict[str, str]]:
    """View of a component, and the units of its fields."""
    shown, fields = component.view(), component.shows
    if not shown and (port := shown_port(component.gives)):
        fields = port_fields(component.gives)
        keys = {f"{port.name}.{field.name}" for field in port.fields if field.centring == "instant"}
        try:
            shown = port_view(port, component.give(frozenset(keys)), component.describe())
        except StepError:  # a recording between two of its rows: not shown at this time
            shown = {}
    return shown, {field.name: field.unit for field in (*fields, RANK) if field.name in shown}


def shown_port(gives: tuple[Port, ...]) -> Port | None:
    """First port whose own items have a position."""
    for port in gives:
        for field in port.fields:
            if is_position(field) and port.items == "own" and field.centring == "instant":
                return port
    return None


def is_position(field: Field) -> bool:
    """Whether a field is a position, whatever its rate."""
    known = (POSITION.name, POSITION.shape, POSITION.unit)
    return (field.name, field.shape, field.unit) == known


def port_fields(gives: tuple[Port, ...]) -> tuple[Field, ...]:
    """Fields of the view of a component that gives these ports."""
    port = shown_port(gives)
    if port is None:
        return ()
    plain = (
        field for field in port.fields if field.kind == "value" and field.centring == "instant"
    )
    fields = tuple(field for field in plain if field.name != POSITION.name)
    return (*fields, RADIUS) if RADIUS in port.static else fields


def port_view(port: Port, outputs: Fields, static: Fields) -> Fields:
    """Faces or points of a port, from its fields and what its component described."""
    now, described = _of_port(port, outputs), _of_port(port, static)
    fields = [field.name for field in port_fields((port,)) if field.name in now]
    view = {"points": now["position"], **{name: now[name] for name in fields}}
    if RADIUS.name in described:
        view[RADIUS.name] = described[RADIUS.name]
    if MESH_CORNER in port.static and "corner" in described:
        view["cells"] = np.asarray(described["corner"], np.int64)
    return view


def _of_port(port: Port, fields: Fields) -> Fields:
    """Fields of a port, by their names in it."""
    keys = [key for key in fields if key.startswith(f"{port.name}.")]
    return {key.partition(".")[2]: fields[key] for key in keys}
