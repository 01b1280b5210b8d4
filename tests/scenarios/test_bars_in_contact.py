"""Two bars of elements that strike each other face to face exchange their velocities."""

from collections.abc import Callable

import numpy as np

from quintet.coupler.files.recording import Recording

Run = Callable[..., dict]


def test_bars_of_unlike_meshes_exchange_their_velocities(run_scene: Run) -> None:
    results = run_scene("bars_in_contact", "--transport", "memory")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
    (link,) = results["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert link["energy_residual"] < 0.02
    assert results["energy_gained"] < 0.01
    assert results["warnings"] == []
    # Elements across the bars bear the same pressure, though the meshes do not match.
    with Recording(results["folder"]) as recording:
        for name in ("left", "right"):
            times = recording.times(name)
            touching = (times > 6e-6) & (times < 2.8e-5)
            pressure = np.stack([
                recording.history(name, "element_gauge.pressure", item)[touching]
                for item in range(3)
            ])  # fmt: skip
            mean = pressure.mean(axis=1)
            assert np.abs(mean / mean.mean() - 1.0).max() < 0.01
