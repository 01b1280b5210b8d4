"""Limiters of slopes let no total variation grow; tubes are computed with each limiter."""

from itertools import pairwise

import pytest
from gases import SOD, output, run, tube

from quintet.components.meshless_gas.exact.riemann import Side, star
from quintet.components.meshless_gas.laws.limiters import LAWS
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.params import read

FROM_FLAT_TO_STEEP = ("minmod", "van_leer", "superbee")
DIFFERENCES = [(a, b) for a in (0.01, 0.3, 0.5, 1.0, 2.0, 3.0, 100.0) for b in (0.5, 1.0)]


def change(name, upwind, across):
    return LAWS[name].py_func(upwind, across, 0.0)


@pytest.mark.parametrize("name", LAWS)
def test_a_limited_change_lets_no_total_variation_grow(name):
    # Sweby, SIAM J. Numer. Anal. 21 (1984) 995: between 0 and each of both differences.
    for upwind, across in DIFFERENCES:
        limited = change(name, upwind, across)
        assert 0.0 <= limited <= min(upwind, across) * (1.0 + 1e-12)
        assert change(name, -upwind, -across) == -limited
        assert change(name, upwind, -across) == 0.0
    assert change(name, 0.7, 0.7) == pytest.approx(0.35)


def test_limiters_are_as_steep_as_their_papers_say():
    for upwind, across in DIFFERENCES:
        changes = [change(name, upwind, across) for name in FROM_FLAT_TO_STEEP]
        assert all(a <= b for a, b in pairwise(changes))
    assert change("superbee", 1.0, 3.0) == pytest.approx(1.0)  # φ = 2r, r = 1/3
    assert change("van_leer", 1.0, 3.0) == pytest.approx(0.75)  # 2r/(1 + r)
    assert change("koren", 1.0, 1.25) == pytest.approx(3.5 / 6.0)  # (r + 2)/3


VAN_ALBADA = {"limiter": "van_albada"}


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"limiter": "superbee", "limiter_threshold": 1e-3}, "is of van Albada's limiter"),
        ({"limiter": "superbee", "limiter_threshold": 0.0}, None),
        ({"limiter": "superbee"}, None),
        (VAN_ALBADA | {"limiter_threshold": 0.0}, "above 0 with"),  # it divides nothing by nothing
        (VAN_ALBADA | {"limiter_threshold": 1e-3}, None),
        ({"limiter_threshold": 1e-3}, 'say limiter = "van_albada"'),
    ],
)
def test_a_threshold_is_van_albadas(keys, sentence):
    box = {"lowest": [0.0] * 3, "highest": [1.0, 0.0, 1.0], "spacing": 0.1}
    table = {"box": box, "initial": {"density": 1.0, "pressure": 1.0}, **keys}
    mistakes = read(MeshlessGasParams, table, "gas")[1]
    assert len(mistakes) == (sentence is not None) and all(
        sentence in mistake for mistake in mistakes
    )


def test_sods_tube_is_of_first_order_and_does_not_overshoot():
    pressure, velocity = star(Side(*SOD[0]), Side(*SOD[1]), 1.4)
    errors = []
    for nodes in (100, 200, 400):
        gas = run(tube(nodes, *SOD, limiter="superbee"), 0.2)
        errors.append(output(gas, "error.density")[0])
        x, state = gas.motion.domain.cloud.positions[: gas.items(), 0], gas.state.primitive
        for q, low, high in ((0, SOD[1][0], SOD[0][0]), (4, SOD[1][2], SOD[0][2])):
            assert low - 1e-3 < state[:, q].min() and state[:, q].max() < high + 1e-3
        assert state[:, 1].min() > -2e-3 and state[:, 1].max() < velocity + 0.02
        # From the rarefaction to the contact, and from there to the shock.
        near = (x > 0.6) & (x < 0.6854)
        behind = SOD[0][0] * (pressure / SOD[0][2]) ** (1.0 / 1.4)
        assert state[near, 0].max() < behind + 0.01
    assert errors[1] < 4.3e-3
    assert errors[0] > 2.0 * errors[1] and errors[1] > 2.0 * errors[2]


# Mean errors of the density [kg/m3] with 200 nodes: Sod's tube, two streams that collide (Noh), and
# the left half of Woodward and Colella's.
@pytest.mark.full  # a kernel of its own each
@pytest.mark.parametrize(
    ("name", "sod", "noh", "blast"),
    [
        ("van_albada", 4.0e-3, 0.035, 0.12),
        ("minmod", 4.7e-3, 0.035, 0.14),
        ("van_leer", 3.6e-3, 0.035, 0.12),
        ("koren", 3.4e-3, 0.035, 0.11),
        ("superbee", 2.8e-3, 0.042, 0.10),
    ],
)
def test_tubes_are_computed_with_every_limiter(name, sod, noh, blast):
    tubes = [
        (*SOD, 0.2, sod),
        ((1.0, 1.0, 1e-6), (1.0, -1.0, 1e-6), 1.0, noh),
        ((1.0, 0.0, 1000.0), (1.0, 0.0, 0.01), 0.012, blast),
    ]
    for left, right, end, within in tubes:
        assert output(run(tube(200, left, right, limiter=name), end), "error.density")[0] < within
