"""Refusals of what a device does not compute; pyopencl is not needed for them."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from quintet.interfaces.errors import SceneError


class Limit(NamedTuple):
    """Limit of a key on devices."""

    value: object
    is_wrong: bool
    right: str  # what it must be
    remedy: str  # "Remove it"


def refuse_wrong(limits: Mapping[str, Limit], device: str) -> None:
    """Refuse values of keys that a device does not compute.

    Raises
    ------
    SceneError
        With all keys at fault, the values found, and what to do.
    """
    sentences = [
        f"on device {device}, {key} must be {limit.right}; found {limit.value}. {limit.remedy}, "
        'or set device = "cpu".'
        for key, limit in limits.items()
        if limit.is_wrong
    ]
    if sentences:
        raise SceneError(sentences)


def refuse_parts(names: Sequence[str], device: str, what: str) -> None:
    """Refuse parts, by the names of their classes, that only a step on the processor calls."""
    if names:
        raise SceneError(
            f"on device {device}, {what} must have no parts that the processor alone computes; "
            f'found {", ".join(names)}. Set device = "cpu".'
        )
