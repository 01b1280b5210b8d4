"""What a component says when it fails, and shows when its state has become invalid."""

import contextlib
import traceback
from typing import Any

import numpy as np

from quintet.interfaces.component import Component, Fields
from quintet.interfaces.errors import QuintetError, StepError
from quintet.interfaces.serving.port_view import look_at

LONGEST_TEXT = 1 << 16  # characters of an error's text or traceback


def shown_at_failure(component: Component, error: BaseException) -> tuple[dict[str, Any], Fields]:
    """View of a component at an error that names a place; nothing where there is none to see.

    Returns
    -------
    header : dict
        ``place`` (3,) m of the item at fault, and ``units`` of the fields.
    fields : mapping of arrays
        As of `Component.view`.
    """
    if not isinstance(error, StepError) or error.place is None:
        return {}, {}
    with contextlib.suppress(Exception):  # its state is invalid: the error itself is what counts
        shown, units = look_at(component)
        place = [float(number) for number in np.ravel(error.place)]
        return {"place": place, "units": units}, shown
    return {}, {}


def failure(error: BaseException) -> dict[str, Any]:
    """Put an error into the header that tells the coupler of it."""
    if isinstance(error, MemoryError):
        # What the failed functions hold is released, or there is none left to tell of it.
        traceback.clear_frames(error.__traceback__)
    is_ours = isinstance(error, QuintetError)
    text = str(error)
    if isinstance(error, SystemExit):
        text = f"asked Python to exit, with status {error.code!r}; raise an error instead"
    return {
        "order": "failed",
        "error": type(error).__name__,
        "text": sendable(text),
        "traceback": "" if is_ours else sendable("".join(traceback.format_exception(error))),
    }


def sendable(text: str) -> str:
    """Text that a header can hold: valid UTF-8, and of a long one its beginning and its end."""
    text = text.encode("utf-8", "backslashreplace").decode("utf-8")
    if len(text) <= LONGEST_TEXT:
        return text
    left_out, half = len(text) - LONGEST_TEXT, LONGEST_TEXT // 2
    return f"{text[:half]} … {left_out} characters … {text[-half:]}"
