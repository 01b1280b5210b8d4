"""Warnings of a fluid: compression, loss, energy from nowhere; still water gives none."""

from collections.abc import Callable, Mapping

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.constants import pair_law
from quintet.components.sph_fluid.judgement import EVERY

Make = Callable[..., SphFluid]


def advance(fluid: SphFluid, steps: int) -> None:
    for _ in range(steps):
        fluid.take({})
        fluid.step(fluid.stable_dt())


def change_rows(fluid: SphFluid, name: str, rows: slice, column: int, value: object) -> None:
    state = {key: np.array(array) for key, array in fluid.save().items()}
    state[name][rows, column] = value
    fluid.load(state)


def warnings_of(**settings: object) -> Mapping[str, str]:
    return SphFluid(fluid_params(**settings)).warnings()


def test_still_water_warns_of_nothing(pool: Make) -> None:
    fluid = pool()
    advance(fluid, 2 * EVERY + 1)
    assert fluid.state.judged.any() and not fluid.warnings()


def test_fluid_that_is_compressed_is_warned_of_and_the_warning_is_part_of_the_state(
    pool: Make,
) -> None:
    """The density of a fifth of the fluid is 8 % too high: a Mach number of 0.28."""
    fluid = pool()
    change_rows(fluid, "position_density", slice(0, fluid.state.fluid // 5), 3, 1080.0)
    advance(fluid, 1)
    assert "density within 5%; 20% of it did not" in fluid.warnings()["compression"]
    loaded = pool()
    assert not loaded.warnings()
    loaded.load(fluid.save())
    assert loaded.warnings() == fluid.warnings()


def test_fluid_below_the_floor_of_its_tank_is_warned_of(pool: Make) -> None:
    fluid = pool()
    change_rows(fluid, "position_density", slice(0, 10), 2, -0.05)
    advance(fluid, 1)
    assert f"10 of {fluid.state.fluid} particles are beyond" in fluid.warnings()["loss"]


def test_fluid_that_leaves_by_an_open_side_is_not(pool: Make) -> None:
    fluid = pool(**{"boundary.open_faces": ("x+", "z+")})
    change_rows(fluid, "position_density", slice(0, 10), 0, 0.22)
    advance(fluid, 1)
    assert not fluid.warnings()


def test_motion_that_gravity_does_not_bring_is_warned_of(pool: Make) -> None:
    fluid = pool()
    advance(fluid, EVERY)
    change_rows(fluid, "velocity_pressure", slice(0, fluid.state.fluid), 0, 0.3)
    advance(fluid, 1)
    assert "energy" in fluid.warnings()


def test_a_flow_of_few_particles_is_warned_of(pool: Make) -> None:
    fluid = pool()  # five in the depth
    change_rows(fluid, "velocity_pressure", slice(0, fluid.state.fluid), 0, 0.3)
    advance(fluid, 1)
    assert "found 5" in fluid.warnings()["resolution"]


def test_artificial_viscosity_beyond_the_fluids_own_is_warned_of(pool: Make) -> None:
    fluid = pool(**{"viscosity.kinematic": 1e-3, "viscosity.artificial": 0.1})
    assert "acts as 0.003 m2/s" in fluid.warnings()["viscosity"]
    assert not pool(**{"viscosity.kinematic": 1e-3, "viscosity.artificial": 0.0}).warnings()


def test_artificial_viscosity_that_thickens_a_flow_is_warned_of(pool: Make) -> None:
    """Re = sqrt(g d) d / ν, and ν = α h c₀ / 20; fluid at rest bears any."""
    assert not pool(**{"viscosity.artificial": 3.0}).warnings()
    for alpha, warned in ((3.0, True), (0.001, False)):
        fluid = pool(**{"viscosity.artificial": alpha})
        change_rows(fluid, "velocity_pressure", slice(0, fluid.state.fluid), 0, 0.3)
        advance(fluid, 1)
        assert ("viscosity" in fluid.warnings()) == warned
        assert not warned or "Reynolds number" in fluid.warnings()["viscosity"]


def test_fluid_too_thick_to_gain_speed_is_warned_of_by_the_height_that_it_loses(
    pool: Make,
) -> None:
    fluid = pool(**{"viscosity.artificial": 30.0})
    advance(fluid, 1)
    low = fluid.state.position_density[: fluid.state.fluid, 2] * 0.9
    change_rows(fluid, "position_density", slice(0, fluid.state.fluid), 2, low)
    advance(fluid, EVERY)
    assert "viscosity" in fluid.warnings()


def test_artificial_viscosity_that_damps_a_wave_is_warned_of() -> None:
    """2νk² times a period is 0.63 of α = 0.1, and 0.063 of 0.01."""
    wave = {"amplitude": 0.02, "length": 1.0}
    tank = ((0.0, 0.0, 0.0), (1.0, 0.1, 0.5))
    scene = {"spacing": 0.05, "sound_speed": 22.2, "dimensions": 2, "fluid": (tank,), "wave": wave}
    assert "wave must lose" in warnings_of(**scene)["viscosity"]
    assert "viscosity" not in warnings_of(viscosity__artificial=0.01, **scene)


def test_there_is_no_artificial_viscosity_beside_the_fluids_own_unless_asked_for(
    pool: Make,
) -> None:
    fluid = pool(**{"viscosity.kinematic": 1e-3})
    assert fluid.params.viscosity.alpha == 0.0 and not fluid.warnings()
    assert pair_law(fluid.params).fluid.artificial == 0.0
    assert any("viscosity.artificial is not" in note for note in fluid.notes())
    assert pool().params.viscosity.alpha == 0.1


def test_a_wave_on_few_particles_is_refused() -> None:
    wave = {"amplitude": 0.02, "length": 1.0}
    tank = ((0.0, 0.0, 0.0), (1.0, 0.1, 0.5))
    with pytest.raises(ValueError, match="wave needs 8 particles or more in the depth; found 5"):
        fluid_params(spacing=0.1, sound_speed=30.0, dimensions=2, fluid=(tank,), wave=wave)


@pytest.mark.parametrize(
    ("kernel", "smoothing", "warned"),
    [
        ("wendland", 1.5, False),
        ("wendland", 1.3, True),
        ("cubic", 1.5, True),
        ("quintic", 1.5, False),
        ("quintic", 1.3, True),
    ],
)
def test_kernels_that_damp_a_wave_are_warned_of(
    kernel: str, smoothing: float, warned: bool
) -> None:
    """Measured on standing_wave: 5, 10 and 70 % too much."""
    tank = ((0.0, 0.0, 0.0), (1.0, 0.1, 0.5))
    scene = {"spacing": 0.05, "sound_speed": 22.2, "dimensions": 2, "fluid": (tank,)}
    scene["wave"] = {"amplitude": 0.02, "length": 1.0}
    assert ("smoothing" in warnings_of(**scene, kernel=kernel, smoothing=smoothing)) == warned
