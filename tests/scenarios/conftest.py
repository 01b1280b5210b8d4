"""Running a scene that comes with quintet, as its user would."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from quintet.coupler.cli import main

Run = Callable[..., dict]


@pytest.fixture(scope="module")
def run_scene(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Run a scene without its pictures; return its results, with the expectations by name.

    ``energy_gained`` is the largest unexplained rise of energy, over the energy turned over.
    """

    def run(scene: str, *options: str) -> dict:
        out = tmp_path_factory.mktemp(Path(scene).stem)
        plain = ["--set", "output.interval=0", "--set", "output.pictures=[]"]
        with pytest.raises(SystemExit) as ended:
            main(["run", scene, "--out", str(out), *plain, *options])
        results = json.loads((out / "results.json").read_text())
        assert ended.value.code in (0, 1), results
        by_name = {outcome["name"]: outcome for outcome in results["expect"]}
        balance = results["ledger"]["energy_balance"]
        gained = balance["run"]["gained"] / balance["scale"] if balance else None
        return results | {"folder": Path(out), "by_name": by_name, "energy_gained": gained}

    return run
