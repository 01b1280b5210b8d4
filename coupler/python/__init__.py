"""quintet: independent solvers, one interface, one coupler.

    import quintet

    run = quintet.run("dam_break_cubes", preset="quick", settings={"end": 0.2}, out="runs/cubes")
    run.ok                                      # done, and all expectations met
    run.expectations["top_x"]["value"]
    position = run.fields["cubes.motion.position"]
    position.values, position.times, position.unit      # (rows, items, 3), (rows,) s, "m"

The functions are those of the command line. Mistakes in a scene are raised as `SceneError`,
failures of a run as `RunError`; both are `QuintetError`, as all that quintet raises on purpose.
"""

from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from quintet.coupler.report.run import Run
    from quintet.coupler.scene.listing import Plan
    from quintet.coupler.scene.scene import Scene
    from quintet.coupler.study.calibrate import Calibration
    from quintet.coupler.study.ensemble import Ensemble
    from quintet.coupler.study.sweep import Sweep
    from quintet.interfaces.errors import QuintetError, RunError, SceneError

__version__ = "0.2.0"
__all__ = [
    "QuintetError",
    "RunError",
    "SceneError",
    "__version__",
    "calibrate",
    "check",
    "ensemble",
    "load",
    "resume",
    "run",
    "sweep",
]
ERRORS = ("QuintetError", "RunError", "SceneError")

Overrides = Mapping[str, Any] | None  # dotted path -> value


def __getattr__(name: str) -> Any:
    """Load the errors that are raised, once one of them is named."""
    if name not in ERRORS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    # Components import this package: it loads nothing until it is used.
    from quintet.interfaces import errors

    return getattr(errors, name)


def run(
    scene: str | PathLike[str],
    *,
    preset: str = "",
    settings: Overrides = None,
    swap: Mapping[str, str] | None = None,
    transport: str = "",
    out: str | PathLike[str] | None = None,
    force: bool = False,
) -> "Run":
    """Run a scene to its end and compare it with its expectations.

    Parameters
    ----------
    scene : str or path
        A name from ``quintet list``, or a TOML file.
    preset : str
        A preset of the scene.
    settings : mapping of dotted paths to values
        Set on top of the preset, in SI units, as ``{"components.water.spacing": 0.02}``.
    swap : mapping of components to kinds
        Components to be replaced, as ``{"water": "replay@runs/earlier"}``.
    transport : {"memory", "zenoh", "mpi"}
        That of the scene if not given.
    out : path
        Folder of the run, new or empty; ``runs/NAME``, or the next number that is free, if not
        given.
    force : bool
        Replace a former run in that folder: only the files that it wrote.

    Returns
    -------
    Run
        Results, ledger and recorded fields. An interrupted run is returned too.

    Raises
    ------
    SceneError
        The scene has mistakes, all of which are listed; nothing was started.
    RunError
        A component or a line failed.
    """
    # Components import this package, and none needs the coupler: it is loaded on use.
    from quintet.coupler.run.run_scene import run_scene

    checked = _scene(scene, preset, settings, swap, transport)
    return _finished(*run_scene(checked, Path(out) if out else None, force))


def resume(folder: str | PathLike[str], *, transport: str = "") -> "Run":
    """Continue an interrupted or failed run from its last snapshot, to the same bits.

    Parameters
    ----------
    folder : path
        Of the run.
    transport : {"memory", "zenoh", "mpi"}
        That of the run if not given.

    Returns
    -------
    Run

    Raises
    ------
    SceneError
        The run has no snapshot.
    RunError
        A component or a line failed.
    """
    # Components import this package, and none needs the coupler: it is loaded on use.
    from quintet.coupler.run.folder import check_ours
    from quintet.coupler.run.run_scene import resume_scene
    from quintet.coupler.run.snapshots import latest, scene_of

    place = Path(folder).resolve()
    check_ours(place, "run")
    snapshot = latest(place)
    return _finished(place, resume_scene(scene_of(snapshot, transport), place, snapshot))


def check(
    scene: str | PathLike[str],
    *,
    preset: str = "",
    settings: Overrides = None,
    swap: Mapping[str, str] | None = None,
    transport: str = "",
    imports: bool = False,
) -> "Plan":
    """Read and check a scene without starting anything; the parameters are those of `run`.

    Parameters
    ----------
    imports : bool
        Import kinds that are code of the scene's own, ``module:Class``, to check them too; without
        it no code of a scene is run.

    Returns
    -------
    Plan
        Processes, ports, windows, memory and expected time; its `scene` is the checked scene.

    Raises
    ------
    SceneError
        The scene has mistakes, all of which are listed.
    """
    # Components import this package, and none needs the coupler: it is loaded on use.
    from quintet.coupler.scene.listing import Plan
    from quintet.coupler.scene.needs import require_memory

    checked = _scene(scene, preset, settings, swap, transport, imports)
    require_memory(checked)
    return Plan(checked)


