"""Pistons and flaps that make waves, those that absorb, and damping zones."""

import math

import numpy as np
import pytest
from fluid_params import fluid_params
from pydantic import ValidationError

from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.setup.wave_theory import transfer
from quintet.interfaces.errors import StepError

SPACING = 0.02
BLOCK = ((-0.1, 0.0, 0.0), (0.0, 1.0, 0.4))
BOARD = ((-0.06, 0.0, -0.1), (0.0, 1.0, 0.4))  # reaches below the bed, about which it turns
BASE = {
    "spacing": SPACING,
    "sound_speed": 14.1,
    "dimensions": 2,
    "kernel": "wendland",
    "density_diffusion": 0.1,
    "integration": "symplectic",
    "courant": 1.0,
    "viscosity.artificial": 0.01,
    "boundary.method": "mdbc",
    "boundary.walls": ((-0.3, 0.0, 0.0), (0.8, 1.0, 0.4)),
    "boundary.obstacles": [BLOCK],
    "fluid": [((0.0, 0.0, 0.0), (0.8, 1.0, 0.2))],
}
REGULAR = {"paddle": "piston", "depth": 0.2, "height": 0.08, "period": 1.0}
SEA = {
    "paddle": "piston",
    "depth": 0.2,
    "spectrum": "jonswap",
    "significant_height": 0.08,
    "peak_period": 1.0,
    "seed": 3,
    "components": 20,
}
MOSKOWITZ = SEA | {"spectrum": "pierson_moskowitz", "peak_enhancement": 2.0}
SHALLOW = REGULAR | {"absorption": True, "depth": 0.195}
FLAP = REGULAR | {"paddle": "flap", "hinge": [-0.03, 0.0, 0.0]}
ZONE = {"lowest": [0.4, 0.0, 0.0], "highest": [0.8, 1.0, 0.4], "towards": "x+"}


def settings(waves, **changes):
    pistons = [{"part": "obstacles.0", "waves": waves}] if waves else []
    return (
        BASE | {"boundary.pistons": pistons} | {k.replace("__", "."): v for k, v in changes.items()}
    )


def fluid_with(waves, **changes):
    fluid = SphFluid(fluid_params(**settings(waves, **changes)))
    fluid.bind({}, frozenset())
    return fluid


@pytest.mark.parametrize("order", [1, 2])
def test_a_piston_moves_with_the_stroke_of_its_waves(order):
    params = fluid_params(**settings(REGULAR | {"order": order, "phase": 0.4}))
    waves = params.boundary.pistons[0].waves
    omega = 2.0 * math.pi
    stroke = 0.08 / transfer(omega, waves.water, 0)[1][0].real
    times = np.linspace(2.0, 3.0, 64, endpoint=False)
    places = np.array([waves.trajectory.at(t).place for t in times])
    assert not places[:, 1:].any()
    first, second = (2.0 * (places[:, 0] * np.exp(-1j * n * omega * times)).mean() for n in (1, 2))
    assert 2.0 * abs(first) == pytest.approx(stroke)
    assert (abs(second) > 1e-3) == (order == 2)
    assert waves.trajectory.at(0.0).place[0] == 0.0


def test_a_flap_turns_by_the_stroke_at_still_water():
    params = fluid_params(**settings(FLAP, boundary__obstacles=[BOARD]))
    waves = params.boundary.pistons[0].waves
    stroke = 0.08 / transfer(2.0 * math.pi, waves.water, 0)[1][0].real
    course = waves.trajectory.course()
    assert np.ptp(course[:, 3]) == pytest.approx(stroke / 0.2)
    assert not course[:, :3].any()
    assert waves.direction.tolist() == [0.0, 1.0, 0.0]


def test_irregular_waves_have_the_bits_of_their_seed():
    scenes = [fluid_params(**settings(SEA | {"seed": seed})) for seed in (3, 3, 4)]
    first, same_seed, other_seed = (
        p.boundary.pistons[0].waves.trajectory.at(7.7).place for p in scenes
    )
    assert np.array_equal(first, same_seed) and not np.array_equal(first, other_seed)


