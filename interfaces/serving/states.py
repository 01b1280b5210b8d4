"""States of a component and of its inputs, as they are saved together."""

import reprlib
from typing import Any

import numpy as np

from quintet.interfaces.component import Fields
from quintet.interfaces.errors import OrderError


def parts_of(state: Fields) -> dict[str, dict[str, Any]]:
    """Return the state of a component, and that of its inputs."""
    parts: dict[str, dict[str, Any]] = {"component": {}, "inputs": {}}
    for name, array in state.items():
        part, _, key = name.partition("/")
        if part not in parts:
            raise OrderError(f"a state has no part {reprlib.repr(part)}.")
        parts[part][key] = array
    return parts


def unlike(state: Fields, others: Fields) -> str:
    """Say in what a state differs from one of a component's own; "" where nothing is seen."""
    for key in sorted(state.keys() | others.keys()):
        if key not in state or key not in others:
            return f"{key} is {'missing' if key in others else 'not known'}"
        if (shape := np.shape(state[key])) != np.shape(others[key]):
            return f"{key} has shape {shape}, not {np.shape(others[key])}"
    return ""
