"""Python's debugger, at the first line of a method of a component."""

import pdb
import sys
from collections.abc import Callable, Sequence
from io import StringIO
from types import TracebackType
from typing import Any

from quintet.interfaces.component import Component
from quintet.interfaces.errors import SceneError

METHODS = ("take", "step", "give")


class ComponentDebugger(pdb.Pdb):
    """pdb at a terminal, or with the commands that are given: it then goes on after the last.

    Parameters
    ----------
    commands : sequence of str or None
        Commands of pdb, in the place of a terminal.
    """

    def __init__(self, commands: Sequence[str] | None = None) -> None:
        if commands is None:
            super().__init__()
        else:
            super().__init__(stdin=StringIO("".join(f"{line}\n" for line in commands)))
            self.use_rawinput = False
            self.do_EOF = self.do_continue  # type: ignore[method-assign]
        self.scripted = commands is not None

    def precmd(self, line: str) -> str:
        """Show the commands that nobody has typed."""
        if self.scripted:
            self.message(line)
        return str(super().precmd(line))

    def stop_in(self, component: Component, method: str) -> Callable[[], None]:
        """Stop at the first line of the next call of a method; return what undoes it."""
        original = getattr(component, method)

        def with_stop(*arguments: Any) -> Any:
            restore()
            self.reset()
            sys.settrace(self.trace_dispatch)
            return original(*arguments)

        def restore() -> None:
            component.__dict__.pop(method, None)

        try:
            setattr(component, method, with_stop)
        except AttributeError as error:
            raise SceneError(
                f"debug: the debugger stops only in a component whose attributes can be set; "
                f"{type(component).__name__} has none but its slots. Remove __slots__."
            ) from error
        return restore

    def look_at(self, trace: TracebackType | None) -> None:
        """Stop where an error was raised."""
        self.reset()
        self.interaction(None, trace)
