"""A fluid that begins from a state of another one: what may differ, and what is refused."""

import numpy as np
import pytest
from device_fluids import DYNAMIC, TWICE, advanced, params_of

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.errors import SceneError


@pytest.mark.parametrize("changes", [{"smoothing": 1.4}, {"integration": "symplectic"}])
def test_a_state_in_the_order_of_other_lists_is_refused(changes):
    """Rows stand by cells of the lists' reach: other lists would not find all neighbours."""
    state = advanced(SphFluid(params_of(DYNAMIC)), 3).save()
    with pytest.raises(SceneError, match=r"lists that reach 0\.\d+ m, by spacing, smoothing and"):
        SphFluid(params_of(DYNAMIC | changes)).begin_from(state)


@pytest.mark.parametrize("dampers", [(0.0, 0.05), (0.05, 0.0)])
def test_a_damper_may_come_and_go(dampers):
    before, after = (params_of(DYNAMIC | TWICE | {"acoustic_damper": damper}) for damper in dampers)
    fluid = SphFluid(after)
    fluid.begin_from(advanced(SphFluid(before), 5).save())
    advanced(fluid, 20)
    assert np.isfinite(fluid.view()["points"]).all()
    assert len(fluid.state.minus_rho_div_u) == (fluid.state.particles if dampers[1] else 0)


def test_a_state_goes_on_with_the_same_bits():
    whole, begun = (SphFluid(params_of(DYNAMIC)) for _ in range(2))
    begun.begin_from(advanced(whole, 5).save())
    points = [advanced(fluid, 10).view()["points"] for fluid in (whole, begun)]
    assert np.array_equal(*points)
