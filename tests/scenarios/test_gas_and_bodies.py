"""Bodies that fly through a gas with clouds of their own."""

from collections.abc import Callable, Iterator

import pytest

from quintet.coupler.scene.read import library, load, parse
from quintet.scenarios.moving_sphere.compare import Flight, flight

Run = Callable[..., dict]
Fly = Callable[[str], Flight]
# A body fixed in a stream, and the same with half or all of the relative velocity of its own.
SAME = {
    "10 spacings on a radius": ("fixed", ("half", "")),
    "20 spacings on a radius": ("fine_fixed", ("fine_half", "fine")),
    "no slip": ("no_slip_fixed", ("no_slip",)),
    "34 degrees to the lattice": ("oblique_fixed", ("oblique",)),
}


@pytest.fixture(scope="module")
def fly(run_scene: Run) -> Fly:
    """Run a preset of `moving_sphere` once; return what its body felt."""
    known: dict[str, Flight] = {}

    def made(preset: str) -> Flight:
        if preset not in known:
            found = run_scene("moving_sphere", *(("--preset", preset) if preset else ()))
            assert all(one["met"] for one in found["expect"]), found["expect"]
            known[preset] = flight(found["folder"])
        return known[preset]

    return made


def driven_bodies() -> Iterator[tuple[str, list[dict], list[dict]]]:
    """Scenes and presets with driven bodies: these bodies, and the spheres of the partner."""
    for name, path in library().items():
        if "is_driven" not in path.read_text():
            continue
        for preset in ("", *parse(path)["presets"]):
            tables = load(name, preset).resolved["components"]
            bodies = [
                body
                for table in tables.values()
                for body in table.get("moving", {}).get("bodies", ())
                if body.get("is_driven")
            ]
            if bodies:
                spheres = [s for table in tables.values() for s in table.get("spheres", ())]
                yield f"{name} {preset}".strip(), bodies, spheres


def test_driven_bodies_of_scenes_stand_where_their_partner_has_them() -> None:
    """A run refuses other places, smaller bodies and another number of them, too."""
    scenes = list(driven_bodies())
    assert len(scenes) >= 4
    for name, bodies, spheres in scenes:
        assert [b["centre"] for b in bodies] == [s["centre"] for s in spheres], name
        # Larger spheres keep bodies apart where they strike each other.
        pairs = zip(bodies, spheres, strict=True)
        assert all(b["radius"] == s["radius"] or len(bodies) > 1 for b, s in pairs), name


@pytest.mark.full
@pytest.mark.parametrize("name", SAME)
def test_what_a_body_feels_does_not_depend_on_who_moves(fly: Fly, name: str) -> None:
    preset, others = SAME[name]
    fixed = fly(preset)
    for one in (fixed, *map(fly, others)):
        assert one.error < 0.005 * one.mean
        assert one.mean == pytest.approx(fixed.mean, rel=0.02)
        assert max(one.pressure_off(fixed)) < 0.02


@pytest.mark.full
def test_a_finer_cloud_makes_less_of_a_difference_between_moving_and_fixed(fly: Fly) -> None:
    def off(name: str) -> float:
        preset, others = SAME[name]
        return max(abs(fly(one).mean / fly(preset).mean - 1.0) for one in others)

    assert off("20 spacings on a radius") < off("10 spacings on a radius") < 0.006


@pytest.mark.full
def test_a_body_that_moves_costs_a_node_little_more_than_one_that_is_fixed(fly: Fly) -> None:
    assert fly("oblique").cost < 2.0 * fly("oblique_fixed").cost


@pytest.mark.full
def test_half_of_the_way_is_enough_for_a_first_look(run_scene: Run) -> None:
    found = run_scene("moving_sphere", "--preset", "quick")
    assert all(one["met"] for one in found["expect"]), found["expect"]


@pytest.mark.full
def test_a_particle_that_crosses_a_shock_layer_drives_a_ring_of_heat_outwards(
    run_scene: Run,
) -> None:
    found = run_scene("shock_layer_particle")
    assert all(one["met"] for one in found["expect"]), found["expect"]
    assert all(one["momentum_residual"] <= 1e-12 for one in found["ledger"]["links"])


@pytest.mark.full
def test_heat_flux_at_a_sphere_is_that_of_fay_and_riddell(run_scene: Run) -> None:
    found = run_scene("shock_layer_particle", "--preset", "alone")
    assert all(one["met"] for one in found["expect"]), found["expect"]
