"""``quintet devices``: a table of the OpenCL devices of this machine."""

import sys

from quintet.components.shared.opencl.devices import NO_DEVICE, bandwidth, devices
from quintet.interfaces.errors import QuintetError, SceneError


def main() -> int:
    """Print the devices; status 2 where there are none."""
    try:
        known = devices()
        if not known:
            raise SceneError(NO_DEVICE[0].upper() + NO_DEVICE[1:])
    except QuintetError as error:
        print(error, file=sys.stderr)
        return 2
    for device in known:
        doubles = "double precision" if device.has_doubles else "no double precision"
        print(f"opencl:{device.number}  {device.name}")
        print(
            f"    {device.units} compute units, {device.memory / 2**30:.1f} GiB, {doubles}, "
            f"copies {bandwidth(device) / 1e9:.1f} GB/s",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
