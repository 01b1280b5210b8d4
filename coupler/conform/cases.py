"""Where the case comes from on which a component is tried: its kind, a file, or a scene."""

import dataclasses
import math
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from quintet.coupler.conform.trial import Trial
from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.scene.read import load
from quintet.coupler.scene.scene import ComponentPlan, Scene
from quintet.interfaces.component import Array, Component, Fields, Resources, fields_of, make
from quintet.interfaces.errors import QuintetError, SceneError
from quintet.interfaces.manifest import ConformCase, Manifest
from quintet.interfaces.params import unknown

OWN_TABLE = "conform"  # of a file with parameters: what else the case says
DT = 1e-3  # s, of a component that allows any step


@contextmanager
def trials(
    manifest: Manifest, cases: tuple[ConformCase, ...], folder: Path | None
) -> Iterator[list[Trial]]:
    """Make the cases ready, each with a folder of its own unless one is given."""
    with TemporaryDirectory(prefix="quintet-conform-") as temporary:
        all_trials = []
        for number, case in enumerate(cases):
            place = folder or Path(temporary) / str(number)
            place.mkdir(exist_ok=True)
            all_trials.append(Trial(manifest, case, place))
        yield all_trials


def of_kind(manifest: Manifest, name: str = "") -> tuple[ConformCase, ...]:
    """Cases that a kind publishes, or the one that is named."""
    cases = manifest.conform_cases()
    if not cases:
        raise SceneError(
            f"conform {manifest.kind}: it publishes no case. Give its parameters with --params "
            "FILE.toml, name a scene that has it with --scene SCENE --component NAME, or give its "
            "class a static method conform_cases that returns ConformCase of "
            "quintet.interfaces.manifest."
        )
    chosen = tuple(case for case in cases if name in ("", case.name))
    if not chosen:
        known = [case.name for case in cases]
        raise SceneError(unknown(f"conform {manifest.kind}: case {name}", name, known))
    return chosen


def of_file(path: Path) -> ConformCase:
    """Parameters of a TOML file, as a scene's table has them; the rest is its table ``conform``.

    That table has the keys of `ConformCase`, fields as tables: ``rest."load.force" = [[0, 0, 0]]``.
    """
    try:
        with open(path, "rb") as file:
            table = tomllib.load(file)
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SceneError(f"{path}: parameters must be valid TOML: {error}.") from error
    table.pop("kind", None)  # as in a scene
    settings = table.pop(OWN_TABLE, {})
    fields = {field.name: field for field in dataclasses.fields(ConformCase)}
    known = fields.keys() - {"name", "params"}
    if not isinstance(settings, dict):
        raise SceneError(f"{path}: {OWN_TABLE} must be a table; found {settings!r}.")
    wrong = [unknown(f"{path}: {OWN_TABLE}.{key}", key, known) for key in settings.keys() - known]
    if wrong:
        raise SceneError(wrong)
    values = {
        key: _read(f"{path}: {OWN_TABLE}.{key}", key, value) for key, value in settings.items()
    }
    return ConformCase(path.name, table, **values)


def _read(where: str, key: str, value: Any) -> Any:
    """One key of the table, in the type that `ConformCase` has for it."""
    default = getattr(ConformCase("", {}), key)
    kinds = {dict: "a table", tuple: "a list", bool: "true or false", float: "a number"}
    kind = {list: tuple, int: float}.get(type(value), type(value))
    if kind is not type(default):
        raise SceneError(f"{where} must be {kinds[type(default)]}; found {value!r}. Correct it.")
    try:
        if key in ("static", "rest"):
            return {name: np.asarray(array, dtype=np.float64) for name, array in value.items()}
        if key == "activity":
            return {name: tuple(ports) for name, ports in value.items()}
        return tuple(value) if kind is tuple else kind(value)
    except (TypeError, ValueError) as error:
        raise SceneError(f"{where}: {error}. Correct it.") from error


def of_scene(
    name: str, component: str, preset: str, settings: list[str]
) -> tuple[Manifest, ConformCase, Path]:
    """Parameters of a scene's component, and what its partners tell it as the run begins.

    The partners are made, to be asked, but not stepped. What comes in at the start is what the
    case has as rest, though it need not be at rest.
    """
    scene = load(name, preset, settings)
    if component not in scene.components:
        where = f"conform: component {component} of scene {scene.file.name}"
        raise SceneError(unknown(where, component, scene.components))
    plan = scene.components[component]
    participants = {other: _make(plan, scene) for other, plan in scene.components.items()}
    exchange = scene.exchange()
    described = {key: dict(each.describe()) for key, each in participants.items()}
    static = exchange.bind(described, lambda name, request: participants[name].sample(request))
    for key, each in participants.items():
        each.bind(static[key], frozenset(exchange.joined(key)))
    rest = _at_the_start(exchange, component, participants)
    case = ConformCase(
        f"{component} of {scene.file.name}",
        plan.params,
        static=static[component],
        rest=rest,
        dt=_some_step(participants[component]),
        still=False,
    )
    return plan.manifest, case, scene.folder


def _make(plan: ComponentPlan, scene: Scene) -> Component:
    try:
        return make(plan.manifest.load(), plan.checked, Resources(folder=scene.folder.resolve()))
    except QuintetError as error:
        raise SceneError(f"conform: component {plan.name}: {error}") from error


def _at_the_start(
    exchange: Exchange, component: str, participants: dict[str, Component]
) -> dict[str, Array]:
    """Instants that a component gets as a run begins; impulses are zero then."""
    outputs: dict[str, Fields] = {
        name: dict(participant.give(frozenset(fields_of(participant.gives))))
        for name, participant in participants.items()
    }
    exchange.count_rows(outputs)
    numbers = [n for n, transfer in enumerate(exchange.transfers) if transfer.taker == component]
    merged = exchange.merge(
        component, [(exchange.deliver(n, outputs, outputs), False) for n in numbers]
    )
    return {
        key: np.zeros_like(array) if exchange.is_impulse(component, key) else np.array(array)
        for key, array in merged.fields.items()
    }


def _some_step(component: Component) -> float:
    """Half of what is stable, so that it is still so when it has moved a little [s]."""
    stable = float(component.stable_dt())
    return 0.5 * stable if math.isfinite(stable) and stable > 0.0 else DT
