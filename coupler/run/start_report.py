"""What a run does before its first window, on the screen: who is imported, built, compiled."""

import contextlib
import re
import threading
import time
from collections.abc import Mapping
from pathlib import Path

from rich.live import Live
from rich.text import Text

from quintet.coupler.launch.processes import size_of, tail
from quintet.coupler.run.progress import shows_bar
from quintet.interfaces.serving.notices import listen

LINE_INTERVAL = 2.0  # s between two lines where there is no terminal
LONG = 10.0  # s after which a line is printed again though nothing has changed; then twice as long
SHOWN = 60  # characters of what one component says
LINES = 200  # of a log that are looked through: a stack may be as long
# Lines of a stack that a process writes into its log when it is asked where it is.
STACK = re.compile(r'  File ".*", line |(Current thread|Thread|Stack|Extension modules|  \.\.\.)')


class StartReport:
    """Shows the last line of each component's log, or its notices in this process.

    Parameters
    ----------
    logs : mapping
        Logs of the components that are processes of their own on this host.
    """

    def __init__(self, logs: Mapping[str, Path]) -> None:
        self.logs = logs
        self._sizes = {name: size_of(log) for name, log in logs.items()}  # bytes of former runs
        self._said = ""  # by components in this process
        self._began = time.monotonic()
        self._over = threading.Event()
        self._live: Live | None = None
        self._printer: threading.Thread | None = None

    def show(self) -> None:
        """Begin to show."""
        listen(self._hear)
        if shows_bar():
            text = self._text
            self._live = Live(get_renderable=text, refresh_per_second=4, transient=True)
            self._live.start()
        else:
            self._printer = threading.Thread(target=self._print, daemon=True)
            self._printer.start()

    def close(self) -> None:
        """Show no more; a second call does nothing."""
        listen(None)
        self._over.set()
        if self._printer:
            self._printer.join()
            self._printer = None
        if self._live:
            self._live.stop()
            self._live = None

    def _hear(self, text: str) -> None:
        self._said = text

    def doing(self) -> str:
        """What every component is at."""
        lines = [f"{name}: {last_line(log, self._sizes[name])}" for name, log in self.logs.items()]
        return "; ".join([*lines, *filter(None, [self._said])])

    def _text(self) -> Text:
        return Text(f"{time.monotonic() - self._began:3.0f} s  {self.doing()}")

    def _print(self) -> None:
        shown, report_at = "", LONG
        while not self._over.wait(LINE_INTERVAL):
            doing, waited = self.doing(), time.monotonic() - self._began
            if doing != shown or waited > report_at:
                report_at = max(LONG, 2.0 * waited)
                with contextlib.suppress(OSError):  # nobody reads it any more
                    print(self._text().plain, flush=True)
            shown = doing


def last_line(log: Path, first: int = 0) -> str:
    """Last line that a component wrote after the first bytes of its log, stacks left out."""
    lines = [line for line in tail(log, LINES, first) if line.strip() and not STACK.match(line)]
    return lines[-1].strip()[:SHOWN] if lines else "starting"
