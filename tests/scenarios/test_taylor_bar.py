"""A steel bar strikes a rigid wall: length, foot, plastic strain and heat as published."""

from collections.abc import Callable

Run = Callable[..., dict]


def test_a_steel_bar_is_shortened_and_its_foot_spreads_as_published(run_scene: Run) -> None:
    results = run_scene("taylor_bar", "--preset", "quick")
    for name in ("length", "foot_diameter", "plastic_strain", "temperature"):
        assert results["by_name"][name]["met"], results["by_name"][name]
