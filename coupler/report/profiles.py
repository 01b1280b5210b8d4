"""Fields beside their exact solution, along the longest axis of what has them.

A view that has a field ``density`` and another, ``exact_density``, is drawn so.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.report.axes_units import fit, with_unit
from quintet.coupler.report.views import Views, ViewStep
from quintet.interfaces.component import Array

EXACT = "exact_"  # begins the name of an exact field


@dataclass(frozen=True)
class Profile:
    """Values of one field of a component along an axis, and the exact ones, at one time.

    Attributes
    ----------
    component, field, unit : str
    axis : int
        0, 1 or 2.
    time : float, s
    places : (n,) float array, m
        In rising order.
    values, exact : (n,) float arrays
        Of vectors their component along the axis.
    """

    component: str
    field: str
    unit: str
    axis: int
    time: float
    places: Array
    values: Array
    exact: Array


def profiles_of(folder: Path) -> list[Profile]:
    """Profiles of all components of a run that show an exact solution, at their last step."""
    views = Views(folder)
    steps = {name: view[-1] for name, view in views.items() if _exact_fields(view.units)}
    return [
        _profile(name, field, step) for name, step in steps.items() for field in _exact_fields(step)
    ]


def _exact_fields(names: Any) -> list[str]:
    return [name for name in names if EXACT + name in names]


def _profile(component: str, field: str, step: ViewStep) -> Profile:
    axis = int(np.ptp(step["points"], axis=0).argmax())
    order = np.argsort(step["points"][:, axis], kind="stable")
    values, exact = (
        (array if array.ndim == 1 else array[:, axis])[order]
        for array in (step[field], step[EXACT + field])
    )
    places, unit = step["points"][order, axis], step.units.get(field, "")
    return Profile(component, field, unit, axis, step.time, places, values, exact)


def draw_profiles(panels: Sequence[Any], profiles: Sequence[Profile]) -> None:
    """Draw each profile into a panel: nodes as dots, the exact solution as a line."""
    for panel, profile in zip(panels, profiles, strict=True):
        panel.plot(profile.places, profile.exact, color="tab:orange", linewidth=1.5, label="exact")
        panel.plot(
            profile.places, profile.values, ".", color="tab:blue", markersize=2.5,
            label="computed", rasterized=True,
        )  # fmt: skip
        name = profile.field.replace("_", " ")
        title = f"{name} of {profile.component} at t = {with_unit(profile.time, 's')}"
        panel.set_title(title, fontsize=9)
        fit(panel.xaxis, "xyz"[profile.axis], "m", float(np.abs(profile.places).max()))
        panel.set_ylabel(f"{name} [{profile.unit}]", fontsize=9)
        panel.grid(alpha=0.3)
        panel.legend(fontsize=8, frameon=False)
