"""A place for a table in a README, between two markers."""

from dataclasses import dataclass
from pathlib import Path

from quintet.coupler.files.disk import write_whole
from quintet.interfaces.errors import SceneError


@dataclass(frozen=True, slots=True)
class MarkedPlace:
    """The lines of a file between two markers, each a line of its own.

    Raises
    ------
    SceneError
        From every method: the markers are missing, repeated or in the wrong order.
    """

    begin: str
    end: str

    def check(self, path: Path) -> None:
        """Refuse a file that has not one place for the table."""
        self._parts(path)

    def put(self, path: Path, table: str) -> None:
        """Put a table between the markers of a file; all around it stays as it is."""
        before, _, after = self._parts(path)
        write_whole(path, "\n".join([*before, table, *after]))

    def read(self, path: Path) -> str:
        """Read the table between the markers of a file."""
        return "\n".join(self._parts(path)[1])

    def _parts(self, path: Path) -> tuple[list[str], list[str], list[str]]:
        """Lines of a file up to the first marker, between both, and from the second one."""
        try:
            lines = path.read_text(encoding="utf-8").split("\n")
        except (OSError, UnicodeDecodeError) as error:
            raise SceneError(
                f"--readme {path}: it cannot be read ({error}). Name another."
            ) from error
        counts = lines.count(self.begin), lines.count(self.end)
        if counts != (1, 1) or lines.index(self.begin) > lines.index(self.end):
            raise SceneError(
                f"--readme {path}: it must have the lines {self.begin} and {self.end} once, in "
                f"this order; found {counts[0]} and {counts[1]}. Add them where the table shall "
                "stand."
            )
        first, last = lines.index(self.begin) + 1, lines.index(self.end)
        return lines[:first], lines[first:last], lines[last:]


STUDIES = MarkedPlace("<!-- study -->", "<!-- studied -->")
LIMITS = MarkedPlace("<!-- stability -->", "<!-- end of stability -->")
