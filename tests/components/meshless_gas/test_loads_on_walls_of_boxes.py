"""What walls of a box feel: of those that hold the gas, on their own faces."""

import numpy as np
import pytest
from gases import gas, given, state

REST = {"density": 1.0, "pressure": 2.0}
WALL = {"kind": "isothermal", "temperature": 2.0}
ADIABATIC = {"kind": "adiabatic"}


def box(**faces):
    """Gas at rest in a box of 1 m, with these walls; its spacing is 0.1 m."""
    shape = {"highest": [1.0, 0.0, 1.0], "jitter": 0.0}
    ends = {f"{name[0]}{'-+'[name[1] == '1']}": one for name, one in faces.items()}
    return gas(viscous=True, initial=REST, neighbours=8, box=shape, boundaries=ends)


def test_a_floor_feels_no_pressure_of_the_outflow_nor_of_a_lid_that_slips():
    air = {"kind": "inflow", "state": state(1.0, 0.0, 2.0)}
    made = box(x0=air, x1={"kind": "outflow"}, z0=WALL, z1={"kind": "slip"})
    assert (given(made, "wall.position")[:, 2] == 0.0).all()
    # The node at the inflow is the inflow's, and half a spacing with it.
    assert given(made, "body.force")[0] == pytest.approx([0.0, 0.0, -2.0 * 0.95], abs=1e-12)
    made.friction.friction[:, 0], made.friction.heat[:] = 1e-3, 4.0
    felt = made.wall_loads.body(made.fluxes.primitive)
    assert felt["body.force"][0, 0] == pytest.approx(1e-3 * 0.95, rel=1e-12)
    assert felt["body.heat"] == pytest.approx(4.0 * 0.95, rel=1e-12)
    assert np.sqrt((made.friction.areas**2).sum(axis=1)).sum() == pytest.approx(0.95, rel=1e-12)


def test_a_uniform_pressure_pushes_a_closed_cavity_nowhere():
    made = box(x0=ADIABATIC, x1=WALL, z0=ADIABATIC, z1=WALL)
    assert given(made, "body.force") == pytest.approx(np.zeros((1, 3)), abs=1e-12)
    assert np.abs(made.wall_loads.areas).sum(axis=0) == pytest.approx([2.0, 0.0, 2.0])
