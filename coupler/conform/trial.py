"""A component on trial: made afresh as often as a law needs it, and moved."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from quintet.interfaces import rotation
from quintet.interfaces.component import (
    Array,
    Component,
    Fields,
    Keys,
    Port,
    Resources,
    fields_of,
    make,
)
from quintet.interfaces.errors import SceneError
from quintet.interfaces.manifest import ConformCase, Manifest
from quintet.interfaces.materials.filling import fill
from quintet.interfaces.materials.library import library
from quintet.interfaces.params import read
from quintet.interfaces.quantities import in_si

STEPS = 3  # that a component is moved before a law looks at it


class Trial:
    """One case of a kind.

    Parameters
    ----------
    manifest : Manifest
    case : ConformCase
    folder : Path
        Where its data files lie, or an empty folder if the case makes them.

    Raises
    ------
    SceneError
        If the kind does not take the parameters of the case.
    """

    def __init__(self, manifest: Manifest, case: ConformCase, folder: Path) -> None:
        self.manifest, self.case, self.folder = manifest, case, folder
        self.read_only = True  # whether inputs come as they do over a line
        table = case.params(folder) if callable(case.params) else case.params
        where = f"conform {manifest.kind}, {case.name}"
        table, mistakes = fill(manifest.params, table, where, library())
        if not mistakes:
            table, mistakes = in_si(manifest.params, table, where)
        if mistakes:
            raise SceneError(mistakes)
        self.params, mistakes = read(manifest.params, table, where, folder)
        if mistakes:
            raise SceneError(mistakes)
        self.takes, self.gives = manifest.ports(self.params)
        self.inputs_known = fields_of(self.takes)
        self.outputs = fields_of(self.gives)
        self._check(where)

    def _check(self, where: str) -> None:
        """Refuse a case whose inputs are not those of the ports."""
        case = self.case
        static = {
            f"{port.name}.{field.name}": field for port in self.takes for field in port.static
        }
        known = self.inputs_known | static
        arrays = {**case.rest, **case.static}
        wrong = ({*case.rest, *case.scale} - self.inputs_known.keys()) | (
            case.static.keys() - static
        )
        if wrong:
            raise SceneError(
                f"{where}: its inputs must be fields of the ports that it takes "
                f"({', '.join(known) or 'none'}); found {', '.join(sorted(wrong))}. Correct the "
                "case."
            )
        for key, array in arrays.items():
            if np.shape(array)[1:] != known[key].shape or not np.ndim(array):
                shape = ", ".join(["n", *map(str, known[key].shape)])
                raise SceneError(
                    f"{where}: {key} must have shape ({shape}); found {np.shape(array)}. Correct "
                    "the case."
                )
        if case.scale.keys() - case.rest.keys():
            unknown = ", ".join(sorted(case.scale.keys() - case.rest.keys()))
            raise SceneError(
                f"{where}: what is moved must be given at rest too; found {unknown} moved, but not "
                "at rest. Add it to rest."
            )

    @property
    def impulses(self) -> frozenset[str]:
        """Outputs that are means over the last step."""
        return frozenset(k for k, field in self.outputs.items() if field.centring == "impulse")

    @property
    def joined(self) -> frozenset[str]:
        """Ports that have a partner: all that it gives, and those taken that the case feeds."""
        fed = {key.partition(".")[0] for key in (*self.case.rest, *self.case.static)}
        return frozenset(port.name for port in self.gives) | fed

    def make(self, **resources: Any) -> Component:
        """Make the component, unjoined."""
        places = {"folder": self.folder, "device": self.case.device, **resources}
        return make(self.manifest.load(self.case.device), self.params, Resources(**places))

    def build(self, without: str = "", **resources: Any) -> Component:
        """Make the component and join its ports, but for one if it is named."""
        return self.join(self.make(**resources), without)

    def join(self, component: Component, without: str = "") -> Component:
        """Join the ports of a component that was just made."""
        component.describe()
        component.bind(self.static(without), self.joined - {without})
        return component

    def static(self, without: str = "") -> Fields:
        """Static fields of the partners."""
        return self.received(_of_others(self.case.static, without))

    def inputs(self, number: int | None = None, without: str = "") -> Fields:
        """Inputs at rest; with a number, moved away at random, for each number in another way."""
        random = np.random.default_rng(number or 0)
        fields = {key: np.array(array) for key, array in self.case.rest.items()}
        for key, scale in self.case.scale.items() if number is not None else ():
            fields[key] = self.moved(key, fields[key], scale, random)
        return self.received(_of_others(fields, without))

    def moved(
        self, key: str, array: Array, scale: float | tuple[float, ...], random: np.random.Generator
    ) -> Array:
        """An input moved away at random, but never out of its kind."""
        kind = self.inputs_known[key].kind
        if kind == "flag":
            return array
        if kind == "rotation":
            turn = np.asarray(scale) * random.normal(size=(len(array), 3))
            return rotation.product(rotation.exponential(turn), array)
        return np.asarray(array + np.asarray(scale) * random.normal(size=array.shape))

    def received(self, fields: Fields) -> dict[str, Array]:
        """Copies of some arrays as they come over a line: they cannot be written to."""
        copies = {key: np.array(array) for key, array in fields.items()}
        for array in copies.values():
            array.flags.writeable = not self.read_only
        return copies

    def move(
        self,
        component: Component,
        steps: int = STEPS,
        first: int = 1,
        wanted: Keys | None = None,
        without: str = "",
    ) -> list[Fields]:
        """Take inputs and step, again and again; copies of the outputs after each step."""
        asked = self.outputs.keys() if wanted is None else wanted
        outputs: list[Fields] = []
        for number in range(first, first + steps):
            component.take(self.inputs(number, without))
            component.step(self.case.dt)
            outputs.append(copies(component.give(frozenset(asked))) if asked else {})
        return outputs

    def give(self, component: Component) -> Fields:
        """Copies of all outputs as they are now."""
        return copies(component.give(frozenset(self.outputs)))


def copies(fields: Fields) -> dict[str, Array]:
    """Copies of some arrays."""
    return {key: np.array(array) for key, array in fields.items()}


def port_of(key: str) -> str:
    """Port of a field ``"port.field"``."""
    return key.partition(".")[0]


def names(ports: Iterable[Port]) -> list[str]:
    """Names of some ports."""
    return [port.name for port in ports]


def _of_others(fields: Fields, port: str) -> Fields:
    return {key: array for key, array in fields.items() if port_of(key) != port}