def test_a_sea_of_two_components_is_followed_until_both_are_at_their_extreme():
    """Their frequencies have no common period: the course reaches the sum of the amplitudes."""
    waves = fluid_params(**settings(SEA | {"components": 2})).boundary.pistons[0].waves
    motion = waves.trajectory
    amplitude = float(np.abs(motion.amplitudes).sum())
    assert motion.frequencies[1] != 2.0 * motion.frequencies[0]
    assert motion.course()[:, 0].max() == pytest.approx(amplitude, rel=0.02)


@pytest.mark.parametrize(
    ("waves", "changes"),
    [
        (REGULAR | {"order": 2, "absorption": True}, {}),
        (SEA, {}),
        (FLAP, {"boundary__obstacles": [BOARD]}),
    ],
)
@pytest.mark.parametrize("scheme", ["symplectic", "extrapolated"])
def test_a_saved_state_goes_on_with_the_same_bits(waves, changes, scheme):
    first, second = (
        fluid_with(waves | {"ramp": 0.2}, integration=scheme, boundary__damping=[ZONE], **changes)
        for _ in range(2)
    )
    dt = 4e-4
    for _ in range(60):
        first.step(dt)
    second.load(first.save())
    for _ in range(20):
        for fluid in (first, second):
            fluid.step(dt)
    for name, array in first.save().items():
        assert np.array_equal(array, second.save()[name]), name
    assert first.totals().work == second.totals().work
    assert first.damping.work < 0.0


def test_damping_takes_the_energy_that_it_counts():
    """A zone covers all of the water, without weight: it takes the energy that motion loses."""
    free = {"gravity": [0.0, 0.0, 0.0], "viscosity.artificial": 0.0}
    zone = ZONE | {"lowest": [0.0, 0.0, 0.0], "rate": 4.0}
    moving = {"initial": {"velocity": ["0.1", "0.0", "0.0"]}}
    open_tank = {"boundary.obstacles": [], "boundary.walls": ((-2.0, 0.0, -2.0), (3.0, 1.0, 2.0))}
    fluid = SphFluid(
        fluid_params(**BASE | free | moving | open_tank, **{"boundary.damping": [zone]})
    )
    fluid.bind({}, frozenset())
    start, x = fluid.totals(), fluid.state.position_density[: fluid.state.fluid, 0].copy()
    dt = 1e-4
    fluid.step(dt)
    kinetic, u = fluid.totals().kinetic, fluid.state.velocity_pressure[: fluid.state.fluid, 0]
    order, start_order = np.argsort(fluid.state.identity), np.argsort(x)
    assert np.sort(order).size == start_order.size
    assert fluid.damping.work == pytest.approx(kinetic - start.kinetic, rel=1e-6)
    share = np.sort(fluid.state.position_density[: fluid.state.fluid, 0]) / 0.8
    expected = 0.1 / (1.0 + 4.0 * dt * share**2)
    assert np.sort(u)[::-1] == pytest.approx(expected, rel=1e-6)
    assert fluid.totals().work == fluid.damping.work


def test_a_zone_points_to_the_side_that_it_says():
    correlations = {}
    for side in ("x+", "x-", "z+"):
        fluid = fluid_with({}, boundary__obstacles=[], boundary__damping=[ZONE | {"towards": side}])
        rows, strength = fluid.damping._inside(fluid.damping.zones[0], fluid.state)
        place = fluid.state.position_density[rows]
        correlations[side] = np.corrcoef(place[:, 0 if side[0] == "x" else 2], strength)[0, 1]
        assert place[:, 0].min() > 0.4 and 0.0 < strength.min() and strength.max() < 1.0
    assert correlations["x+"] > 0.9 and correlations["x-"] < -0.9 and correlations["z+"] > 0.9


