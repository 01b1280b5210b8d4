"""States of a run, from which other runs begin: those that it kept, and its snapshots."""

import hashlib
from pathlib import Path
from typing import Any

import h5py

from quintet.coupler.files.disk import is_sound
from quintet.coupler.files.run_files import SNAPSHOTS, STATES, numbered, window_of
from quintet.coupler.files.stored_values import read_value
from quintet.interfaces.errors import SceneError

DIGITS = 16  # of a hash
ROUNDING = 1e-6  # of a time, by which the time asked for may differ
HOW = (
    "Let it keep one with --set 'output.states=[TIME]' (a time beyond its end is its end), and run "
    "it again."
)


def states_of(folder: Path) -> list[Path]:
    """States of a run that are as they were written, by the windows that were done, latest last."""
    paths = [path for kind in (STATES, SNAPSHOTS) for path in numbered(folder, kind)]
    return sorted((path for path in paths if is_sound(path)), key=window_of)


def time_of(path: Path) -> float:
    """Simulated time of a state [s]."""
    try:
        with h5py.File(path, "r", locking=False) as file:
            coupling: Any = read_value(file, "coupling")
            return float(read_value(file, "tick") * coupling["own"]["windows"][0])
    except (OSError, LookupError, TypeError, ValueError, AttributeError) as error:
        raise SceneError(
            f"{path}: it must have what a run writes into a state; it has not "
            f"({type(error).__name__}). Run that scene again."
        ) from error


def hash_of(path: Path) -> str:
    """Hash of a state, by which it is known again, in hexadecimal digits."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "blake2b").hexdigest()[:DIGITS]


def choose(folder: Path, time: float | None) -> Path:
    """Find the last state of a run, or the one at a time [s].

    Raises
    ------
    SceneError
        Where there is none; it says what the run must ask for.
    """
    paths = states_of(folder)
    if not paths:
        raise SceneError(
            f"begin_from: the run in {folder} must have kept a state; it has none. {HOW}"
        )
    if time is None:
        return paths[-1]
    times = [time_of(path) for path in paths]
    for path, state_time in zip(paths, times, strict=True):
        if abs(state_time - time) <= ROUNDING * max(time, state_time):
            return path
    known = ", ".join(f"{state_time:g}" for state_time in dict.fromkeys(times))
    raise SceneError(
        f"begin_from.time must be that of a state which the run in {folder} kept, at {known} s; "
        f"found {time:g} s. Choose one of these, or let that run keep another in output.states."
    )
