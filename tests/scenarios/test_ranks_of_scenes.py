"""Scenes whose components own several MPI ranks give the bits of one rank."""

from pathlib import Path

import pytest

from quintet.coupler.cli import main
from quintet.coupler.report.diff import compare

SHORT = {  # of each scene: the component that is divided, and settings of a short run
    "hot_bar_coupled": ("points", {"end": 0.8, "window": 0.1}),
}


def run(folder: Path, scene: str, transport: str, ranks: int, *more: str) -> Path:
    name, settings = SHORT[scene]
    plain = {"output.interval": 0, "output.pictures": "[]", "output.snapshots": 0.0, **settings}
    if ranks > 1:
        plain[f"components.{name}.ranks"] = ranks
    words = [word for key, value in plain.items() for word in ("--set", f"{key}={value}")]
    with pytest.raises(SystemExit) as ended:
        main(["run", scene, *words, "--transport", transport, "--out", str(folder), *more])
    assert ended.value.code in (0, 1)  # too short for what the scene expects
    return folder


@pytest.fixture(scope="module", params=SHORT)
def of_one_rank(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    scene = request.param
    return run(tmp_path_factory.mktemp("one rank") / scene, scene, "memory", 1)


@pytest.mark.parametrize(
    ("transport", "ranks"),
    [
        pytest.param("mpi", 2, marks=pytest.mark.mpi),
        pytest.param("zenoh", 2, marks=pytest.mark.zenoh),
        pytest.param("mpi", 3, marks=[pytest.mark.mpi, pytest.mark.full]),
        pytest.param("zenoh", 4, marks=[pytest.mark.zenoh, pytest.mark.full]),
    ],
)
def test_a_scene_gives_the_same_bits_on_any_number_of_ranks(
    tmp_path: Path, of_one_rank: Path, transport: str, ranks: int
) -> None:
    folder = run(tmp_path / "run", of_one_rank.name, transport, ranks)
    assert compare(of_one_rank, folder) is None


@pytest.mark.mpi
def test_a_range_that_needs_all_pairs_refuses_several_ranks(tmp_path: Path, capfd) -> None:
    words = ["run", "hot_bar", "--transport", "mpi", "--out", str(tmp_path / "run")]
    settings = ["components.bar.ranks=2", 'components.bar.damping.range="all"', "end=0.5"]
    with pytest.raises(SystemExit) as ended:
        main([*words, *(word for setting in settings for word in ("--set", setting))])
    assert ended.value.code == 2
    said = capfd.readouterr().err
    assert "damping: the range all needs every pair of points" in said and "Take one rank" in said
