"""A plate of masses on springs under a wave of pressure, over an fsi link.

Normal motion of the nodes: M z'' + C z' + K z = f(t), with M = m I, K = k I, C = d Φᵀ A Φ of
the sampled faces, and f(t) = -p Φᵀ A sin(k (x - c t)): a linear system, solved exactly.
"""

import laboratory
import numpy as np
import pytest
from scipy.linalg import expm

from quintet.components.shared.geometry.surface_samples import Sampling
from quintet.components.shared.geometry.surface_samples_mesh import sample_faces
from quintet.coupler.coupling.mapping import ShapeMap

MASS, STIFFNESS, PRESSURE, WAVE, SPEED, DRAG, SPACING, END = (
    1.0,
    40.0,
    3.0,
    2.0,
    1.5,
    1.0,
    0.125,
    1.0,
)
RATIOS = [1, 7, 50]


def _run(folder, window, ratio, scheme="serial", order=("gust", "plate"), slow="plate"):
    steps = {"gust": window / ratio, "plate": window / ratio} | {slow: window}
    components = {
        "gust": {"kind": "toy_plates:Gust", "dt": steps["gust"], "spacing": SPACING},
        "plate": {"kind": "toy_plates:Plate", "dt": steps["plate"]},
    }
    link = {"kind": "fsi", "between": ["gust", "plate"]}
    settings = {"end": END, "window": window, "scheme": scheme, "order": list(order)}
    return laboratory.couple(laboratory.scene(folder, components, link, **settings))


def _exact():
    """Heights (12,) m of the nodes at the end."""
    from toy_plates import Plate

    mesh = Plate(Plate.Params()).describe()
    sampling = Sampling(SPACING, depth=SPACING, inset=0.0, planar=False)
    samples = sample_faces(mesh["faces.start"], mesh["faces.corner"], sampling)
    shape, area = ShapeMap(samples.node, samples.weight, 12), samples.volume / SPACING
    phi = np.array([shape.map_consistent(unit[:, None])[:, 0] for unit in np.eye(12)]).T  # (n, 12)
    positions = shape.map_consistent(mesh["faces.start"])[:, 0]
    # sin(k x - ω t) = sin(k x) cos(ω t) - cos(k x) sin(ω t), with cos and sin as two more unknowns.
    pulsation, zero, identity = WAVE * SPEED, np.zeros((12, 12)), np.eye(12)
    push = (
        -PRESSURE
        * phi.T
        @ (area[:, None] * np.column_stack([np.sin(WAVE * positions), -np.cos(WAVE * positions)]))
    )
    damping = DRAG * phi.T @ (area[:, None] * phi)
    system = np.block(
        [
            [zero, identity, np.zeros((12, 2))],
            [-STIFFNESS / MASS * identity, -damping / MASS, push / MASS],
            [np.zeros((2, 24)), np.array([[0.0, -pulsation], [pulsation, 0.0]])],
        ]
    )
    start = np.concatenate([np.zeros(24), [1.0, 0.0]])
    return (expm(system * END) @ start)[:12]


def _errors(folder, ratio, scheme, windows=(0.04, 0.02, 0.01), **settings):
    exact = _exact()
    ends = [
        _run(folder, window, ratio, scheme, **settings).history("plate", "faces.position")[-1, :, 2]
        for window in windows
    ]
    return [float(np.abs(end - exact).max() / np.abs(exact).max()) for end in ends]


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize(
    ("scheme", "order", "size"),
    [("serial", 0.9, 0.003), ("parallel", 0.9, 0.04), ("iterated", 1.9, 5e-4)],
)
def test_plate_converges_to_the_exact_motion(tmp_path, scheme, order, size, ratio):
    errors = _errors(tmp_path, ratio, scheme)
    assert errors[-1] < size
    assert min(laboratory.orders(errors)) > order


def test_a_plate_of_small_steps_converges_as_well(tmp_path):
    errors = _errors(tmp_path, 7, "iterated", slow="gust")
    assert errors[-1] < 5e-4
    assert min(laboratory.orders(errors)) > 1.9


@pytest.mark.parametrize("slow", ["plate", "gust"])
@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("scheme", ["serial", "parallel", "iterated"])
def test_impulse_given_is_impulse_applied(tmp_path, scheme, ratio, slow):
    trace = _run(tmp_path, 0.04, ratio, scheme, slow=slow)
    account = trace.account
    assert account.momentum_residual <= 1e-12
    assert account.kinematic_residual <= 1e-12
    # By hand as well: impulses of all windows, without those that are applied late.
    impulse = trace.history("gust", "surface_load.force").sum(axis=(0, 1))
    if scheme == "parallel":
        impulse = impulse - laboratory.in_transit(trace, "gust", "surface_load.force")
    np.testing.assert_allclose(
        account.impulse, impulse, rtol=0.0, atol=1e-12 * np.abs(impulse).max()
    )


@pytest.mark.parametrize("scheme", ["serial", "parallel"])
def test_work_of_both_sides_agrees_ever_better(tmp_path, scheme):
    residuals = [
        _run(tmp_path, window, 7, scheme).account.energy_residual for window in (0.02, 0.01, 0.005)
    ]
    assert min(laboratory.orders(residuals)) > 0.7


def test_iterated_windows_do_the_same_work_on_both_sides(tmp_path):
    assert _run(tmp_path, 0.02, 1, "iterated").account.energy_residual < 1e-6
    residuals = [_run(tmp_path, w, 7, "iterated").account.energy_residual for w in (0.04, 0.02)]
    assert laboratory.orders(residuals)[0] > 1.9


def test_of_two_plates_in_one_gust_each_link_counts_its_own_work(tmp_path):
    """The work of a port that links share is divided among them, as forces and samples are."""
    components = {
        "gust": {"kind": "toy_plates:Gust", "dt": 0.002, "spacing": SPACING},
        "soft": {"kind": "toy_plates:Plate", "dt": 0.01},
        "stiff": {"kind": "toy_plates:Plate", "dt": 0.01, "stiffness": 4000.0},
    }
    links = [{"kind": "fsi", "between": ["gust", name]} for name in ("soft", "stiff")]
    path = laboratory.scene(
        tmp_path,
        components,
        links,
        end=END,
        window=0.01,
        scheme="iterated",
        iteration={"tolerance": 1e-10},
        order=["gust", "soft", "stiff"],
    )
    soft, stiff = laboratory.couple(path).coupling.ledger.accounts.values()
    assert soft.turnover > 10.0 * stiff.turnover > 0.0
    for account in (soft, stiff):
        assert account.energy_residual < 2e-3
