"""Ports, sizes and start of a recorded component, without reading the whole recording."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from quintet.components.stand_ins.params import ReplayParams
from quintet.interfaces.component import Fields, fields_of
from quintet.interfaces.errors import SceneError
from quintet.interfaces.manifest import Plan, Ports
from quintet.interfaces.ports import from_json
from quintet.interfaces.recordings import CheckedFile, readable


def recording_file(path: str) -> Path:
    """File of a recording that is given as a file or as a run's folder."""
    place = Path(path)
    return place / "recording.h5" if place.is_dir() else place


@contextmanager
def recorded(params: ReplayParams) -> Iterator[CheckedFile]:
    """Open a recording that has the component that is replayed."""
    # Only a replay reads recordings.
    import h5py

    path, where = recording_file(params.recording), f"recording {params.recording}"
    if not path.is_file():
        raise SceneError(
            f"{where}: there is no such file. Run the scene first, or name "
            "the run to replay, as in --swap NAME=replay@DIR."
        )
    with readable(params.recording), h5py.File(path, "r", locking=False) as file:
        known = list(file["components"])
        if params.component not in known:
            raise SceneError(
                f"{where}: component {params.component} is not in it. It has {', '.join(known)}."
            )
        yield CheckedFile(file, params.recording)


def recorded_ports(params: ReplayParams) -> Ports:
    """Ports that the recorded component gave; it takes nothing back."""
    with recorded(params) as file:
        return (), from_json(str(file.component(params.component).attrs["ports"]))


def recorded_plan(params: ReplayParams) -> Plan:
    """Number of items, their bytes, and the recorded times."""
    with recorded(params) as file:
        group = file.component(params.component)
        times = file.marks(params.component)["ticks"] * file.file.attrs["tick"]
        data = list(group["fields"].values())
        items = max((rows.shape[1] for rows in data), default=1) or 1
        size = sum(8.0 * np.prod(rows.shape, dtype=float) for rows in data)
        return Plan(items, float("inf"), bytes_per_item=size / items, times=times)


def recorded_start(params: ReplayParams) -> Fields:
    """Static fields, and instants at the recording's start."""
    _, gives = recorded_ports(params)
    with recorded(params) as file:
        group = file.component(params.component)
        known = fields_of(gives)
        static = group.get("static", {}).items()
        fields = {key: array[()] for key, array in static if not key.startswith("samples.")}
        for key, data in group["fields"].items():
            if known[key].centring == "instant" and len(data):
                fields[key] = file.field(params.component, key, slice(1))[0]
        return fields
