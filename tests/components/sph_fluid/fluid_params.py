"""Parameters of small fluids."""

import json
from typing import Any

from pydantic import TypeAdapter

from quintet.components.sph_fluid import SphFluidParams


def nested(settings: dict[str, Any]) -> dict[str, Any]:
    """Tables of settings by dotted names, as presets write them; `__` is a dot in a keyword."""
    table: dict[str, Any] = {}
    for name, value in settings.items():
        *heads, last = name.replace("__", ".").split(".")
        at = table
        for head in heads:
            at = at.setdefault(head, {})
        at[last] = value
    return table


def fluid_params(**given: Any) -> SphFluidParams:
    """Check settings by dotted names."""
    text = json.dumps(nested(given))
    params: SphFluidParams = TypeAdapter(SphFluidParams).validate_json(text)
    return params
