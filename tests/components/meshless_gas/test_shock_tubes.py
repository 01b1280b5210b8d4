"""Gas torn apart, driven together and shocked: as the exact solution says, or an error."""

import math

import numpy as np
import pytest
from gases import GAMMA, SOD, gas_in_box, output, run, state, tube

from quintet.components.meshless_gas import component, diagnostics, scheme
from quintet.components.meshless_gas.exact.riemann import Side, star
from quintet.components.meshless_gas.view import laplacian
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError
from quintet.interfaces.faces import SYMMETRY, WALL

# Left, right, pressure and velocity between the waves: Toro (2009), table 4.2, and other tubes.
TUBES = {
    "sod": (*SOD, 0.30313, 0.92745),
    "lax": ((0.445, 0.698, 3.528), (0.5, 0.0, 0.571), 2.46610, 1.52872),
    "123": ((1.0, -2.0, 0.4), (1.0, 2.0, 0.4), 0.00189, 0.0),
    "woodward_colella": ((1.0, 0.0, 1000.0), (1.0, 0.0, 0.01), 460.894, 19.5975),
    "noh": ((1.0, 1.0, 1e-6), (1.0, -1.0, 1e-6), 4.0 / 3.0 * 0.9, 0.0),
}


@pytest.mark.parametrize("name", TUBES)
def test_exact_solution_has_its_published_pressure_and_velocity(name):
    left, right, pressure, velocity = TUBES[name]
    star_state = star(Side(*left), Side(*right), GAMMA)
    assert star_state == pytest.approx(
        (pressure, velocity), rel=1e-4 if name != "123" else 5e-3, abs=1e-4
    )


# End [s], and the mean error of the density [kg/m3] that 50 nodes may have.
@pytest.mark.parametrize(
    ("left", "right", "end", "within"),
    [
        pytest.param(*SOD, 0.2, 0.0145, id="sod"),
        pytest.param((1.0, -2.0, 0.4), (1.0, 2.0, 0.4), 0.15, 0.035, id="rarefactions"),
        pytest.param((1.0, -6.0, 0.4), (1.0, 6.0, 0.4), 0.05, 0.05, id="vacuum"),
        pytest.param((1.0, 0.0, 1e5), (1.0, 0.0, 1.0), 1.2e-3, 0.32, id="pressure ratio 1e5"),
        pytest.param((1.0, 1.0, 1e-6), (1.0, -1.0, 1e-6), 1.0, 0.16, id="noh"),
        pytest.param((1.0, 20.0, 1.0 / 1.4), (1.0, 0.0, 1.0 / 1.4), 0.02, 0.3, id="Mach 20"),
    ],
)
def test_tubes_are_computed_without_floors(left, right, end, within):
    gas = run(tube(50, left, right), end)
    assert output(gas, "error.density")[0] < within
    assert (gas.state.primitive[:, [0, 4]] > 0.0).all()
    assert abs(output(gas, "balance.mass_drift")[0]) < 0.02
    assert abs(output(gas, "balance.energy_drift")[0]) < 0.02


def test_what_strikes_a_wall_is_stopped_by_the_shock_of_the_exact_solution():
    # The mirror image of the wall's gas comes from beyond it.
    mach, wall = 20.0, {"kind": "slip"}
    wind = state(1.0, mach, 1.0 / GAMMA)
    gas = gas_in_box(
        initial=wind, boundaries={"x-": {"kind": "inflow", "state": wind}, "x+": wall},
        box={"spacing": 0.02, "highest": [1.0, 0.0, 0.1]}, probes=[[0.99, 0.0, 0.05]], neighbours=8,
    )  # fmt: skip
    run(gas, 0.06)
    side = Side(1.0, mach, 1.0 / GAMMA)
    pressure, _ = star(side, side._replace(velocity=-mach), GAMMA)
    assert output(gas, "probes.pressure")[0] == pytest.approx(pressure, rel=0.03)


def test_a_step_beyond_the_limit_ends_with_where_and_what_to_do():
    gas = tube(50, *SOD)
    with pytest.raises(StepError, match=r"the node at .* m has .* Lower courant"):
        for _ in range(20):
            gas.step(4.0 * gas.scheme.shortest_step)


def test_two_threads_give_the_bits_of_one(monkeypatch):
    for module in (component, scheme, diagnostics):
        monkeypatch.setattr(module, "LIGHT", 20)  # so that small cases take this way too
    monkeypatch.setattr(scheme, "SUMS", 20)
    monkeypatch.setattr(diagnostics, "WHOLESALE", 20)
    monkeypatch.setattr("quintet.components.meshless_gas.state.WHOLESALE", 20)
    serial, threaded = (
        run(tube(200, *SOD, resources=Resources(threads=threads)), 0.02) for threads in (1, 2)
    )
    assert np.array_equal(serial.state.conservative, threaded.state.conservative)
    assert output(serial, "error.density") == output(threaded, "error.density")
    assert np.array_equal(serial.state.begun, threaded.state.begun)
    assert output(serial, "balance.energy") == output(threaded, "balance.energy")


def test_nothing_is_gained_nor_lost_before_the_first_step():
    gas = tube(31, *SOD)
    drifts = [
        output(gas, f"balance.{quantity}_drift") for quantity in ("mass", "momentum", "energy")
    ]
    # Summed in one order, now and at the start.
    assert all((drift == 0.0).all() for drift in drifts)


