"""Trying the laws on a component, one after the other."""

import time
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from quintet.coupler.conform.laws import FIRST, LAWS, READ_ONLY, Law, name_of
from quintet.coupler.conform.trial import Trial
from quintet.coupler.conform.verdict import DoesNotApply, LawBroken, raised
from quintet.interfaces.errors import SceneError

Status = Literal["passed", "failed", "does not apply"]


@dataclass(frozen=True, slots=True)
class Finding:
    """What came of one law."""

    law: str
    status: Status
    said: str = ""  # how it is broken, or why it does not apply
    seconds: float = 0.0


def try_law(law: Law, trial: Trial) -> Finding:
    """Try one law; what the component raises breaks it."""
    began = time.perf_counter()
    status: Status = "passed"
    text = ""
    try:
        law(trial)
    except DoesNotApply as reason:
        status, text = "does not apply", str(reason)
    except LawBroken as broken:
        status, text = "failed", str(broken)
    except SceneError:
        raise  # the case is wrong, not the component
    except Exception as error:  # of any kind: what it does here is its author's
        status, text = "failed", _place(error)
    return Finding(name_of(law), status, text, time.perf_counter() - began)


def _place(error: Exception) -> str:
    """An error with the line that raised it, in the component if it was there."""
    frames = traceback.extract_tb(error.__traceback__)
    calls = [frame for frame in frames if Path(__file__).parent not in Path(frame.filename).parents]
    last = (calls or frames)[-1]
    return f"{raised(error)} ({last.filename}:{last.lineno}, in {last.name})"


def try_all(trial: Trial) -> Iterator[tuple[Law, Finding | None]]:
    """Try all laws: each is named when it begins, with None, and when it has ended."""
    is_built, trial.read_only = True, False
    for law in LAWS:
        yield law, None
        if not is_built:
            yield law, Finding(name_of(law), "does not apply", "it could not be made")
            continue
        finding = try_law(law, trial)
        if law is FIRST:
            is_built = finding.status == "passed"
        if law is READ_ONLY:  # else writing to them would break all others, and hide what else is
            trial.read_only = finding.status != "failed"
        yield law, finding
