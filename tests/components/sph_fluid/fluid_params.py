"""Parameters of small fluids, and passes over their pairs."""

import json
from typing import Any

import numpy as np
from pydantic import TypeAdapter

from quintet.components.shared.search.neighbours import Lists
from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.kernels import BoundaryRows, Particles, Rates, pair_rates
from quintet.components.sph_fluid.laws import PairLaw

ORIGIN = (0.0, 0.0, 0.0)


def nested(settings: dict[str, Any]) -> dict[str, Any]:
    """Tables of settings by dotted names, as presets write them; `__` is a dot in a keyword."""
    table: dict[str, Any] = {}
    for name, value in settings.items():
        *parents, key = name.replace("__", ".").split(".")
        subtable = table
        for parent in parents:
            subtable = subtable.setdefault(parent, {})
        subtable[key] = value
    boundary = table.get("boundary", {})
    for section, name in ((table, "fluid"), (boundary, "obstacles")):
        if name in section:
            section[name] = [box(value) for value in section[name]]
    if boundary.get("walls") is not None:
        boundary["walls"] = box(boundary["walls"])
    return table


def box(corners: Any) -> Any:
    """Table of a box from its lowest and highest corner; other tables as they are."""
    if isinstance(corners, dict):
        return corners
    return {"shape": "box", "lowest": list(corners[0]), "highest": list(corners[1])}


def fluid_params(**settings: Any) -> SphFluidParams:
    """Check settings by dotted names; walls are dynamic particles unless they say otherwise."""
    table = nested(settings)
    table.setdefault("boundary", {}).setdefault("method", "dbc")
    text = json.dumps(table)
    params: SphFluidParams = TypeAdapter(SphFluidParams).validate_json(text)
    return params


def pair_sums(
    law: PairLaw, position: np.ndarray, velocity: np.ndarray, lists: Lists, fluid: int,
    gravity: tuple[float, float, float] = ORIGIN,
) -> np.ndarray:  # fmt: skip
    """Accelerations and rates of density (n, 4) of the first rows, which are fluid."""
    empty = np.zeros(0)
    rates = Rates(np.zeros_like(position), np.zeros((0, 3)), empty)
    boundary = BoundaryRows(np.zeros((0, 4)), empty, empty)
    particles = Particles(position, velocity)
    pair_rates(0, fluid, fluid, particles, boundary, lists, law, gravity, rates)
    return rates.rate