def test_an_absorbing_piston_gives_way_to_water_that_is_too_high():
    """Water is 5 mm deeper than the waves of the paddle assume; the paddle sees a wave."""
    fluid = fluid_with(REGULAR | {"absorption": True, "ramp": 50.0})
    fluid.pistons.parts[0].correction.level -= 0.005
    fluid.step(2e-4)
    part = fluid.pistons.parts[0]
    assert part.added_velocity == pytest.approx(-math.sqrt(9.81 / 0.2) * 0.005, rel=0.25)
    for _ in range(100):
        fluid.step(2e-4)
    end = float(fluid.state.position_density[fluid.samples.row, 0].max())
    start = float(part.points[:, 0].max())
    assert end - start == pytest.approx(part.added, abs=2e-5)
    assert part.added < 0.0


def test_a_paddle_that_absorbs_stays_in_its_tank():
    waves = REGULAR | {"absorption": True}
    fluid = fluid_with(waves, boundary__walls=((-0.12, 0.0, 0.0), (0.8, 1.0, 0.4)))
    fluid.pistons.parts[0].added = -0.03
    with pytest.raises(StepError, match=r"obstacles.0 must stay in the tank; it absorbed"):
        fluid.step(2e-4)


def test_obstacles_that_stand_bound_the_way_of_a_paddle_that_absorbs():
    behind = ((-0.25, 0.0, 0.0), (-0.2, 1.0, 0.4))
    above = ((0.1, 0.0, 0.5), (0.2, 1.0, 0.6))
    fluid = fluid_with(REGULAR | {"absorption": True}, boundary__obstacles=[BLOCK, behind, above])
    fluid.pistons.parts[0].added = -0.11
    with pytest.raises(StepError, match=r"displaced by -0.11 m, with room from -0.1 to 0.8 m"):
        fluid.step(2e-4)


def test_a_paddle_that_absorbs_needs_water_in_front_of_it():
    fluid = fluid_with(REGULAR | {"absorption": True})
    state = fluid.state
    state.position_density[: state.fluid, 0] += 0.3
    with pytest.raises(StepError, match=r"absorbs waves by the water in front of it; found none"):
        fluid.step(2e-4)


@pytest.mark.parametrize(("period", "expected"), [(1.0, 0), (0.7, 1)])
def test_a_note_says_that_absorption_of_short_waves_is_poor(period, expected):
    waves = REGULAR | {"absorption": True, "period": period}
    notes = [n for n in fluid_params(**settings(waves)).notes if "absorption" in n]
    assert len(notes) == expected
    assert all("above 1.5, here 1.75, the paddle reflects 17 %" in note for note in notes)


NARROW = {"boundary__walls": ((-0.02, 0.0, 0.0), (0.8, 1.0, 0.4))}
BOARDS = {"boundary__obstacles": [BOARD]}
MOVED = {"boundary__motion": {"period": 1.0, "amplitude": [0.01, 0.0, 0.0]}}


def box(lowest, highest):
    return {"boundary__obstacles": [(lowest, highest)]}


FAR_SIDE = box((0.8, 0.0, 0.0), (0.9, 1.0, 0.4)) | {
    "boundary__walls": ((0.0, 0.0, 0.0), (1.1, 1.0, 0.4))
}


