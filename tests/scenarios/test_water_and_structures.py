"""Water on and around elastic structures in two dimensions: the link, and their motion."""

import csv
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import skfem
from skfem.helpers import ddot, div, sym_grad

from quintet.coupler.cli import main
from quintet.coupler.files.recording import Recording
from quintet.coupler.report.diff import compare
from quintet.coupler.run import snapshots
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load

Run = Callable[..., dict]
# In three dimensions: a strip of both, between planes of symmetry along y.
STRIP = (
    "components.gate.dimensions=3",
    "components.gate.parts.0.highest=[0.105,0.0125,0.079]",
    "components.gate.fixed=[{lowest=[0.1,0.0,0.079],highest=[0.105,1.0,0.079]},"
    "{lowest=[0.1,0.0,0.0],highest=[0.105,1.0,0.079],directions=['y']}]",
    "components.water.dimensions=3",
    "components.water.fluid=[{lowest=[0.0,0.0,0.0],highest=[0.1,0.0125,0.14]}]",
    "components.water.boundary.walls={lowest=[0.0,0.0,0.0],highest=[0.4,0.0125,0.25]}",
    "components.water.boundary.obstacles=[{lowest=[0.1,0.0,0.079],highest=[0.105,0.0125,0.2]}]",
    "components.water.boundary.symmetry=['y-','y+']",
    "study=[]",
)


def _options(settings: tuple[str, ...]) -> list[str]:
    return [word for setting in settings for word in ("--set", setting)]


def _repetitions(folder: Path) -> list[int]:
    with (folder / "convergence.csv").open() as file:
        return [int(row["repetitions"]) for row in csv.DictReader(file)]


def _moved(folder: Path) -> float:
    """Displacement [m] of the gate's free edge at the end of a run."""
    with Recording(folder) as recording:
        return float(recording.field("gate", "node_gauge.position")[-1, 0, 0] - 0.105)


def test_water_on_a_plate_bends_it_and_the_link_conserves_momentum(run_scene: Run) -> None:
    short = _options(("end=0.02",))
    results = run_scene("water_on_plate", "--preset", "quick", "--transport", "memory", *short)
    (link,) = results["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert link["angular_residual"] <= 1e-12
    assert link["energy_residual"] < 1e-3
    # The plate bears nearly all of the water's weight over 0.02 s, the walls some at its ends.
    assert link["impulse"][2] == pytest.approx(-19620.0 * 0.02, rel=0.1)


def test_the_plate_under_the_water_bends_by_its_reference() -> None:
    """Plane strain under an even pressure, by quadratic elements; 66.2 µm, as the scene says."""
    youngs, ratio, pressure = 6.75e10, 0.34, 19620.0
    lame, shear = youngs * ratio / (1 + ratio) / (1 - 2 * ratio), youngs / 2 / (1 + ratio)
    along = np.concatenate([0.5 * np.linspace(0, 1, 41) ** 2, 1 - 0.5 * np.linspace(1, 0, 41) ** 2])
    mesh = skfem.MeshQuad.init_tensor(np.unique(along), np.linspace(-0.05, 0.0, 9))
    element = skfem.ElementVector(skfem.ElementQuad2())
    inside = skfem.Basis(mesh, element)
    top = skfem.FacetBasis(mesh, element, facets=mesh.facets_satisfying(lambda x: x[1] > -1e-9))
    stiffness = skfem.BilinearForm(
        lambda u, v, _: lame * div(u) * div(v) + 2 * shear * ddot(sym_grad(u), sym_grad(v))
    ).assemble(inside)
    load_ = skfem.LinearForm(lambda v, _: -pressure * v[1]).assemble(top)
    ends = inside.get_dofs(lambda x: np.abs(x[0] - 0.5) > 0.5 - 1e-9)
    displacement = skfem.solve(*skfem.condense(stiffness, load_, D=ends))
    middle = inside.probes(np.array([[0.5], [-0.025]])) @ displacement
    assert middle[1] == pytest.approx(-6.62e-5, rel=2e-3)


@pytest.mark.parametrize(("acceleration", "most_repetitions"), [("iqn-ils", 4.0), ("aitken", 4.0)])
def test_a_gate_lighter_than_its_water_is_iterated_in_few_repetitions(
    run_scene: Run, acceleration: str, most_repetitions: float
) -> None:
    """Wetted on one side, sampled on all: both sides of the link do the same work."""
    chosen = ("end=0.005", "window=2e-4", f"iteration.acceleration={acceleration}")
    results = run_scene("elastic_gate", *_options(chosen))
    (link,) = results["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert link["energy_residual"] < 0.02
    repeated = _repetitions(results["folder"])
    assert sum(repeated) / len(repeated) < most_repetitions


def test_a_plate_thinner_than_the_water_can_see_is_refused(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    thin = (
        "components.gate.parts.0.highest=[0.102,1.0,0.079]",
        "components.gate.coupled_faces=[{lowest=[0.1,0.0,0.0],highest=[0.102,1.0,0.079]}]",
        "end=1e-3",
    )
    with pytest.raises(SystemExit) as ended:
        main(["run", "elastic_gate", "--out", f"{tmp_path}/thin", *_options(thin)])
    assert ended.value.code == 2
    message = " ".join(capsys.readouterr().err.split())
    assert "a body must be at least 0.0025 m thick between its faces" in message


BITS = ("end=1.2e-3", "window=2e-4", "output.snapshots=4e-4", "output.pictures=[]", "expect=[]")


@pytest.fixture(scope="module")
def in_memory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A short run in this process, with all its snapshots."""
    folder = tmp_path_factory.mktemp("gate") / "memory"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(snapshots, "remove", lambda paths: None)
        scene = load("elastic_gate", settings=BITS, transport="memory")
        make_folder(scene, folder)
        assert simulate(scene, folder) == 0
    return folder


@pytest.mark.parametrize(
    "transport",
    [
        pytest.param("zenoh", marks=pytest.mark.zenoh),
        pytest.param("mpi", marks=pytest.mark.mpi),
    ],
)
def test_every_transport_gives_the_same_bits(
    in_memory: Path, tmp_path: Path, transport: str
) -> None:
    chosen = _options(BITS)
    out = ["--out", str(tmp_path / transport), "--transport", transport]
    with pytest.raises(SystemExit) as ended:
        main(["run", "elastic_gate", *out, *chosen])
    assert ended.value.code == 0
    assert compare(in_memory, tmp_path / transport) is None


def test_resumed_from_a_snapshot_it_goes_on_with_the_same_bits(
    in_memory: Path, tmp_path: Path
) -> None:
    resumed = tmp_path / "again"
    shutil.copytree(in_memory, resumed)
    files = sorted(resumed.glob("snapshot-*.h5"), key=snapshots.window_of)
    assert len(files) >= 2
    assert simulate(load("elastic_gate", settings=BITS, transport="memory"), resumed, files[0]) == 0
    assert compare(in_memory, resumed) is None


@pytest.mark.full
def test_a_strip_between_planes_of_symmetry_does_as_plane_strain(run_scene: Run) -> None:
    short = ("end=0.02", "window=2e-4")
    flat = run_scene("elastic_gate", *_options(short))
    strip = run_scene("elastic_gate", *_options((*short, *STRIP)))
    assert _moved(flat["folder"]) > 2e-3
    assert _moved(strip["folder"]) == pytest.approx(_moved(flat["folder"]), rel=0.05)
