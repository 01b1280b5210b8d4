"""How often a component may be started again, and how often it was."""

from dataclasses import dataclass


@dataclass(slots=True)
class Restarts:
    """Restarts of one component in a run.

    Parameters
    ----------
    limit : int
        As the scene has it; 0: its death ends the run.
    """

    limit: int = 0
    used: int = 0

    @property
    def left(self) -> int:
        """How often it may still be started again."""
        return self.limit - self.used

    def remark(self) -> str:
        """What to add to the cause of a failure."""
        if not self.limit:
            return ""
        return f"; it was started again {self.used} time(s) before, as often as scene.restarts says"