@pytest.mark.parametrize(
    ("waves", "changes", "match"),
    [
        (REGULAR | {"height": 0.15}, {}, "less than that of breaking waves, 0.1"),
        (SEA | {"significant_height": 0.15}, {}, "significant_height must be less than that of"),
        (REGULAR | {"depth": 0.3}, {}, r"the depth and the bottom of the water, 0.2 m and 0 m; f"),
        (SHALLOW, {}, "with absorption must have the level of the water exactly, 0.2 m"),
        (REGULAR | {"bottom": 0.1}, {}, r"found 0.2 m and 0.1 m. Correct them"),
        (REGULAR | {"height": 0.05}, {}, "need 4 particles or more in their height.*found 2.5"),
        (REGULAR | {"gravity": 9.0}, {}, "gravity must be that of the fluid, downwards along z"),
        (REGULAR, NARROW, r"must stay in the tank; found it beyond the wall x-"),
        (FLAP, BOARDS | {"boundary__walls": ((-0.07, 0.0, 0.0), (0.8, 1.0, 0.4))}, "its top goes"),
        (FLAP | {"hinge": None}, BOARDS, "a flap needs one; found paddle flap and hinge None"),
        (REGULAR | {"hinge": [0, 0, 0]}, {}, "waves.hinge belongs to a flap"),
        (FLAP | {"hinge": [0, 0, 0.3]}, BOARDS, "hinge must be below still water, at 0.2 m"),
        (FLAP | {"absorption": True}, BOARDS, "absorption is for a piston"),
        (FLAP, {}, r"must stay on the wall z- that it touches"),
        (REGULAR | {"period": None}, {}, r"must have height and period, or spectrum.*found height"),
        (REGULAR | SEA, {}, "Give all keys of one kind of waves"),
        (SEA | {"phase": 0.3}, {}, "found phase with the spectrum jonswap. Remove phase"),
        (REGULAR | {"seed": 0, "components": 9}, {}, "found seed, components with regular waves"),
        (REGULAR | {"peak_enhancement": 2.0}, {}, "found peak_enhancement with regular waves"),
        (MOSKOWITZ, {}, "found peak_enhancement with the spectrum pierson_moskowitz"),
        (SEA | {"order": 2}, {}, "order 2 is for regular waves; found it with a spectrum"),
        (REGULAR | {"order": 2, "period": 3.0}, {}, "H L²/h³ below 8π²/3 = 26.3.*found"),
        (REGULAR | {"heading": [0.0, 0.0, 1.0]}, {}, "waves.heading must be level"),
        (REGULAR, FAR_SIDE, r"none behind; found it from -0.9 to -0.1 m .*Turn heading"),
        (REGULAR | {"heading": [-1.0, 0.0, 0.0]}, {}, r"none behind; found it .*Turn heading"),
        (REGULAR, box((-0.2, 0.0, 0.0), (-0.1, 1.0, 0.4)), "it 0.1 m away along heading"),
        (REGULAR, box((-0.1, 0.0, 0.0), (0.0, 1.0, 0.27)), "from 0 m.*0.28 m; found.* 0.27 m"),
        (REGULAR, box((-0.1, 0.0, 0.1), (0.0, 1.0, 0.4)), "found it from 0.1 to 0.4 m"),
        (FLAP | {"hinge": [0.01, 0, 0]}, BOARDS, "within the paddle along heading, from -0.06 to"),
        (FLAP | {"hinge": [-0.03, 0, 0.05]}, BOARDS, "a flap must end at its hinge.*to -0.1 m"),
        (REGULAR, MOVED, "waves and boundary.motion do not go together"),
        (REGULAR | {"heading": [1.0, 1.0, 0.0]}, {}, "in the plane of x and z in two dimensions"),
    ],
)
def test_waves_that_cannot_be_made_so_are_refused(waves, changes, match):
    with pytest.raises(ValidationError, match=match):
        fluid_params(**settings(waves, **changes))


def test_a_face_of_the_tank_makes_no_waves():
    pistons = [{"part": "walls.x-", "waves": REGULAR}]
    with pytest.raises(ValidationError, match="a paddle swings to both sides"):
        fluid_params(**BASE | {"boundary.pistons": pistons, "boundary.obstacles": []})


@pytest.mark.parametrize("both", [True, False])
def test_a_piston_has_one_motion(both):
    motion = {"period": 1.0, "amplitude": [0.01, 0.0, 0.0]}
    piston = {"part": "obstacles.0"} | ({"waves": REGULAR, "motion": motion} if both else {})
    with pytest.raises(ValidationError, match="a piston must have motion or waves; found"):
        fluid_params(**BASE | {"boundary.pistons": [piston]})


@pytest.mark.parametrize(
    ("zone", "match"),
    [
        ({"towards": "y+"}, r"damping\[0\].towards must be x-, x\+, z- or z\+ in two dim"),
        ({"lowest": [0.9, 0, 0], "highest": [1.0, 1, 1]}, r"must reach into the fluid"),
        ({"lowest": [0.8, 0, 0], "highest": [0.4, 1, 1]}, "from its lowest to its highest corner"),
    ],
)
def test_damping_that_has_no_place_is_refused(zone, match):
    with pytest.raises(ValidationError, match=match):
        fluid_params(**BASE | {"boundary.damping": [ZONE | zone]})
