"""Rows of ports for the rank of a component that needs them, and the rank that computed a row."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from quintet.interfaces.component import Array, Component, Fields
from quintet.interfaces.lines.message import Message
from quintet.interfaces.sums import finite

ORDERS = ("prime", "advance")  # whose fields are rows of ports taken


def needed_rows(component: Component) -> dict[str, Array]:
    """Rows (k,) that this rank needs, of every port taken of which it does not need all.

    Ports with rotations come whole: a row of zeros is no rotation.
    """
    needed = {}
    for port in component.takes:
        rows = component.rank_rows(port.name)
        if rows is not None and not any(field.kind == "rotation" for field in port.fields):
            needed[port.name] = np.asarray(rows, np.int64)
    return needed


def with_rows(message: Message, rows: Fields) -> tuple[dict[str, Any], Fields]:
    """Header and fields of an order, with only these rows (k,) of each port."""
    if not rows or message.order not in ORDERS:
        return message.header, message.fields
    lengths, parts = {}, {}
    for key, array in message.fields.items():
        port = key.partition(".")[0]
        parts[key] = array
        if port in rows:
            lengths[key], parts[key] = len(array), array.take(rows[port], axis=0)
    return {**message.header, "lengths": lengths}, parts


def with_all_rows(message: Message, rows: Fields) -> Message:
    """Put the rows that came where they belong in arrays of all rows; others are zero."""
    lengths = message.header.pop("lengths", {})
    for key, length in lengths.items():
        part = message.fields[key]
        whole = np.zeros((length, *part.shape[1:]), part.dtype)
        whole[rows[key.partition(".")[0]]] = part
        message.fields[key] = whole
    return message


def first_not_finite(fields: Fields) -> tuple[str, int] | None:
    """Key and row of the first row that has a number which is not finite."""
    for key, array in fields.items():
        if not finite(array):
            rows = np.atleast_1d(array)
            bad = ~np.isfinite(rows.reshape(len(rows), -1)).all(axis=1)
            return key, int(np.argmax(bad))
    return None


def computes(component: Component, header: Mapping[str, Any]) -> bool | None:
    """Whether this rank computes a row of a port that it gives; None: unknown."""
    rows = component.rank_rows(str(header["key"]).partition(".")[0])
    return None if rows is None else bool(np.isin(header["row"], rows))
