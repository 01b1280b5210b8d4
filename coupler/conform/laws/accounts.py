"""Laws of what a component tells of itself for the ledger, the plan and pictures."""

from typing import Any

import numpy as np

from quintet.coupler.conform.trial import Trial
from quintet.coupler.conform.verdict import DoesNotApply, require
from quintet.interfaces.errors import SceneError

ROUNDING = 1e-11  # of the momentum that goes to and fro


def it_counts_what_it_advances_and_what_it_holds(trial: Trial) -> None:
    """At least one item; mass and kinetic energy of zero or more; all finite."""
    component = trial.build()
    trial.move(component)
    items, totals = component.items(), component.totals()
    require(items >= 1, f"items: it must advance 1 or more; found {items}. Count them.")
    numbers: dict[str, Any] = {
        "mass": totals.mass,
        "kinetic": totals.kinetic,
        "potential": totals.potential,
        "internal": totals.internal,
        "work": totals.work,
        "dissipated": totals.dissipated or 0.0,
        "momentum": totals.momentum,
        "angular_momentum": totals.angular_momentum,
    }
    for name, value in numbers.items():
        require(
            bool(np.isfinite(value).all()),
            f"totals: all must be finite; {name} is {value}. Correct it.",
        )
        require(
            np.shape(value) == ((3,) if "momentum" in name else ()),
            f"totals: {name} must be {'(3,)' if 'momentum' in name else 'one number'}; found shape "
            f"{np.shape(value)}. Correct it.",
        )
    if totals.mass_balance:
        masses = [float(mass) for mass in totals.mass_balance.values()]
        scale = sum(map(abs, masses))
        require(
            abs(sum(masses) - totals.mass) <= ROUNDING * scale,
            f"totals: mass_balance must add up to the mass, {totals.mass:g} kg; found "
            f"{sum(masses):g} kg. Count all that came and left.",
        )
    for name in ("mass", "kinetic"):
        value = float(numbers[name])
        require(value >= 0.0, f"totals: {name} must be 0 or more; found {value:g}. Correct it.")


def momentum_changes_by_the_impulses(trial: Trial) -> None:
    """By those taken, less those given to partners, to rounding, where nothing else acts."""
    forces = trial.case.forces
    if not forces:
        raise DoesNotApply("its case names no forces that alone change its momentum")
    known = trial.inputs_known | trial.outputs
    wrong = [key for key in forces if key not in known or known[key].centring != "impulse"]
    if wrong:
        raise SceneError(f"forces: each must be an impulse of a port; found {wrong}. Correct it.")
    component = trial.build()
    for number in range(1, 6):
        before, inputs = component.totals().momentum.copy(), trial.inputs(number)
        component.take(inputs)
        component.step(trial.case.dt)
        own_forces = [key for key in forces if key in trial.outputs]
        outputs = component.give(frozenset(own_forces))
        parts = [inputs[key] for key in forces if key in inputs] + [
            -outputs[key] for key in own_forces
        ]
        expected = trial.case.dt * sum((part.sum(axis=0) for part in parts), np.zeros(3))
        change = component.totals().momentum - before
        sizes = [trial.case.dt * float(np.abs(part).sum()) for part in parts]
        size = max(sum(sizes), float(np.abs(before).max()), 1e-300)
        off = float(np.abs(change - expected).max())
        require(
            off <= ROUNDING * size,
            f"totals: momentum must change by the impulses of {', '.join(forces)}, "
            f"{expected} kg m/s in step {number}; it changed by {change}. Give each force as the "
            "mean over the step, and count what it does.",
        )


def views_are_pictures(trial: Trial) -> None:
    """Points in space; cells that name some of them; of every other field a row for each point."""
    component = trial.build()
    for _ in range(2):  # at the start too
        shown = dict(component.view())
        if not shown:
            raise DoesNotApply("it shows nothing")
        points = shown.pop("points", None)
        require(
            points is not None and points.ndim == 2 and points.shape[1] == 3,
            f"view: points (n, 3) must be there; found {None if points is None else points.shape}. "
            "Give them, in m.",
        )
        assert points is not None
        cells = shown.pop("cells", None)
        if cells is not None:
            require(
                cells.ndim == 2
                and cells.shape[1] >= 3
                and cells.min(initial=0) >= -1
                and cells.max(initial=-1) < len(points),
                f"view: cells must be (m, 3 or more) numbers of points; found {cells.shape} up to "
                f"{cells.max(initial=-1)} of {len(points)} points. Correct them.",
            )
        for key, array in shown.items():
            require(
                len(array) in (len(points), len(cells) if cells is not None else -1),
                f"view: {key} must have a row for each of {len(points)} points; found {len(array)}."
                " Correct it.",
            )
        trial.move(component, 1)
