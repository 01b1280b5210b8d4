"""Bodies of every kind in a fluid of two dimensions: momentum, plane motion, measured loads."""

from collections.abc import Callable
from pathlib import Path

import pytest

from quintet.coupler.files.recording import Recording

Run = Callable[..., dict]
SCENE = str(Path(__file__).parent / "small_flume.toml")
DRY = ["--set", "components.bodies.bodies.0.centre=[0.3, 0.0, 5.0]"]
DRY += ["--set", "components.bodies.bodies.1.origin=[0.26, 0.0, 6.0]"]


@pytest.mark.parametrize("scheme", ["serial", "parallel", "iterated"])
def test_links_conserve_momentum_and_nothing_leaves_the_plane(run_scene: Run, scheme: str) -> None:
    results = run_scene(SCENE, "--set", f"scheme={scheme}", "--set", "end=0.15")
    assert results["status"] == "done"
    for link in results["ledger"]["links"]:
        assert link["momentum_residual"] < 1e-12, link
        assert link["kinematic_residual"] < 1e-12, link
    with Recording(results["folder"]) as recording:
        for name in ("bodies", "block"):
            for field, out in (("velocity", [1]), ("angular_velocity", [0, 2])):
                assert not recording.field(name, f"motion.{field}")[:, :, out].any()


def test_bodies_meet_in_the_water(run_scene: Run) -> None:
    results = run_scene(SCENE)
    with Recording(results["folder"]) as recording:
        contact = recording.field("bodies", "contact.force")
        height = recording.field("bodies", "motion.position")[:, :, 2]
        times = recording.times("bodies")
    assert contact[:, :2].any() and not contact[:, :2, 1].any()
    # Free fall would have brought them to the floor.
    assert 0.5 - times[-1] - 0.5 * 9.81 * times[-1] ** 2 < 0.0 < height.min()


def test_the_load_on_a_fixed_block_is_the_weight_of_its_area(run_scene: Run) -> None:
    results = run_scene(SCENE, *DRY, "--set", "end=0.4")
    with Recording(results["folder"]) as recording:
        impulse = recording.field("block", "measured_load.force")[:, 0]  # N s, of each window
        late = recording.times("block") > 0.2
    mean = impulse[late].mean(axis=0) / 1e-3 / (9810.0 * 0.12**2)
    assert mean[2] == pytest.approx(1.0, abs=0.01)
    assert abs(mean[0]) < 0.01 and mean[1] == 0.0
