"""``quintet devices``: a table of the OpenCL devices of this machine, or JSON with ``--json``."""

import json
import sys
from collections.abc import Sequence
from typing import Any

from quintet.components.shared.opencl.devices import (
    NO_DEVICE,
    Device,
    bandwidth,
    devices,
    opencl,
)
from quintet.interfaces.errors import QuintetError, SceneError

HOW = (
    'A component computes on one with device = "opencl:0"; with ranks = 2 both ranks share it, or '
    'each has one of its own: "opencl:0,1".'
)


def main(arguments: Sequence[str] = ()) -> int:
    """Print the devices; status 2 where there are none that work."""
    try:
        all_devices = devices()
        if not all_devices:
            raise SceneError(NO_DEVICE[0].upper() + NO_DEVICE[1:])
    except QuintetError as error:
        print(error, file=sys.stderr)
        return 2
    rows: list[dict[str, Any]] = []
    for device in all_devices:
        try:
            rows.append(row_of(device))
        except (opencl().Error, QuintetError) as error:  # others may work
            print(f"opencl:{device.number} cannot be used: {error}", file=sys.stderr)
    if "--json" in arguments:
        print(json.dumps(rows, indent=1))
        return 0
    for row in rows:
        doubles = "double precision" if row["doubles"] else "no double precision"
        print(f"{row['device']}  {row['name']}")
        print(
            f"    {row['units']} compute units, {row['memory'] / 2**30:.1f} GiB, {doubles}, "
            f"copies {row['bandwidth'] / 1e9:.1f} GB/s"
        )
    if rows:
        print(HOW)
    return 0 if rows else 2


def row_of(device: Device) -> dict[str, Any]:
    """Row of the table for one device; its bandwidth is measured."""
    return {
        "device": f"opencl:{device.number}",
        "name": device.name,
        "units": device.units,
        "memory": device.memory,  # bytes
        "doubles": device.has_doubles,
        "bandwidth": bandwidth(device),  # bytes/s
    }


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
