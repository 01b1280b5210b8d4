"""All files that a run leaves, and the marker by which its folder is known as a run's."""

import json
import re
import secrets
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

from quintet.coupler.files.disk import PART, RESERVE, write_whole
from quintet.interfaces.errors import SceneError

FORMAT = 1
MARKER, LOCK = "quintet-run.json", "quintet-run.lock"
RECORDING = "recording.h5"
RESULTS, LEDGER, SCENE = "results.json", "ledger.csv", "scene.toml"
FAILED_ORDERS = "failed-orders.msg"  # last orders of windows, of a run that failed
RUN_LOG = "run.log"  # what a run printed that a study started
PICTURES = ("scene.png", "comparison.png")
# by quintet draw and report, where not elsewhere
DRAWN, DRAWN_3D, SERIES_DRAWN, REPORT = "drawn.png", "drawn-3d.png", "series.png", "report.html"
TRACE, CHROME_TRACE = "trace.csv", "trace.json"  # of a run with output.trace; by quintet trace
RUN_FILES = (  # of every run
    RESULTS, RECORDING, LEDGER, SCENE, *PICTURES, DRAWN, DRAWN_3D, SERIES_DRAWN, REPORT,
    TRACE, CHROME_TRACE, FAILED_ORDERS, RESERVE,
)  # fmt: skip
SNAPSHOTS = "snapshot-*.h5"
STATES = "state-*.h5"  # that stay, for other runs to begin from
VIEWS, WALLS, FAILURE = ".vtkhdf", ".walls.vtkhdf", ".failure.vtkhdf"


def view_file(component: str) -> str:
    """File with what there is to see of a component."""
    return f"{component}{VIEWS}"


def walls_file(component: str) -> str:
    """File with what stands still around a component; no name of a component has a dot."""
    return f"{component}{WALLS}"


def state_file(windows: int) -> str:
    """File with the state of a run after so many windows, for others to begin from."""
    return STATES.replace("*", str(windows))


def failure_file(component: str) -> str:
    """File with what was around the item at which a component failed."""
    return f"{component}{FAILURE}"


def failure_files(components: Iterable[str]) -> list[str]:
    """Files that a run leaves only where it fails."""
    return [FAILED_ORDERS, *map(failure_file, components)]


@dataclass(frozen=True, slots=True)
class Marker:
    """What the folder of a run says of it."""

    run: str  # of this run alone
    kind: str  # run, study or stability
    scene: str
    files: tuple[str, ...]  # that the run may write, but for its snapshots; from the folder on
    format: int = FORMAT


def new_marker(kind: str, scene: str, files: Iterable[str]) -> Marker:
    """Make the marker of a run that begins."""
    return Marker(secrets.token_hex(8), kind, scene, tuple(sorted(set(files))))


def write_marker(folder: Path, marker: Marker) -> None:
    """Write the marker; it is there whole or not at all."""
    write_whole(folder / MARKER, json.dumps(asdict(marker), indent=2))


def read_marker(folder: Path) -> Marker | None:
    """Read the marker of a folder; None where it has none."""
    try:
        table = json.loads((folder / MARKER).read_text(encoding="utf-8"))
        if table["format"] != FORMAT:
            raise SceneError(
                f"{folder}: {MARKER} must be of format {FORMAT}; found {table['format']!r}. Name "
                "another folder, or use the version of quintet that ran there."
            )
        return Marker(**{**table, "files": tuple(map(str, table["files"]))})
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise SceneError(
            f"{folder}: {MARKER} cannot be read ({error}). Name another folder."
        ) from error


def may_write(folder: Path, files: Iterable[str]) -> list[Path]:
    """All files that a run with these files may write into a folder, there or not."""
    names = [*files, MARKER, LOCK]
    return [*_within(folder, names), *_snapshots(folder)]


def _within(folder: Path, names: Iterable[str]) -> list[Path]:
    """Files of a folder by their names, and what they are called while they are written."""
    plain = [Path(name) for name in names]
    within = [folder / path for path in plain if not path.is_absolute() and ".." not in path.parts]
    return [*within, *(path.with_name(path.name + PART) for path in within)]


def numbered(folder: Path, kind: str, end: str = "") -> list[Path]:
    """Snapshots or states of a run, the latest last; copies that a user has named are left out."""
    name = re.compile(re.escape(kind + end).replace(r"\*", "[0-9]+"))
    paths = (path for path in folder.glob(kind + end) if name.fullmatch(path.name))
    return sorted(paths, key=window_of)


def window_of(path: Path) -> int:
    """Windows that were done when a snapshot or a state was made."""
    return int(path.name.partition("-")[2].partition(".")[0])


def _snapshots(folder: Path) -> list[Path]:
    kinds = (SNAPSHOTS, STATES)
    return [path for kind in kinds for end in ("", PART) for path in numbered(folder, kind, end)]


def leftovers(folder: Path, marker: Marker) -> list[Path]:
    """Files of a run that are there, but for what its study logs; the marker's last."""
    paths = _within(folder, (name for name in marker.files if name != RUN_LOG))
    paths += _snapshots(folder) if marker.kind == "run" else []
    return [path for path in [*paths, folder / MARKER] if path.is_file() or path.is_symlink()]