def test_a_tube_shows_the_exact_solution_beside_its_own():
    gas = run(tube(50, *SOD), 0.1)
    view = gas.view()
    place = view["points"][:, 0]
    behind = (place > 0.6) & (place < 0.66)  # between contact and shock: Toro, table 4.3
    assert view["exact_density"][behind] == pytest.approx(0.26557, rel=1e-4)
    assert view["exact_pressure"][behind] == pytest.approx(0.30313, rel=1e-4)
    assert view["exact_velocity"][behind, 0] == pytest.approx(0.92745, rel=1e-4)
    assert np.abs(view["density"] - view["exact_density"]).mean() < 0.0145


def test_planes_of_symmetry_of_a_box_are_shown_as_such_and_walls_as_walls():
    boundaries = {"z-": {"kind": "symmetry"}, "z+": {"kind": "slip"}}
    gas = gas_in_box(
        box={"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 0.0, 0.5], "spacing": 0.1},
        initial=state(1.0, 0.0, 1.0),
        boundaries=boundaries,
    )
    walls = gas.walls()
    heights = [float(walls["points"][cell][:, 2].max()) for cell in walls["cells"]]
    assert dict(zip(walls["support"].tolist(), heights, strict=True)) == {SYMMETRY: 0.0, WALL: 0.5}


def test_a_picture_after_load_is_that_before_save():
    gas, resumed = run(tube(50, *SOD), 0.1), tube(50, *SOD)
    resumed.load(gas.save())
    before, after = gas.view(), resumed.view()
    assert before["schlieren"].min() < 1e-3
    assert all(np.array_equal(before[key], after[key]) for key in before)


def test_a_shock_is_dark_ahead_and_bright_behind_on_a_shadowgraph():
    gas = run(tube(50, *SOD), 0.1)
    view, place = gas.view(), gas.view()["points"][:, 0]
    near = np.abs(place - 0.6752) < 0.06
    light = view["shadowgraph"][near]
    assert place[near][light.argmin()] > place[near][light.argmax()]
    assert light.min() < 0.1 and light.max() > 0.9
    assert view["shadowgraph"][place < 0.1] == pytest.approx(0.5, abs=1e-4)
    # Least squares of a linear field are exact.
    domain = gas.motion.domain
    inner = np.isin(domain.every, domain.inner)
    field = domain.cloud.positions * np.array([2.0, 0.0, 0.0])
    assert laplacian(domain, domain.every, field)[inner] == pytest.approx(2.0)


@pytest.mark.full  # a kernel of its own
def test_first_order_is_monotone():
    density = run(tube(50, *SOD, order=1), 0.2).state.primitive[:, 0]
    assert density.max() <= 1.0 + 1e-9 and density.min() >= 0.125 - 1e-9


def von_neumann(mach, second_order):
    """Largest Courant number at which no wave of the linearised Euler equations grows.

    On a lattice with eight neighbours, waves split by the eigenvalues of each pair, SSP-RK3.
    """
    arm = np.array([(i, k) for i in (-1, 0, 1) for k in (-1, 0, 1) if i or k], float)
    distance = np.hypot(*arm.T)
    far = math.exp(-4.0)
    weight = (np.exp(-((distance / distance.max()) ** 2)) - far) / distance
    moment = np.einsum("k,ka,kb->ab", weight, arm, arm)
    c = weight[:, None] * arm @ np.linalg.inv(moment)
    size = np.hypot(*c.T)
    normal = c / size[:, None]
    courant = (np.abs(mach * c[:, 0]) + size).sum()
    rates = []
    for phase in np.stack(np.meshgrid(*[np.linspace(0.0, np.pi, 17)] * 2), -1).reshape(-1, 2):
        shift = np.exp(1j * arm @ phase)
        gradient = (c * (shift - 1.0)[:, None]).sum(axis=0)
        total = np.zeros((3, 3), complex)
        for k in range(8):
            across, slope = shift[k] - 1.0, gradient @ arm[k]
            half = (slope / 3.0 + across / 6.0) * second_order
            half_j = (slope * shift[k] / 3.0 + across / 6.0) * second_order
            x, z = normal[k]
            matrix = mach * x * np.eye(3) + np.array([[0.0, x, z], [x, 0.0, 0.0], [z, 0.0, 0.0]])
            speeds, modes = np.linalg.eigh(matrix)
            forth, back = (
                (modes * np.maximum(speeds, 0)) @ modes.T,
                (modes * np.minimum(speeds, 0)) @ modes.T,
            )
            total -= 2.0 * size[k] * (forth * half + back * (across - half_j))
        rates.extend(np.linalg.eigvals(total) / courant)
    z = np.array(rates)
    low, high = 0.0, 10.0
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        y = middle * z
        stable = np.abs(1.0 + y + y * y / 2.0 + y**3 / 6.0).max() <= 1.0 + 1e-9
        low, high = (middle, high) if stable else (low, middle)
    return low


def test_courant_number_is_limited_where_von_neumann_says():
    # Where the scheme is of first order, at a shock; Mach number behind that of Sod's tube.
    limit = von_neumann(0.73, second_order=0.0)
    assert limit == pytest.approx(1.77, abs=0.01)
    assert limit < von_neumann(0.73, second_order=1.0)
    run(tube(50, *SOD, courant=0.8 * limit), 0.2)
    with pytest.raises(StepError):
        run(tube(50, *SOD, courant=1.3 * limit), 0.2)
