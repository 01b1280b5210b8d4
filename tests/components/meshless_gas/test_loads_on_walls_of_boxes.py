"""Loads on walls of a box: on the faces of walls that hold the gas."""

import numpy as np
import pytest
from gases import gas_in_box, output, state

REST = {"density": 1.0, "pressure": 2.0}
WALL = {"kind": "isothermal", "temperature": 2.0}
ADIABATIC = {"kind": "adiabatic"}


def box(**faces):
    """Gas at rest in a box of 1 m, with these walls; its spacing is 0.1 m."""
    shape = {"highest": [1.0, 0.0, 1.0], "jitter": 0.0}
    ends = {f"{name[0]}{'-+'[name[1] == '1']}": boundary for name, boundary in faces.items()}
    return gas_in_box(viscous=True, initial=REST, neighbours=8, box=shape, boundaries=ends)


def test_a_floor_feels_no_pressure_of_the_outflow_nor_of_a_lid_that_slips():
    air = {"kind": "inflow", "state": state(1.0, 0.0, 2.0)}
    gas = box(x0=air, x1={"kind": "outflow"}, z0=WALL, z1={"kind": "slip"})
    assert (output(gas, "wall.position")[:, 2] == 0.0).all()
    # The node at the inflow is the inflow's, and half a spacing with it.
    assert output(gas, "body.force")[0] == pytest.approx([0.0, 0.0, -2.0 * 0.95], abs=1e-12)
    gas.friction.friction[:, 0], gas.friction.heat[:] = 1e-3, 4.0
    loads = gas.wall_loads.body(gas.fluxes.primitive)
    assert loads["body.force"][0, 0] == pytest.approx(1e-3 * 0.95, rel=1e-12)
    assert loads["body.heat"] == pytest.approx(4.0 * 0.95, rel=1e-12)
    assert np.sqrt((gas.friction.areas**2).sum(axis=1)).sum() == pytest.approx(0.95, rel=1e-12)


def test_a_uniform_pressure_pushes_a_closed_cavity_nowhere():
    gas = box(x0=ADIABATIC, x1=WALL, z0=ADIABATIC, z1=WALL)
    assert output(gas, "body.force") == pytest.approx(np.zeros((1, 3)), abs=1e-12)
    assert np.abs(gas.wall_loads.areas).sum(axis=0) == pytest.approx([2.0, 0.0, 2.0])
