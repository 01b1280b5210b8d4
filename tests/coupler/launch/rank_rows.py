"""The time saved when ranks get only the rows of ports that they need.

``python tests/coupler/launch/rank_rows.py 200000 2 4`` runs a component of 2 and of 4 ranks with an
interface of so many items, and prints the time and the processor time of a window.
"""

import shutil
import sys
import tempfile
from pathlib import Path

TOYS = Path(__file__).parents[1] / "toy_scenes"
if __name__ == "__main__":
    sys.path.insert(0, str(TOYS))

from started import Started  # noqa: E402

WINDOWS = 60
SCENE = """
name = "wide"
end = {end}
window = 1e-3
transport = "{transport}"
[components.loads]
kind = "toy_wide:Loads"
items = {items}
[components.shared]
kind = "toy_wide:Shared"
items = {items}
all_rows = {all_rows}
ranks = {ranks}
[[links]]
kind = "direct"
pairs = [["loads.load", "shared.load"], ["shared.sum", "loads.sum"]]
"""


def start(folder, items, ranks, all_rows=False, transport="mpi", windows=WINDOWS):
    """Start a run with a wide interface."""
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(TOYS / "toy_wide.py", folder)
    values = {"items": items, "ranks": ranks, "all_rows": str(all_rows).lower()}
    path = folder / "scene.toml"
    path.write_text(SCENE.format(**values, end=windows * 1e-3, transport=transport))
    return Started(path, "--set", f"output.record={str(items < 10_000).lower()}")


def main(items, *sizes):
    """Print a row for each number of ranks, without and with rows chosen."""
    for ranks in sizes:
        for all_rows in (True, False):
            with tempfile.TemporaryDirectory() as folder:
                run = start(Path(folder) / "run", items, ranks, all_rows)
                status = run.wait(300.0)
                assert status in (0, 1), run.err  # 1: such loads want shorter windows
                timing = run.results["timing"]
                usage, unit = timing["components"]["shared"], 1e3 / WINDOWS
                print(
                    f"{ranks} ranks, each gets {'all rows' if all_rows else 'its rows'}: "
                    f"exchange {unit * timing['exchange']:.1f} ms a window, "
                    f"compute {unit * usage['compute']:.1f} ms, cpu {unit * usage['cpu']:.1f} ms, "
                    f"{usage['memory'] / 1e6:.0f} MB",
                    flush=True,
                )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
