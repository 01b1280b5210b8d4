"""The error of a law that cannot be printed: it names the place, the construct, what to do."""

import ast
from pathlib import Path

from quintet.interfaces.errors import QuintetError


class PrintError(QuintetError):
    """A law that is outside the subset of Python that can be printed."""


class Place:
    """Where a function stands.

    Parameters
    ----------
    file : str
    first : int
        Number of its first line.
    name : str
    """

    def __init__(self, file: str, first: int, name: str) -> None:
        self.file, self.first, self.name = file, first, name

    def line(self, node: ast.AST | None) -> int:
        """Line of the file that a node of the function stands in."""
        return self.first + getattr(node, "lineno", 1) - 1

    def refuse(self, node: ast.AST | None, construct: str, remedy: str) -> PrintError:
        """Make the error: a construct that was found, and what to do."""
        return PrintError(
            f"{Path(self.file).name}:{self.line(node)}, in {self.name}: a law printed for a device "
            f"must be a pure function of numbers; found {construct}. {remedy} ({self.file})"
        )
