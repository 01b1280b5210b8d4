"""Whether a coupling is stable, seen from the work that goes through its links.

What one side of a link gives the other takes, but for what staggering in time costs. A coupling
that is unstable lives on that difference: the side that is pushed takes more work than the other
gives, and it keeps doing so. Momentum closes to rounding all the while, and an iterated window
agrees with itself however wildly the next one swings the other way.

Measured on a floating square and a floating cube of 10 to 3000 kg/m³, staggered and iterated, in
windows of 0.3 to 20 ms: of the work that went through, what was taken beyond what was given came to
at most 0.07 where the coupling was stable, and to 0.3 to 6 where it was not; over some tens of
windows to at most 0.18, as a body struck the floor, and to 0.37 and more.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from quintet.coupler.coupling.energy_balance import KINDS
from quintet.coupler.coupling.ledger import Account
from quintet.coupler.coupling.saved_values import attributes_like, like, require_same_keys
from quintet.coupler.coupling.schedule import Coupling

LIMIT = 0.2  # of the work that went through a link: what a stable coupling makes is less
LATE_LIMIT = 0.3  # the same over the last windows
SPAN = 32  # windows that count most: each older one by 1 - 1/SPAN less
FEWEST = 12  # windows before a link is judged: a start with a jolt is over by then
# Of the largest energy of any component, kinetic or internal, and of any kind: with less going
# through, a link decides nothing, as at a body that the fluid has not reached, or ahead of a wave.
MOVING, NEGLIGIBLE = 5e-2, 1e-9
# Of the work exchanged, made or lost in the whole run. Two masses on springs whose energy of
# oscillation is 16, 33, 75 % too large are 5, 10, 27 % off; cubes in a dam break make 16 %.
DRIFT_LIMIT = 0.3
QUIET = 0.1  # of the mean work of a window so far: with less going through, no window is judged


@dataclass(slots=True)
class LinkWork:
    """Work that a link made, and what went through it [J]: in all, and of late."""

    work_given: float = 0.0  # as the ledger had them last
    work_taken: float = 0.0
    turnover: float = 0.0
    late: float = 0.0  # made
    late_turnover: float = 0.0
    low: float = 0.0  # least and most that was given by the end of any window [J]
    high: float = 0.0

    def add(self, account: Account) -> None:
        """Add a window."""
        gain = (account.work_taken - self.work_taken) - (account.work_given - self.work_given)
        fade = 1.0 - 1.0 / SPAN
        self.late = fade * self.late + gain
        self.late_turnover = fade * self.late_turnover + account.turnover - self.turnover
        self.work_given, self.work_taken = account.work_given, account.work_taken
        self.turnover = account.turnover
        self.low, self.high = min(self.low, self.work_given), max(self.high, self.work_given)

    def drift(self) -> float:
        """Work made so far over the range of the work given: the error of the energy exchanged."""
        extent = self.high - self.low
        return (self.work_taken - self.work_given) / extent if extent > 0.0 else 0.0

    def is_unstable(self, windows: int, negligible: float) -> bool:
        """Whether too much of what went through was made of nothing, of late or in all.

        Nothing is said while no more than what is `negligible` [J] went through.
        """
        if windows < FEWEST or self.turnover <= negligible:
            return False
        usual = self.turnover * min(1.0, SPAN / windows)
        loud = self.late_turnover > QUIET * usual
        return (loud and self.gains_of_late()) or (
            self.work_taken - self.work_given > LIMIT * self.turnover > 0.0
        )

    def gains_of_late(self) -> bool:
        """Whether too much of what went through in the last windows was made of nothing."""
        return self.late > LATE_LIMIT * self.late_turnover


class StabilityWatch:
    """Looks at every link at the end of every window of the run."""

    def __init__(self, links: Iterable[str]) -> None:
        self._works = {name: LinkWork() for name in links}
        self.unstable: set[str] = set()  # links
        self._negligible = 0.0  # J, as seen last
        self.needs_totals = False  # at the next window's end: a link is judged by its energies

    def check(self, coupling: Coupling) -> dict[str, dict[str, str]]:
        """Judge all links at a window's end; warn once of each.

        A link that seems unstable is judged again a window later, by the energies of then: since
        they were last told a wave may have begun.
        """
        texts, ledger = {}, coupling.ledger
        energy, known = ledger.energy, self.needs_totals
        if known:
            energy.note(ledger.totals)
        self.needs_totals = False
        self._negligible = negligible = max(
            MOVING * energy.largest("kinetic", "internal"), NEGLIGIBLE * energy.largest(*KINDS)
        )
        for name, account in ledger.accounts.items():
            work = self._works[name]
            work.add(account)
            if name not in self.unstable and work.is_unstable(coupling.windows.done, negligible):
                self.needs_totals = self.needs_totals or not known
                if not known:
                    continue
                gain, turnover, since = work.work_taken - work.work_given, work.turnover, ""
                if work.gains_of_late():
                    gain, turnover, since = work.late, work.late_turnover, " in the last windows"
                self.unstable.add(name)
                text = (
                    f"its coupling is unstable: by t = {coupling.windows.time:.4g} s its sides "
                    f"took {gain:.3g} J more work than they gave{since}, "
                    f"{100.0 * gain / turnover:.0f} % of the work that went through it; "
                    f"{advice(coupling, name)}"
                )
                texts[name] = {"stability": text}
        return texts

    def final_warnings(self, coupling: Coupling) -> dict[str, dict[str, str]]:
        """Warn of links that made or lost too much of the work that they exchanged in the run."""
        texts = {}
        for name, work in self._works.items():
            drift = work.drift()
            quiet = abs(drift) < DRIFT_LIMIT or work.turnover <= self._negligible
            if quiet or name in self.unstable or _foresees(coupling, name):
                continue
            verb = "more" if drift > 0.0 else "less"
            text = (
                f"its sides took {abs(work.work_taken - work.work_given):.3g} J {verb} work than "
                f"they gave, {100.0 * abs(drift):.0f} % of the {work.high - work.low:.3g} J that "
                f"were exchanged; {advice(coupling, name)}"
            )
            texts[name] = {"work": text}
        return texts

    def suspects(self, coupling: Coupling) -> list[str]:
        """Say which links made much of what went through them of late, after any few windows."""
        return [
            f"the coupling of link {name} seems unstable: its sides took {work.late:.3g} J more "
            f"work than they gave in the last windows, {100.0 * work.late / work.late_turnover:.0f}"
            f" % of what went through it; {advice(coupling, name)}"
            for name, work in self._works.items()
            if work.gains_of_late() and work.late_turnover > self._negligible
        ]

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""
        return {
            "needs_totals": self.needs_totals,
            "works": {name: asdict(work) for name, work in self._works.items()},
            "unstable": sorted(self.unstable),
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self.needs_totals = like(False, state["needs_totals"])
        require_same_keys(self._works, state["works"])
        self._works = {
            name: LinkWork(**attributes_like(LinkWork(), work))
            for name, work in state["works"].items()
        }
        self.unstable = set(state["unstable"])


def _foresees(coupling: Coupling, link: str) -> bool:
    """Whether the side that gives the force steps first, and only expects where the other moves.

    The work that it counts is along the expected way, which starts again in every window.
    """
    inner, exchange = coupling.carries(link) or coupling, coupling.exchange
    return any(
        exchange.links[exchange.link_of[number]].name == link
        and exchange.transfers[number].taker in exchange.works_of[exchange.link_of[number]]
        for number in inner.late
    )


def advice(coupling: Coupling, link: str) -> str:
    """Say what makes the coupling of a link stable.

    Staggered windows are unstable where what is carried along weighs more than what carries it:
    what gives the force answers a change of velocity in one window with more momentum than the
    other side has. What answers by sound does so the less the shorter the window, but no window
    is short enough for whatever is light: half the step of the side that gives the force was for
    cubes of 50 kg/m³ in water, and not for 20. Windows of that length that are repeated until
    both sides agree were stable for all of them, at several times the work. So for a link that
    answers by sound the first advice is half the shorter of step and window.
    """
    inner = coupling.carries(link) or coupling
    key = f"groups.{inner.plan.name}." if inner.plan.name else ""
    pairs = zip(coupling.exchange.links, coupling.exchange.works_of, strict=True)
    demands, works = next((other.demands(), works) for other, works in pairs if other.name == link)
    step = min((inner.components[name].stable for name in works), default=math.inf)
    window = inner.last_dt
    shorter = 0.5 * min(window, step)
    digits = 10.0 ** (math.floor(math.log10(shorter)) - 1)
    short = f"{math.floor(shorter / digits) * digits:g}"
    if inner.plan.scheme == "iterated" or "iterated" not in demands.schemes:
        return f"shorten {key}window from {window:.3g} s to {short} s."
    repeated = f'set {key}scheme = "iterated"'
    if demands.by_sound and window > 0.5 * step:
        return (
            f"shorten {key}window from {window:.3g} s to {short} s; if that is not enough, as for "
            f"what is far lighter than the fluid, also {repeated}, which takes longer."
        )
    if window <= step:
        return f"{repeated}."
    return f"{repeated}, and shorten {key}window from {window:.3g} s to {short} s."
