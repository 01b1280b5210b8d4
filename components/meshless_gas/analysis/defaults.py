"""Errors of a scene's gas with all keys of its numerics left at their defaults, beside its own.

    python -m quintet.components.meshless_gas.analysis.defaults SCENE.toml[:PRESET] ...

Neighbours, limiter, order, Courant number, weights and the way of derivatives are left out of each
scene; nodes of a box are moved at random by several amounts. An error is what an expectation's
field, read at the end, differs from the expected value by.
"""

import argparse
import copy
import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.shared.scene_limits import put
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

Table = dict[str, Any]
JITTERS = (0.0, 0.3, 0.6, 0.9)
FIELDS = ("error.density", "error.pressure", "fronts.", "probes.", "body.")  # of accuracy
NUMERICS = ("neighbours", "limiter", "limiter_threshold", "order", "courant")
OF_BOX, OF_LAYERS = ("jitter", "weight"), ("line_stencils", "jitter", "weight")


class Error(NamedTuple):
    """What an expectation finds."""

    size: float  # difference from the expected value, in the unit of the expectation
    within: float  # what the scene allows


def scene_of(path: Path, preset: str = "", settings: Mapping[str, Any] | None = None) -> Table:
    """Read a scene file with a preset and settings by dotted paths."""
    scene = tomllib.loads(path.read_text())
    chosen: Table = scene["presets"][preset] if preset else {}
    for place, value in {**chosen, **(settings or {})}.items():
        if place != "study":
            put(scene, place, value)
    return scene


def gas_table(scene: Table) -> Table:
    """Table of a scene's gas."""
    (table,) = (
        component
        for component in scene["components"].values()
        if component["kind"] == "meshless_gas"
    )
    return dict(table)


def without_numerics(scene: Table, jitter: float) -> Table:
    """Leave the keys of the numerics out of a scene; move nodes of a box by a jitter [1]."""
    scene = copy.deepcopy(scene)
    table = gas_table(scene)
    for key in NUMERICS:
        table.pop(key, None)
    for cloud, keys in (("box", OF_BOX), ("sphere", ()), ("plate", ())):
        for key in keys:
            table.get(cloud, {}).pop(key, None)
        for key in OF_LAYERS:
            table.get(cloud, {}).get("layers", {}).pop(key, None)
    if "box" in table:
        table["box"]["jitter"] = jitter
    return {**scene, "components": {"gas": table}}


def errors_of(scene: Table) -> dict[str, Error]:
    """Run the gas of a scene to its end; return the errors of its expectations by their names."""
    table = {
        key: value for key, value in gas_table(scene).items() if key not in ("kind", "threads")
    }
    params, mistakes = read(MeshlessGasParams, table, "gas")
    if mistakes:
        raise SceneError(mistakes[0])
    gas, end = MeshlessGas(params), float(scene["end"])
    while gas.state.time < end * (1.0 - 1e-12) and np.isfinite(dt := gas.stable_dt()):
        gas.step(min(dt, end - gas.state.time))
    judged = [
        expectation for expectation in scene["expect"] if expectation["field"].startswith(FIELDS)
    ]
    return {expectation["name"]: _error(gas, expectation) for expectation in judged}


def _error(gas: MeshlessGas, expectation: Table) -> Error:
    key = expectation["field"]
    rows = np.asarray(gas.give(frozenset({key}))[key])
    item = expectation.get("item", 0)
    row = rows.mean(axis=0) if item == "mean" else rows[item]
    value = float(np.ravel(row)[expectation.get("axis", 0)])
    value = value * expectation.get("scale", 1.0) + expectation.get("offset", 0.0)
    return Error(abs(value - expectation["value"]), expectation["within"])


def main() -> None:
    """Print errors as the scenes are, and with the numerics left out."""
    says = argparse.ArgumentParser(description=__doc__)
    says.add_argument("scenes", nargs="+", metavar="SCENE.toml[:PRESET]")
    says.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    words = says.parse_args()
    settings = {
        key: json.loads(value) for key, _, value in (word.partition("=") for word in words.set)
    }
    print(
        "| scene | error of | as shipped | "
        + " | ".join(f"{jitter:g}" for jitter in JITTERS)
        + " |"
    )
    print("|" + "---|" * (3 + len(JITTERS)))
    for word in words.scenes:
        path, _, preset = word.partition(":")
        scene = scene_of(Path(path), preset, settings)
        shipped = errors_of(scene)
        jitters = JITTERS if "box" in gas_table(scene) else JITTERS[:1]
        jitter = [errors_of(without_numerics(scene, jitter)) for jitter in jitters]
        for name, error in shipped.items():
            cells = " | ".join(f"{errors[name].size:.3g}" for errors in jitter)
            print(f"| {scene['name']} {preset} | {name} | {error.size:.3g} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
