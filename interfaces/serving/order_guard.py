"""The legal order of a component's orders, as a pure state machine."""

import reprlib

from quintet.interfaces.errors import OrderError

# state -> order -> next state
LEGAL: dict[str, dict[str, str]] = {
    "new": {"describe": "described", "finish": "finished"},
    "described": {"sample": "described", "bind": "ready", "finish": "finished"},
    "ready": {
        "begin": "ready",
        "give": "ready",
        "prime": "ready",
        "prepare": "ready",
        "advance": "ready",
        "keep": "ready",
        "rewind": "ready",
        "save": "ready",
        "load": "ready",
        "view": "ready",
        "conclude": "ready",
        "finish": "finished",
    },
    "finished": {},
}


class OrderGuard:
    """Follows a component through its life; refuses what may not come next."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.state = "new"
        self.window = 0  # the next to be advanced
        self._kept: dict[int, int] = {}  # window, by depth

    def allow(self, order: str, window: int = 0, depth: int = 0) -> None:
        """Accept an order, or say what would have been legal."""
        legal = LEGAL[self.state]
        if order not in legal:
            raise OrderError(
                f"{self.name}: when {self.state}, an order must be one of "
                f"{', '.join(legal) or 'none'}; found {reprlib.repr(order)}."
            )
        if order == "advance":
            if window != self.window:
                raise OrderError(
                    f"{self.name}: window {self.window} is next; window {window} was ordered. "
                    "Windows come in order; rewind repeats one."
                )
            self.window += 1
        elif order == "keep":
            self._kept[depth] = self.window
        elif order == "load":
            self.window = window
        elif order == "rewind":
            if depth not in self._kept:
                raise OrderError(f"{self.name}: rewind needs a kept state; order keep first.")
            self.window = self._kept[depth]
        self.state = legal[order]
