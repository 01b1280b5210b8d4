"""Water heavier than the membrane that moves it: how often a window is repeated.

A bump runs to and fro along a membrane over a channel (`toy_tubes`), through 100 windows of one
period of its slowest wave: forty coupled unknowns, of which the slowest wave must move up to a
hundred times its own mass. No relaxation is tuned but the constant one, which is the best there
is: 2 / (2 + mass ratio), by the largest and the least eigenvalue of the iteration.
"""

import math

import laboratory
import numpy as np
import pytest
from toy_tubes import Channel, Membrane, added_masses

from quintet.coupler.coupling.iteration.acceleration import make
from quintet.coupler.coupling.iteration.convergence_measure import (
    ConvergenceMeasure,
    allowed,
    converged,
)
from quintet.coupler.coupling.iteration.settings import IterationSettings
from quintet.interfaces.component import outputs_of

KEY = ("membrane", "pressure.force")
RATIOS = (1, 3, 10, 30, 100)
WINDOWS, LIMIT = 100, 1000
# Force per strain [N]: a wave that is linear, and one that raises the tension by a sixth.
LINEAR, STRETCHED = 0.0, 10.0


def is_impulse(name, key):
    return key.endswith("force")


def toys(ratio, stretch):
    """A membrane, and a channel whose added mass is so many times its own."""
    density = ratio / float(added_masses(1, 1.0, 0.5, 1.0)[0])
    return Membrane(Membrane.Params(stretch=stretch)), Channel(Channel.Params(density=density))


def energy(components):
    totals = [component.totals() for component in components]
    return sum(total.kinetic + total.internal for total in totals)


def window(ratio):
    """A hundredth of the slowest wave's period [s]; it runs at 1 m/s if dry."""
    return 2.0 * math.sqrt(1.0 + ratio) / WINDOWS


def drive(ratio, stretch, settings, windows=WINDOWS, one_wave=False):
    """Iterate every window to agreement; return mean repetitions, energy drift and the toys."""
    membrane, channel = components = toys(ratio, stretch)
    if one_wave:
        membrane.q[1:] = 0.0
    length = window(ratio)
    acceleration = make(settings, is_impulse)
    measure = ConvergenceMeasure(settings.tolerance, settings.absolute, is_impulse)
    speed = outputs_of(membrane)["membrane.velocity"]
    impulses, repetitions, energies = {KEY: np.zeros_like(speed)}, [], [energy(components)]
    for _ in range(windows):
        guess, states = impulses, [component.save() for component in components]
        acceleration.begin_window(length)
        for repetition in range(settings.limit + 1):
            for component, state in zip(components, states, strict=True) if repetition else ():
                component.load(state)
            membrane.take({"pressure.force": guess[KEY] / length})
            membrane.step(length)
            end = outputs_of(membrane)["membrane.velocity"]
            channel.take({"wall.velocity": 0.5 * (speed + end)})
            channel.step(length)
            impulses = {KEY: length * outputs_of(channel)["pressure.force"]}
            residuals = measure.compare(guess, impulses, length)
            if converged(residuals):
                break
            guess = acceleration.next(guess, impulses, allowed(residuals))
        else:
            raise AssertionError(f"no agreement in {settings.limit} repetitions")
        acceleration.end_window(guess, impulses)
        repetitions.append(repetition)
        energies.append(energy(components))
        speed = end
    return float(np.mean(repetitions)), float(np.ptp(energies)) / energies[0], components


def options(kind, ratio, tolerance=1e-6, **keys):
    if kind == "constant":
        keys |= {"relaxation": 2.0 / (2.0 + ratio)}
    return IterationSettings(acceleration=kind, tolerance=tolerance, limit=LIMIT, **keys)


def table(tolerance, stretch):
    """Mean repetitions per window, by ratio of the masses and by acceleration."""
    columns = {
        "constant": {"kind": "constant"},
        "aitken": {"kind": "aitken"},
        "iqn-ils, reuse 0": {"kind": "iqn-ils", "reuse": 0},
        "iqn-ils, reuse 10": {"kind": "iqn-ils"},
        "iqn-ils, reuse 20": {"kind": "iqn-ils", "reuse": 20},
    }
    yield f"tolerance {tolerance:g}, force per strain {stretch:g} N"
    yield "ratio  " + "  ".join(columns)
    for ratio in RATIOS:
        means = [
            drive(ratio, stretch, options(ratio=ratio, tolerance=tolerance, **keys))[0]
            for keys in columns.values()
        ]
        cells = [f"{mean:{len(name)}.1f}" for name, mean in zip(columns, means, strict=True)]
        yield f"{ratio:5d}  " + "  ".join(cells)


