"""``--over KEY=1,2,3``: keys of a scene that a sweep varies, and the product of their values."""

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from quintet.coupler.scene.overrides import value_text
from quintet.coupler.scene.toml import parsed, value_of
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import shown

MOST = 100_000  # runs of a sweep


@dataclass(frozen=True, slots=True)
class Axis:
    """One key of the scene, by its dotted path, the values that it takes, and their unit."""

    path: str
    values: tuple[Any, ...]
    unit: str = ""  # if it has one

    @property
    def label(self) -> str:
        """Path and unit, as tables and pictures have it."""
        return f"{self.path} [{self.unit}]" if self.unit else self.path

    @property
    def text(self) -> str:
        """The axis as the command line has it."""
        return f"{self.path}={','.join(value_text(value, self.path) for value in self.values)}"


def read_axes(options: Iterable[str]) -> list[Axis]:
    """Read ``PATH=VALUE,VALUE`` of the command line; every mistake at once."""
    axes: list[Axis] = []
    mistakes: list[str] = []
    for option in options:
        path, equals, text = option.partition("=")
        if not (path and equals):
            mistakes.append(
                f"--over needs KEY=VALUE,VALUE; found {shown(option)}. Give it as in --over "
                "window=1e-3,2e-3."
            )
            continue
        try:
            axes.append(Axis(path, values_of(text)))
        except ValueError as error:
            mistakes.append(f"--over {path}: {error}; found {shown(text)}. Correct it.")
    _refuse(mistakes)
    return checked_axes(axes)


def axes_of(over: Mapping[str, Iterable[Any]]) -> list[Axis]:
    """Axes of a mapping of dotted paths to values, as Python has them."""
    _refuse(
        [
            f"over {path}: there must be a list of values; found {shown(values)}. Write [{values}]."
            for path, values in over.items()
            if isinstance(values, (str, Mapping)) or not isinstance(values, Iterable)
        ]
    )
    return checked_axes([Axis(path, tuple(values)) for path, values in over.items()])


def values_of(text: str) -> tuple[Any, ...]:
    """Parse values of TOML, or words, with commas between them."""
    try:
        values = parsed(f"value = [{text}]")["value"]
    except (ValueError, RecursionError):
        values = [value_of(part) for part in text.split(",")]
    if not values:
        raise ValueError("there must be values, with commas between them")
    return tuple(values)


def checked_axes(axes: Sequence[Axis]) -> list[Axis]:
    """Refuse axes without values, with a value or a key twice, and products that are too large."""
    mistakes: list[str] = []
    if not axes:
        mistakes.append("sweep needs a key to vary. Give --over KEY=VALUE,VALUE.")
    paths = [axis.path for axis in axes]
    for path in dict.fromkeys(paths):
        if paths.count(path) > 1:
            mistakes.append(
                f"--over {path}: a key must be given once; found it {paths.count(path)} times. "
                "Put all values into one list."
            )
    for axis in axes:
        texts = [value_text(value, axis.path) for value in axis.values]
        if not texts:
            mistakes.append(f"--over {axis.path}: there must be values; found none. Give some.")
        if twice := next((text for text in texts if texts.count(text) > 1), ""):
            mistakes.append(
                f"--over {axis.path}: a value must be given once; found {twice} twice. Remove one."
            )
    if (count := math.prod(len(axis.values) for axis in axes)) > MOST:
        mistakes.append(f"sweep: there must be at most {MOST} runs; found {count}. Leave some out.")
    _refuse(mistakes)
    return list(axes)


def combinations(axes: Sequence[Axis]) -> list[dict[str, Any]]:
    """Settings of every run: the product of all values, the last key's changing fastest."""
    paths = [axis.path for axis in axes]
    products = itertools.product(*(axis.values for axis in axes))
    return [dict(zip(paths, values, strict=True)) for values in products]


def label(settings: Mapping[str, Any]) -> str:
    """Name a combination, as ``window=0.001, end=2.0``."""
    return ", ".join(f"{path}={value_text(value, path)}" for path, value in settings.items())


def _refuse(mistakes: list[str]) -> None:
    if mistakes:
        raise SceneError(mistakes)
