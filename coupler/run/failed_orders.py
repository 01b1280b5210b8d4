"""The last window's order of every component of a run that failed, with its inputs.

Of a window that failed the recording has nothing. These orders are written once, at the end of
such a run, for `quintet debug`.
"""

from collections.abc import Mapping
from pathlib import Path

from quintet.coupler.coupling.participant import Participant
from quintet.coupler.files.disk import (
    DIGEST,
    MARK,
    PART,
    is_sound,
    put_in_place,
    removed_on_failure,
    reporting_disk,
    seal,
)
from quintet.coupler.files.run_files import FAILED_ORDERS
from quintet.interfaces.errors import MessageError
from quintet.interfaces.lines.message import PREFIX, Message, decode, encode


def write(folder: Path, participants: Mapping[str, Participant]) -> None:
    """Write the last orders of windows; those of trial windows are left out."""
    path = folder / FAILED_ORDERS
    part = path.with_name(path.name + PART)
    frames = [
        encode({**header, "component": name}, fields, None)
        for name, participant in participants.items()
        for header, fields in [participant.window_order]
        if header and not header.get("trial")
    ]
    if frames:
        with reporting_disk(path), removed_on_failure(part):
            part.write_bytes(b"".join(frames))
            seal(part)
            put_in_place(part, path)


def read(folder: Path) -> dict[str, Message]:
    """Orders by component; none where there is no such file, or it is not as it was written."""
    path = folder / FAILED_ORDERS
    if not path.is_file() or not is_sound(path):
        return {}
    content = path.read_bytes()[: -len(MARK) - DIGEST]
    orders: dict[str, Message] = {}
    while content:
        size = PREFIX.unpack_from(content)[2]
        message = decode(content[:size])
        content = content[size:]
        component = message.header.pop("component", None)
        if not isinstance(component, str):
            raise MessageError(f"{path}: each order must name its component.")
        orders[component] = message
    return orders