@pytest.mark.parametrize("ratio", RATIOS)
def test_quasi_newton_takes_few_repetitions_where_aitken_takes_many(ratio):
    newton, drift, _ = drive(ratio, LINEAR, options("iqn-ils", ratio))
    assert newton <= 4.0
    assert drift < 1e-4
    aitken, *_ = drive(ratio, LINEAR, options("aitken", ratio), windows=50)
    assert aitken >= (8.0 if ratio > 1 else 6.0)


@pytest.mark.parametrize("ratio", RATIOS)
def test_of_a_problem_that_is_not_linear_quasi_newton_remembers_what_still_holds(ratio):
    newton, drift, _ = drive(ratio, STRETCHED, options("iqn-ils", ratio))
    fresh, *_ = drive(ratio, STRETCHED, options("iqn-ils", ratio, reuse=0), windows=50)
    aitken, *_ = drive(ratio, STRETCHED, options("aitken", ratio), windows=50)
    assert newton < 0.5 * fresh
    assert newton < 0.4 * aitken
    assert drift < 1e-4


def test_constant_relaxation_takes_more_the_heavier_the_water():
    repetitions = [
        drive(ratio, LINEAR, options("constant", ratio), windows=20)[0] for ratio in (1, 10)
    ]
    assert repetitions[1] > 4.0 * repetitions[0]


@pytest.mark.parametrize("ratio", [1, 100])
def test_the_slowest_wave_has_the_frequency_of_both_masses(ratio):
    """That of second differences in space and of the midpoint rule in time, for a third period."""
    settings = options("iqn-ils", ratio, tolerance=1e-10)
    _, _, (membrane, _) = drive(ratio, LINEAR, settings, windows=33, one_wave=True)
    start = toys(ratio, LINEAR)[0]
    frequency = math.sqrt(start.waves[0] / (1.0 + ratio))  # rad/s
    phase = 33 * 2.0 * math.atan(0.5 * window(ratio) * frequency)
    assert membrane.q[0] == pytest.approx(math.cos(phase) * start.q[0], rel=1e-6)
    assert np.abs(membrane.q[1:]).max() < 1e-8 * abs(start.q[0])


def _scene(folder, ratio, stretch=STRETCHED, **settings):
    density = ratio / float(added_masses(1, 1.0, 0.5, 1.0)[0])
    length = window(ratio)
    components = {
        "membrane": {"kind": "toy_tubes:Membrane", "stretch": stretch, "dt": length},
        "channel": {"kind": "toy_tubes:Channel", "density": density, "dt": length},
    }
    pairs = [["membrane.membrane", "channel.wall"], ["channel.pressure", "membrane.pressure"]]
    link = {"kind": "direct", "pairs": pairs}
    end = WINDOWS * length
    settings = {"end": end, "window": length, "scheme": "iterated", **settings}
    return laboratory.scene(folder, components, link, **settings)


def test_over_the_coupler_energy_is_kept_and_momentum_closes(tmp_path):
    trace = laboratory.couple(_scene(tmp_path, 10, iteration={"limit": LIMIT}))
    assert np.ptp(trace.energies) < 1e-4 * trace.energies[0]
    assert trace.account.momentum_residual <= 1e-12
    heights = trace.history("membrane", "membrane.position")[:, :, 2]
    assert heights[0].max() == pytest.approx(0.05, rel=0.01)
    assert heights.min() < -0.01  # it swung


@pytest.mark.parametrize("ratio", [10, 100])
def test_over_the_coupler_quasi_newton_takes_few_repetitions(tmp_path, ratio):
    means = {}
    for kind in ("iqn-ils", "aitken"):
        iteration = {"acceleration": kind, "limit": LIMIT}
        trace = laboratory.couple(_scene(tmp_path, ratio, LINEAR, iteration=iteration))
        means[kind] = trace.coupling.costs.repetitions / WINDOWS
        assert trace.account.momentum_residual <= 1e-12
    assert means["iqn-ils"] <= 4.0
    assert means["aitken"] >= 8.0


if __name__ == "__main__":
    for stretch in (LINEAR, STRETCHED):
        for tolerance in (1e-4, 1e-6):
            print("\n".join(table(tolerance, stretch)), flush=True)
