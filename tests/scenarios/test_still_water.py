"""Water at rest, coarse: it stays where it is, under its hydrostatic pressure."""

from collections.abc import Callable

import pytest

Run = Callable[..., dict]

NOISE = pytest.mark.xfail(
    strict=True, raises=AssertionError, reason="dynamic walls push water off and make noise"
)


@pytest.fixture(scope="module")
def found(run_scene: Run) -> dict:
    return run_scene("still_water", "--preset", "quick")


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("floor.pressure", marks=NOISE),
        "middle.pressure",
        pytest.param("wall.pressure", marks=NOISE),
        "level",
        pytest.param("speed", marks=NOISE),
    ],
)
def test_still_water_stays_still(found: dict, name: str) -> None:
    one = found["by_name"][name]
    assert one["met"], one
