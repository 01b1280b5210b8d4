"""Totals, and whether steps resolve how a body warms: any step is stable, but not right.

A part of length L and diffusivity a = k/(ρ c) comes to its steady temperature as exp(-t π² a/L²)
(Carslaw & Jaeger 1959, section 3.3). A step longer than L²/(π² a) that changes temperatures by
more than half of all that they have changed by passes over the transient.
"""

import numpy as np

from quintet.components.fe_plate.heat.params import FeHeatParams
from quintet.components.fe_plate.heat.state import Model, State
from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.interfaces.component import Totals

MOST = 0.5  # of the largest change of temperature so far, in one step


def transient_times(params: FeHeatParams, model: Model) -> Array:
    """L²/(π² a) [s] of each part (p,), with its longest extent; inf where all is steady."""
    if params.steady:
        return np.full(len(params.parts), np.inf)
    times = []
    for number, part in enumerate(params.parts):
        node = model.mesh.node[model.part == number]
        length = float(np.ptp(node, axis=0).max())
        times.append(length**2 * part.capacity / (np.pi**2 * part.conductivity))
    return np.array(times)


def note(
    judged: Array, start: Array, before: Array, now: Array, dt: float, part: Whole, times: Array
) -> None:
    """Take down the longest step, over the time of its part's transient, that passes over it.

    Parameters
    ----------
    judged : (p, 2) K, 1: largest change of temperature so far; longest such step
    start, before, now : (n,) K, temperatures at the start, before the step and after it
    dt : float, s
    part : (n,) whole numbers
    times : (p,) s
    """
    for number, time in enumerate(times):
        rows = part == number
        changed = float(np.abs(now[rows] - before[rows]).max())
        judged[number, 0] = max(judged[number, 0], float(np.abs(now[rows] - start[rows]).max()))
        if dt > time and changed > MOST * judged[number, 0] > 0.0:
            judged[number, 1] = max(judged[number, 1], dt / time)


def warnings(judged: Array, times: Array) -> dict[str, str]:
    """Reasons why the results may be wrong, by subject."""
    worst = int(np.argmax(judged[:, 1]))
    if not judged[worst, 1] > 0.0:
        return {}
    return {
        "transient": f"parts.{worst}: a step must be shorter than the {times[worst]:.3g} s in "
        f"which heat crosses the part, to resolve its transient; found {judged[worst, 1]:.3g} "
        "times that. Shorten the window or longest_step, or set steady = true if its end alone "
        "counts."
    }


def totals(params: FeHeatParams, model: Model, state: State) -> Totals:
    """Mass, heat above 0 K, and heat of sources and held nodes; steady parts store none."""
    parts = np.bincount(model.part, model.volume)  # m3
    mass = float(parts @ [part.density or 0.0 for part in params.parts])
    stored = 0.0 if params.steady else float(model.capacity @ state.temperature)
    return Totals(mass=mass, internal=stored, work=float(state.outside[0]), dissipated=0.0)
