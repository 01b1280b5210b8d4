"""What a component shows when its state has become invalid, for who looks for the cause."""

import contextlib
from typing import Any

import numpy as np

from quintet.interfaces.component import Component, Fields
from quintet.interfaces.errors import StepError
from quintet.interfaces.serving.port_view import look_at


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
