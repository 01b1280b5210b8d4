"""A stream in an open channel, coarse: Nusselt's film, and a mass balance that closes."""

from collections.abc import Callable

import pytest

Run = Callable[..., dict]


@pytest.fixture(scope="module")
def channel(run_scene: Run) -> dict:
    return run_scene("open_channel", "--preset", "quick")


@pytest.mark.parametrize(
    "name", ["discharge", "velocity.low", "velocity.middle", "velocity.high", "level"]
)
def test_the_stream_is_that_of_nusselt(channel: dict, name: str) -> None:
    expected = channel["by_name"][name]
    assert expected["met"], expected


def test_every_particle_is_in_the_mass_balance_once(channel: dict) -> None:
    balance = channel["ledger"]["mass_balance"]["water"]
    assert balance["residual"] < 1e-14
    masses = balance["kg"]
    assert masses.keys() == {
        "at the start", "entered by the inflow x-", "left by the outflow x+",
    }  # fmt: skip
    through = 1000.0 * 0.040672 * 3.0  # kg over a metre, in 3 s
    assert masses["entered by the inflow x-"] == pytest.approx(through, rel=0.01)
    assert masses["left by the outflow x+"] == pytest.approx(-through, rel=0.01)
