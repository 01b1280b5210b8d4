"""Bodies that fly through a gas with clouds of their own."""

from collections.abc import Callable

import pytest

from quintet.coupler.scene.read import library, load, parse
from quintet.interfaces.errors import SceneError
from quintet.scenarios.moving_sphere.compare import Flight, flight

Run = Callable[..., dict]
Fly = Callable[[str], Flight]
# Presets of a body fixed in a stream, and of one that moves at half or all of the relative speed.
SAME = {
    "10 spacings on a radius": ("fixed", ("half", "")),
    "20 spacings on a radius": ("fine_fixed", ("fine_half", "fine")),
    "no slip": ("no_slip_fixed", ("no_slip",)),
    "34 degrees to the lattice": ("oblique_fixed", ("oblique",)),
}


@pytest.fixture(scope="module")
def fly(run_scene: Run) -> Fly:
    """Run each preset of `moving_sphere` once; return the flight of its body."""
    flights: dict[str, Flight] = {}

    def run_preset(preset: str) -> Flight:
        if preset not in flights:
            results = run_scene("moving_sphere", *(("--preset", preset) if preset else ()))
            assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
            flights[preset] = flight(results["folder"])
        return flights[preset]

    return run_preset


def test_driven_bodies_of_scenes_are_described_by_their_partner_alone() -> None:
    presets = {
        (name, preset)
        for name, path in library().items()
        if "is_driven" in path.read_text()
        for preset in ("", *parse(path)["presets"])
    }
    driven = 0
    for name, preset in presets:
        scene = load(name, preset)
        table, plan = scene.resolved["components"]["gas"], scene.components["gas"].checked
        spheres = scene.resolved["components"].get("particle", {}).get("spheres", ())
        tables = [body for body in table["moving"]["bodies"] if body.get("is_driven")]
        bodies = [body for body in plan.moving.bodies if body.is_driven]
        assert not any("centre" in body for body in tables), (name, preset)
        if not bodies:
            continue
        assert [list(body.centre) for body in bodies] == [s["centre"] for s in spheres]
        for body, sphere in zip(bodies, spheres, strict=True):
            # Larger spheres keep bodies apart where they strike each other.
            assert body.radius == sphere["radius"] or len(bodies) > 1
        driven += len(bodies)
    assert driven >= 6


def driving(body: str, sphere: str = "centre = [-1.0, 0.0, 0.0], radius = 0.1") -> list[str]:
    """Settings of a scene whose sphere is a body in the gas."""
    round_it = "points_around = 40, thickness = 0.25, spacing = 0.04, is_driven = true"
    return [
        f"components.gas.moving.bodies=[{{ {round_it}{body} }}]",
        f"components.particle.spheres=[{{ {sphere}, density = 300.0 }}]",
    ]


def test_a_driven_body_takes_its_place_and_size_from_its_partner() -> None:
    gas = load("shock_layer_particle", settings=driving("")).components["gas"]
    (body,) = gas.checked.moving.bodies
    assert (body.centre, body.radius) == ((-1.0, 0.0, 0.0), 0.1)
    (smaller,) = (
        load("shock_layer_particle", settings=driving(", radius = 0.07"))
        .components["gas"]
        .checked.moving.bodies
    )
    assert smaller.radius == 0.07


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (driving(", centre = [-1.0, 0.0, 0.0]"), r"bodies.0.centre: .* Leave it out"),
        ([*driving(""), "links=[]"], "must have centre and radius, .* stated by its partner"),
        (driving("", "centre = [-1.0, 0.0, 0.0], radius = 0.1, copies = { number = [2, 1, 1], "
                 "spacing = [0.5, 0.5, 0.5] }"), "1 driven bodies and 2 of the partner"),
    ],
)  # fmt: skip
def test_driven_bodies_that_are_described_twice_or_never_are_refused(
    settings: list[str], message: str
) -> None:
    with pytest.raises(SceneError, match=message):
        load("shock_layer_particle", settings=settings)


def test_a_mistake_of_a_partner_is_reported_alone() -> None:
    with pytest.raises(SceneError) as error:
        load("shock_layer_particle", settings=driving("", "centre = [-1.0, 0.0, 0.0]"))
    assert len(error.value.mistakes) == 1 and "radius" in str(error.value)


@pytest.mark.full
@pytest.mark.parametrize("name", SAME)
def test_what_a_body_feels_does_not_depend_on_who_moves(fly: Fly, name: str) -> None:
    fixed_preset, moving_presets = SAME[name]
    fixed = fly(fixed_preset)
    for result in (fixed, *map(fly, moving_presets)):
        assert result.error < 0.005 * result.mean
        assert result.mean == pytest.approx(fixed.mean, rel=0.02)
        assert max(result.pressure_off(fixed)) < 0.02


@pytest.mark.full
def test_a_finer_cloud_makes_less_of_a_difference_between_moving_and_fixed(fly: Fly) -> None:
    def off(name: str) -> float:
        fixed_preset, moving_presets = SAME[name]
        return max(
            abs(fly(moving_preset).mean / fly(fixed_preset).mean - 1.0)
            for moving_preset in moving_presets
        )

    assert off("20 spacings on a radius") < off("10 spacings on a radius") < 0.006


@pytest.mark.full
def test_a_body_that_moves_costs_a_node_little_more_than_one_that_is_fixed(fly: Fly) -> None:
    assert fly("oblique").cost < 2.0 * fly("oblique_fixed").cost


@pytest.mark.full
def test_half_of_the_way_is_enough_for_a_first_look(run_scene: Run) -> None:
    results = run_scene("moving_sphere", "--preset", "quick")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]


@pytest.mark.full
def test_a_particle_that_crosses_a_shock_layer_drives_a_ring_of_heat_outwards(
    run_scene: Run,
) -> None:
    results = run_scene("shock_layer_particle")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
    assert all(link["momentum_residual"] <= 1e-12 for link in results["ledger"]["links"])


@pytest.mark.full
def test_heat_flux_at_a_sphere_is_that_of_fay_and_riddell(run_scene: Run) -> None:
    results = run_scene("shock_layer_particle", "--preset", "alone")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
