"""Scenes of gas and of particles: the same bits over every transport, and after a resumption."""

import shutil
from pathlib import Path

import pytest

from quintet.coupler.cli import main
from quintet.coupler.files.recording import Recording
from quintet.coupler.report.diff import compare
from quintet.coupler.run import snapshots
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load

PLAIN = ("output.pictures=[]", "expect=[]", "study=[]", "stability=[]")
LAUNCH = "components.particle.spheres.0.launch"
SPHERE = "components.gas.sphere"
# Preset, end and window [s], and further settings of a short run; the first snapshot is at 0.3 end.
SCENES = {
    "shock_tube": ("quick", 0.06, 5e-3, ()),
    "vortex": ("quick", 0.6, 0.05, ()),
    "wedge": ("quick", 0.12, 0.02, ()),
    "couette": ("quick", 6.0, 0.5, ()),
    "flat_plate": ("quick", 0.3, 0.05, ()),
    "blunt_sphere": ("quick", 0.3, 0.05, ()),
    "blunt_sphere hot": ("hot", 0.012, 2e-3, (f"{SPHERE}.layers.count=16",)),
    "blunt_sphere cap": (
        "cap",
        0.06,
        0.01,
        (f"{SPHERE}.points_around=16", f"{SPHERE}.layers.count=12"),
    ),
    "moving_sphere": ("quick", 0.4, 1.0 / 30.0, ()),
    "moving_sphere oblique": ("oblique", 0.2, 1.0 / 30.0, ()),
    "moving_sphere no_slip": ("no_slip", 0.1, 1.0 / 30.0, ()),
    "shock_layer_particle": ("", 0.08, 0.01, (f"{LAUNCH}=0.02",)),
    "shock_layer_particle two": ("two", 0.12, 0.01, (f"{LAUNCH}=0.02",)),
    "dust_in_stream": ("", 6e-4, 8e-6, ()),
    "dusty_shock": ("quick", 3e-4, 1e-5, ()),
    "newtons_cradle": ("quick", 0.9, 2e-3, ()),
}
MOVES = {  # fields that must change, so that bits are compared of a motion
    "moving_sphere": ("gas", "bodies.fresh_nodes"),
    "shock_layer_particle": ("particle", "motion.position"),
}
# These short runs warn, with status 1, that their flow has not settled.
UNSETTLED = {"flat_plate", "blunt_sphere", "blunt_sphere hot", "blunt_sphere cap"}


def settings_of(name: str) -> tuple[str, str, tuple[str, ...]]:
    """Scene, preset and settings of a short run."""
    preset, end, window, extra = SCENES[name]
    short = (f"end={end}", f"window={window}", f"output.snapshots={0.3 * end}")
    return name.split()[0], preset, (*short, *PLAIN, *extra)


@pytest.fixture(scope="module", params=SCENES)
def in_memory(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[str, Path]:
    """A short run in this process, with all its snapshots."""
    name = request.param
    folder = tmp_path_factory.mktemp("gas") / "memory"
    scene, preset, settings = settings_of(name)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(snapshots, "remove", lambda paths: None)
        loaded = load(scene, preset, settings, transport="memory")
        make_folder(loaded, folder)
        assert simulate(loaded, folder) == (name in UNSETTLED)
    return name, folder


@pytest.mark.full
@pytest.mark.parametrize(
    "transport",
    [
        pytest.param("zenoh", marks=pytest.mark.zenoh),
        pytest.param("mpi", marks=pytest.mark.mpi),
    ],
)
def test_every_transport_gives_the_same_bits(
    in_memory: tuple[str, Path], tmp_path: Path, transport: str
) -> None:
    name, first = in_memory
    scene, preset, settings = settings_of(name)
    words = [word for setting in settings for word in ("--set", setting)]
    words += ["--preset", preset] if preset else []
    with pytest.raises(SystemExit) as ended:
        main(["run", scene, "--out", str(tmp_path / "run"), "--transport", transport, *words])
    assert ended.value.code == (name in UNSETTLED)
    assert compare(first, tmp_path / "run") is None


@pytest.mark.full
def test_from_a_snapshot_it_goes_on_with_the_same_bits(
    in_memory: tuple[str, Path], tmp_path: Path
) -> None:
    name, first = in_memory
    scene, preset, settings = settings_of(name)
    resumed = tmp_path / "again"
    shutil.copytree(first, resumed)
    files = sorted(resumed.glob("snapshot-*.h5"), key=snapshots.window_of)
    assert len(files) >= 2
    loaded = load(scene, preset, settings, transport="memory")
    assert simulate(loaded, resumed, files[0]) == (name in UNSETTLED)
    assert compare(first, resumed) is None
    assert (first / "ledger.csv").read_bytes() == (resumed / "ledger.csv").read_bytes()
    if scene in MOVES:
        with Recording(first) as recording:
            values = recording.field(*MOVES[scene])
        assert (values[0] != values[-1]).any()
