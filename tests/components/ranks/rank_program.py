"""Runs cases of a solver on several MPI ranks; rank 0 writes the results.

Arguments: the module that defines ``Run``, a folder, a number of steps, the number of ranks that
left the state from which the run goes on (0: it begins at the start), names of cases, and "moved"
if the borders between ranks are to be moved. With several numbers of steps, rising, it
writes a state after each, or goes on from each to the next.
"""

import sys
from importlib import import_module
from itertools import pairwise
from pathlib import Path

import moved_borders
import numpy as np
from mpi4py import MPI

WORLD = MPI.COMM_WORLD


def write(path, run, with_failure=False):
    """Write the state and results; `with_failure` ends the run."""
    results = run.save() | run.results()
    if with_failure:
        results["failure"] = np.array(run.failure())
    if WORLD.rank == 0:
        np.savez(path, **results)


def begin(make, name, path=None):
    """Build a case, and go on from a file if there is one."""
    run = make(name)
    if path is not None:
        run.load(dict(np.load(path)))
    return run


def once(make, name, folder, steps, earlier):
    """Take some steps."""
    path, suffix = f"{folder}/{name}-{earlier}.npz", f"-{earlier}" * bool(earlier)
    run = begin(make, name, path if earlier else None)
    run.advance(steps)
    write(f"{folder}/{name}-{WORLD.size}{suffix}.npz", run, with_failure=True)


def snapshots(make, name, folder, windows):
    """Write a state after each of some numbers of steps."""
    run = begin(make, name)
    for step in windows:
        run.advance(step - run.steps)
        write(f"{folder}/{name}-{WORLD.size}@{step}.npz", run)


def resume(make, name, folder, windows, earlier):
    """Go on from each snapshot to the number of steps of the next."""
    for first, last in pairwise(windows):
        run = begin(make, name, f"{folder}/{name}-{earlier}@{first}.npz")
        run.advance(last - first)
        write(f"{folder}/{name}-{WORLD.size}-{earlier}@{last}.npz", run)


def main(program, folder, steps, earlier, names, *words):
    """Run all cases."""
    sys.path.append(str(Path(program).parent))
    make = import_module(Path(program).stem).Run
    if words == ("moved",):
        moved_borders.move()
    windows = [int(step) for step in steps.split(",")]
    for name in names.split(","):
        if len(windows) == 1:
            once(make, name, folder, windows[0], int(earlier))
        elif int(earlier):
            resume(make, name, folder, windows, int(earlier))
        else:
            snapshots(make, name, folder, windows)


if __name__ == "__main__":
    main(*sys.argv[1:])
