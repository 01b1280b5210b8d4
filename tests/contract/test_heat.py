"""A wall and a slab find the temperature between them, and no joule is lost on the way."""

import laboratory
import numpy as np
import pytest

from quintet.interfaces.errors import SceneError

HOT, COLD, SLAB, WALL = 400.0, 300.0, 4.0, 15.0  # K, K, W/K, W/K
BETWEEN = (SLAB * HOT + WALL * COLD) / (SLAB + WALL)  # K, of conductances one after the other


def _run(folder, relaxation=None, windows=60, scheme="serial", noise=0.0, order=("slab", "wall")):
    components = {
        "slab": {"kind": "toy_heat:Slab", "conductance": SLAB / 4},
        "wall": {"kind": "toy_heat:Wall", "conductance": WALL / 4, "noise": noise},
    }
    link = {"kind": "heat", "name": "heat", "between": ["wall", "slab"]}
    link |= {} if relaxation is None else {"relaxation": relaxation}
    settings = {"window": 0.1, "end": 0.1 * windows, "scheme": scheme, "order": list(order)}
    return laboratory.couple(laboratory.scene(folder, components, link, **settings))


def _mean(trace):
    """Mean temperature of the slab's nodes at the windows' ends [K]."""
    return trace.history("slab", "node_temperature.temperature").mean(axis=1)


@pytest.mark.parametrize("order", [("slab", "wall"), ("wall", "slab")])
@pytest.mark.parametrize("relaxation", [0.2, [0.5, 0.3, 0.2], [0.1, 0.1, 0.15]])
def test_relaxed_from_window_to_window_it_converges(tmp_path, relaxation, order):
    trace = _run(tmp_path, relaxation, order=order)
    assert _mean(trace)[-1] == pytest.approx(BETWEEN, rel=1e-6)


def test_a_whole_change_of_temperature_overshoots_without_bound(tmp_path):
    """The wall conducts 3.75 times as well as the slab."""
    errors = np.abs(_mean(_run(tmp_path, windows=40)) - BETWEEN)
    assert errors[-1] > 1e3 * errors[1]


def test_iterated_it_needs_no_relaxation(tmp_path):
    """Over a window the wall sees a straight line from the last temperature to the next."""
    error = _mean(_run(tmp_path, scheme="iterated", windows=30)) - BETWEEN
    gain = 0.5 * WALL / SLAB
    np.testing.assert_allclose(error[2:10] / error[1:9], -gain / (1.0 + gain), rtol=1e-3)


@pytest.mark.parametrize("scheme", ["serial", "parallel"])
def test_every_joule_that_leaves_the_wall_reaches_the_slab(tmp_path, scheme):
    trace = _run(tmp_path, 0.2, scheme=scheme, noise=0.3)
    assert trace.account.heat_residual <= 1e-12
    in_transit = laboratory.in_transit(trace, "wall", "wall_heat.heat_flow")
    lost, gained = (trace.components[name].totals().internal for name in ("wall", "slab"))
    assert trace.account.heat == pytest.approx(gained, rel=1e-12)
    assert -lost - float(in_transit) == pytest.approx(gained, rel=1e-12)
    assert trace.coupling.ledger.summary()["links"][0]["heat"] == trace.account.heat


def test_with_noise_the_mean_of_many_windows_is_right(tmp_path):
    temperatures = _mean(_run(tmp_path, 0.1, windows=400, noise=0.2))[100:]
    assert temperatures.mean() == pytest.approx(
        BETWEEN, abs=4.0 * temperatures.std() / np.sqrt(len(temperatures) / 10)
    )
    assert 0.5 < temperatures.std() < 5.0


@pytest.mark.parametrize(
    ("relaxation", "scheme", "words"),
    [
        (1.5, "serial", r"links.0.relaxation should be less than or equal to 1 or .*found 1.5"),
        ([], "serial", r"found \[\]"),
        (0.5, "iterated", "scene.scheme must be serial or parallel for link heat"),
    ],
)
def test_what_a_relaxation_may_be(tmp_path, relaxation, scheme, words):
    with pytest.raises(SceneError, match=words):
        _run(tmp_path, relaxation, scheme=scheme)