def sweep(
    scene: str | PathLike[str],
    over: Mapping[str, Iterable[Any]],
    *,
    preset: str = "",
    settings: Overrides = None,
    swap: Mapping[str, str] | None = None,
    transport: str = "",
    jobs: int = 2,
    retry: int = 1,
    out: str | PathLike[str] | None = None,
    executor: "Executor | None" = None,
) -> "Sweep":
    """Run a scene for each combination of the values of some keys; see `run`.

    Runs that are complete in the folder are not run again; called again, it does what is missing.

    Parameters
    ----------
    over : mapping of dotted paths to lists of values
        In SI units, as ``{"components.water.spacing": [0.02, 0.01]}``.
    jobs : int
        Runs at once, on this host.
    retry : int
        How often a run is repeated whose process was killed from outside.
    out : path
        Folder of all runs: new, empty, or of a former sweep; ``runs/NAME-sweep`` if not given.
    executor : concurrent.futures.Executor
        Does the runs in the place of `jobs` threads that start a process for each run. What it is
        given can be pickled; its workers must see the folder, and have quintet installed.

    Returns
    -------
    Sweep
        Its `rows`: settings, status, values of the expectations and times of each run.

    Raises
    ------
    SceneError
        Combinations have mistakes, all of which are listed; nothing was started.
    """
    # Components import this package, and none needs the coupler: it is loaded on use.
    from quintet.coupler.scene.sweep_axes import axes_of
    from quintet.coupler.study.sweep import sweep as run_all

    asked = _asked(scene, preset, settings, swap, transport)
    return run_all(asked, axes_of(over), Path(out) if out else None, jobs, retry, executor)


def ensemble(
    scene: str | PathLike[str],
    runs: int = 32,
    *,
    seed: int = 0,
    preset: str = "",
    settings: Overrides = None,
    swap: Mapping[str, str] | None = None,
    transport: str = "",
    jobs: int = 2,
    retry: int = 1,
    out: str | PathLike[str] | None = None,
    executor: "Executor | None" = None,
) -> "Ensemble":
    """Run a scene with its uncertain inputs drawn at random; see `sweep`.

    Runs that are complete in the folder are not run again. The numbers of a run depend on the seed
    and on its own number: an ensemble of 32 has the runs of one of 8.

    Parameters
    ----------
    runs : int
        Of the ensemble.
    seed : int
        Of the random numbers.
    out : path
        Folder of all runs: new, empty, or of a former ensemble; ``runs/NAME-ensemble`` if not
        given.

    Returns
    -------
    Ensemble
        `expectations` has the mean, standard deviation, quantiles and confidence interval of each
        expectation, and whether its reference lies inside; `rows` the runs, `failed` those that
        failed.

    Raises
    ------
    SceneError
        The scene has no ``[ensemble]``, or refuses numbers that were drawn; nothing was started.
    """
    # Components import this package, and none needs the coupler: it is loaded on use.
    from quintet.coupler.study.ensemble import ensemble as run_all

    asked = _asked(scene, preset, settings, swap, transport)
    return run_all(asked, Path(out) if out else None, runs, seed, jobs, retry, executor)


def calibrate(
    scene: str | PathLike[str],
    over: Mapping[str, Iterable[float]],
    to: str,
    runs: int = 20,
    *,
    seed: int = 0,
    preset: str = "",
    settings: Overrides = None,
    swap: Mapping[str, str] | None = None,
    transport: str = "",
    jobs: int = 2,
    retry: int = 1,
    out: str | PathLike[str] | None = None,
    ensemble: str | PathLike[str] | None = None,
    executor: "Executor | None" = None,
) -> "Calibration":
    """Seek the numbers with which an expectation of a scene fits its reference best; see `sweep`.

    Needs the extra ``calibrate``. Called again, it goes on from the runs that are complete.

    Parameters
    ----------
    over : mapping of dotted paths to (low, high)
        Several keys with commas between them take the same number.
    to : str
        Name of the expectation.
    runs, seed : int
        Of the optimiser.
    out : path
        Folder of all runs: new, empty, or of a former calibration; ``runs/NAME-calibrate`` if not
        given.
    ensemble : path
        Folder of an ensemble, whose standard deviation makes the interval; if not given the
        tolerance of the expectation does.

    Returns
    -------
    Calibration
        Its `keys`: best value and interval of each; its `misfit` and `rows`.

    Raises
    ------
    SceneError
        The scene refuses an end of a range, or has no such expectation; nothing was started.
    """
    # Components import this package, and none needs the coupler: it is loaded on use.
    from quintet.coupler.scene.key_ranges import ranges_of
    from quintet.coupler.study.calibrate import calibrate as fit

    asked = _asked(scene, preset, settings, swap, transport)
    places = Path(out) if out else None, Path(ensemble) if ensemble else None
    return fit(
        asked, ranges_of(over), to, places[0], runs, seed, jobs, retry, places[1], executor
    )  # fmt: skip


def load(folder: str | PathLike[str]) -> "Run":
    """Open an earlier run.

    Parameters
    ----------
    folder : path
        Of the run.

    Returns
    -------
    Run

    Raises
    ------
    SceneError
        There are no results in the folder.
    """
    # Components import this package, and none needs the coupler: it is loaded on use.
    from quintet.coupler.report.run import Run

    return Run(Path(folder))


def _asked(
    scene: str | PathLike[str],
    preset: str,
    settings: Overrides,
    swap: Mapping[str, str] | None,
    transport: str,
) -> tuple[str, str, list[str], list[str], str]:
    """Write a scene and its overrides as they stand on the command line."""
    # Components import this package, and none needs the coupler: it is loaded on use.
    from quintet.coupler.scene.overrides import assignments

    swaps = [f"{name}={kind}" for name, kind in (swap or {}).items()]
    return str(scene), preset, assignments(settings or {}), swaps, transport


def _scene(
    scene: str | PathLike[str],
    preset: str,
    settings: Overrides,
    swap: Mapping[str, str] | None,
    transport: str,
    imports: bool = True,
) -> "Scene":
    # Components import this package, and none needs the coupler: it is loaded on use.
    from quintet.coupler.scene.read import load as read

    return read(*_asked(scene, preset, settings, swap, transport), imports=imports)


def _finished(folder: Path, status: int) -> "Run":
    """Open a run that just ended; raise `RunError` if it failed."""
    # Components import this package, and none needs the coupler: it is loaded on use.
    from quintet.coupler.report.run import finished

    return finished(folder, status)
