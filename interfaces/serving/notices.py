"""What a component says that it is doing before its first step, while others wait for it."""

from collections.abc import Callable

_listeners: list[Callable[[str], None]] = []


def notice(text: str) -> None:
    """Say what takes long before the first step: ``notice("compiling pair_rates")``.

    The user sees it on the screen until something else is said. Nothing happens where nobody
    listens.
    """
    for listener in _listeners:
        listener(text)


def listen(listener: Callable[[str], None] | None) -> None:
    """Let a function hear all notices of this process, and no other; None: nobody."""
    _listeners[:] = [listener] if listener else []
