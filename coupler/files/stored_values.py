"""Tables, lists, arrays, numbers and texts in an HDF5 file; nothing is pickled."""

import json
from typing import Any

import h5py
import numpy as np

from quintet.coupler.files.hdf5 import OF_DATASET, room


def write_value(file: h5py.File, name: str, value: Any) -> None:
    """Write a value under a name, whole, or close the file without it."""
    with room(file, _largest(value)):
        _put(file, name, value)


def _largest(value: Any) -> int:
    """Bytes that a value may need on the disk."""
    if isinstance(value, dict):
        return OF_DATASET + sum(map(_largest, value.values()))
    if isinstance(value, (list, tuple)) and any(isinstance(item, np.ndarray) for item in value):
        return OF_DATASET + sum(map(_largest, value))
    size = value.nbytes if isinstance(value, np.ndarray) else len(json.dumps(value))
    return OF_DATASET + int(size)


def _put(group: Any, name: str, value: Any) -> None:
    """Write tables and lists of arrays, numbers and texts; None is left out."""
    if value is None:
        return
    if isinstance(value, dict):
        part = group.create_group(name, track_order=True)
        for number, item in enumerate(value.values()):
            _put(part, str(number), item)
        part.attrs["keys"] = json.dumps(list(value))
    elif isinstance(value, (list, tuple)) and any(isinstance(item, np.ndarray) for item in value):
        part = group.create_group(name)
        for number, item in enumerate(value):
            _put(part, str(number), item)
        part.attrs["count"] = len(value)
    elif isinstance(value, np.ndarray):
        group[name] = value
    else:
        group[name] = json.dumps(value)  # a dataset, as an attribute ends at 64 KiB
        group[name].attrs["json"] = True


def read_value(group: Any, name: str) -> Any:
    """Read the value under a name; None where there is none."""
    if name not in group:
        return None
    stored = group[name]
    if isinstance(stored, h5py.Dataset):
        if "json" in stored.attrs:
            return json.loads(stored.asstr()[()])
        return np.asarray(stored[()])
    if "keys" in stored.attrs:
        keys = [_key(key) for key in json.loads(stored.attrs["keys"])]
        return {key: read_value(stored, str(number)) for number, key in enumerate(keys)}
    return tuple(read_value(stored, str(number)) for number in range(stored.attrs["count"]))


def _key(key: Any) -> Any:
    """A key of a table; JSON has lists where tables have tuples."""
    return tuple(key) if isinstance(key, list) else key
