"""Temperatures of a step: steady ones, or those of Alexander's scheme."""

import math
from abc import ABC, abstractmethod

import numpy as np

from quintet.components.fe_plate.heat.diagnostics import note
from quintet.components.fe_plate.heat.kernels import conduct, solve
from quintet.components.fe_plate.heat.state import Model, State
from quintet.components.fe_plate.meshes.arrays import Array
from quintet.interfaces.errors import StepError

# Share of the step that each stage is implicit by (Alexander 1977, theorem 5).
STAGE = 1.0 - 1.0 / math.sqrt(2.0)
MOST = 20_000  # iterations


class Conduction(ABC):
    """Solves for the temperatures at the end of a step.

    Parameters
    ----------
    model : Model
    tolerance : float, 1
        Of the linear systems: residual over right side.
    """

    def __init__(self, model: Model, tolerance: float) -> None:
        self.model, self.tolerance = model, tolerance

    @abstractmethod
    def advance(self, state: State, dt: float, load: Array) -> Array:
        """Step the temperatures [K]; return the mean net heat (n,) W that came to each node."""

    def net_flow(self, temperature: Array, load: Array) -> Array:
        """Heat (n,) W that comes to each node: load, and what others conduct to it."""
        flow = np.empty_like(temperature)
        conduct(self.model.conductance, temperature, flow)
        return flow + load

    def solved(self, shift: Array, load: Array, guess: Array) -> Array:
        """Temperatures (n,) K with K + shift, written over the guess."""
        model = self.model
        iterations, residual = solve(
            model.conductance, shift, model.free, load, guess, self.tolerance, MOST
        )
        if not residual <= self.tolerance:
            raise StepError(
                f"temperatures: {iterations} iterations must bring the residual below "
                f"{self.tolerance:g}; it is {residual:.3g}. Raise the tolerance, or make "
                "elements of more equal shape."
            )
        return guess


class SteadyConduction(Conduction):
    """Temperatures that would be reached in the end."""

    def advance(self, state: State, dt: float, load: Array) -> Array:
        """Solve for the steady temperatures."""
        none = np.zeros_like(load)
        return self.net_flow(self.solved(none, load, state.temperature), load)


class TransientConduction(Conduction):
    """Temperatures after two implicit stages.

    Parameters
    ----------
    model, tolerance
    times : (p,) s
        In which heat crosses each part.
    """

    def __init__(self, model: Model, tolerance: float, times: Array) -> None:
        super().__init__(model, tolerance)
        self.times = times

    def advance(self, state: State, dt: float, load: Array) -> Array:
        """Step by Alexander's scheme, and judge whether the step resolves the transient."""
        before = state.temperature.copy()
        gained = self._stepped(state.temperature, dt, load)
        note(state.judged, state.start, before, state.temperature, dt, self.model.part, self.times)
        return gained

    def _stepped(self, temperature: Array, dt: float, load: Array) -> Array:
        model, before = self.model, temperature.copy()
        shift = model.capacity / (STAGE * dt)
        first = self.net_flow(self.solved(shift, load + shift * before, before.copy()), load)
        carried = load + shift * before + (1.0 - STAGE) / STAGE * first
        second = self.net_flow(self.solved(shift, carried, temperature), load)
        mean = (1.0 - STAGE) * first + STAGE * second
        stored = model.capacity * (temperature - before) / dt
        return self._balanced(temperature, dt, load, np.where(model.free > 0.0, stored, mean))

    def _balanced(self, temperature: Array, dt: float, load: Array, gained: Array) -> Array:
        """Close the balance of each part, which lacks what the tolerance of the solution leaves.

        What holds a part gives the rest; a part that nothing holds is warmed evenly by it.
        """
        model, parts = self.model, len(self.times)
        held = model.free == 0.0
        missing = np.bincount(model.part, load - gained, parts)  # W
        holders = np.bincount(model.part, held, parts)
        gained += np.where(held, missing[model.part] / np.maximum(holders, 1.0)[model.part], 0.0)
        capacity = np.bincount(model.part, model.capacity, parts)  # J/K
        warmed = np.where(holders > 0.0, 0.0, missing * dt / capacity)  # K
        temperature += warmed[model.part]
        return gained
