"""Scenes whose components own several MPI ranks give the bits of one rank."""

from pathlib import Path

import pytest
from started import Started

from quintet.coupler.cli import main
from quintet.coupler.report.diff import compare

SHORT = {  # of each scene: the component that is divided, and settings of a short run
    "hot_bar_coupled": ("points", {"end": 0.8, "window": 0.1}),
}


def words(scene: str, transport: str, ranks: int, snapshots: float = 0.0) -> list[str]:
    name, settings = SHORT[scene]
    plain = {"output.interval": 0, "output.pictures": "[]", "output.snapshots": snapshots}
    plain |= settings
    if ranks > 1:
        plain[f"components.{name}.ranks"] = ranks
    pairs = [word for key, value in plain.items() for word in ("--set", f"{key}={value}")]
    return [*pairs, "--transport", transport]


def run(scene: str, *arguments: str) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["run", scene, *arguments])
    assert ended.value.code in (0, 1)  # too short for what the scene expects


@pytest.fixture(scope="module", params=SHORT)
def of_one_rank(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("one rank") / request.param
    run(request.param, *words(request.param, "memory", 1), "--out", str(folder))
    return folder


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
    scene, folder = of_one_rank.name, tmp_path / "run"
    run(scene, *words(scene, transport, ranks), "--out", str(folder))
    assert compare(of_one_rank, folder) is None


@pytest.mark.mpi
@pytest.mark.parametrize(
    ("ranks_before", "ranks_after"),
    [
        (2, 1),
        pytest.param(2, 3, marks=pytest.mark.full),
        pytest.param(1, 2, marks=pytest.mark.full),
    ],
)
def test_a_snapshot_of_a_scene_goes_on_with_any_number_of_ranks(
    tmp_path: Path, of_one_rank: Path, ranks_before: int, ranks_after: int
) -> None:
    scene, folder = of_one_rank.name, tmp_path / "run"
    interval = SHORT[scene][1]["window"]
    started = Started(Path(scene), *words(scene, "mpi", ranks_before, interval), out=folder)
    started.wait_until(lambda: list(folder.glob("snapshot-*.h5")), seconds=100.0)
    started.process.terminate()
    assert started.wait() == 130, started.err
    run(scene, *words(scene, "mpi", ranks_after, interval), "--resume", str(folder))
    assert compare(of_one_rank, folder) is None


@pytest.mark.mpi
def test_a_range_that_needs_all_pairs_refuses_several_ranks(tmp_path: Path, capfd) -> None:
    settings = ["components.bar.ranks=2", 'components.bar.damping.range="all"', "end=0.5"]
    pairs = [word for setting in settings for word in ("--set", setting)]
    with pytest.raises(SystemExit) as ended:
        main(["run", "hot_bar", "--transport", "mpi", "--out", str(tmp_path / "run"), *pairs])
    assert ended.value.code == 2
    text = capfd.readouterr().err
    assert "damping: the range all needs every pair of points" in text and "Take one rank" in text
