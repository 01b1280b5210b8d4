"""Entry points of installed packages: which kinds of components and of links there are."""

import sys
from functools import cache
from importlib.metadata import EntryPoint, entry_points


def installed(group: str) -> tuple[EntryPoint, ...]:
    """Entry points of a group.

    The files of all packages are read, for 10 ms, once for each state of ``sys.path``.
    """
    return _installed(group, tuple(sys.path))


@cache
def _installed(group: str, path: tuple[str, ...]) -> tuple[EntryPoint, ...]:
    return tuple(entry_points(group=group))
