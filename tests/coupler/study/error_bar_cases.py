"""Coupled scenes whose exact answer is known, for the coverage of error bars."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm


@dataclass(frozen=True)
class Case:
    """A scene, and the exact flow of its state.

    Parameters
    ----------
    state : tuple of str
        Recorded fields that make up the state, ``component.port.field``, of item 0 and axis 0.
    flow : callable
        State (d,) and a time [s] to the state after that time.
    """

    name: str
    about: str
    text: str
    state: tuple[str, ...]
    flow: Callable[[np.ndarray, float], np.ndarray]
    watch: tuple[str, ...]
    exact: str = "matrix exponential"


def linear(matrix, constant=None):
    """Flow of y' = A y + b."""
    size = len(matrix)
    augmented = np.zeros((size + 1, size + 1))
    augmented[:size, :size] = matrix
    if constant is not None:
        augmented[:size, size] = constant

    def flow(state, time):
        key = round(time * 1e15)
        if key not in known:
            known[key] = expm(augmented * time)
        return (known[key] @ np.append(state, 1.0))[:size]

    known = {}
    return flow


def integrated(rates):
    """Flow of y' = f(y), solved to rounding."""

    def flow(state, time):
        ends = (0.0, time)
        return solve_ivp(lambda _, y: rates(y), ends, state, "DOP853", rtol=3e-14, atol=1e-16).y[
            :, -1
        ]

    return flow


SAMPLES = 20  # as in 4000 windows with the default of quintet: so each case takes seconds
HEAD = """
name = "{name}"
end = {end}
window = {window}
scheme = "{scheme}"
transport = "memory"
[output]
fields = [{state}]
[error_bar]
every = {every}
"""
EXPECT = """
[[expect]]
name = "{path}"
component = "{component}"
field = "{field}"
{axis}
measure = "at"
begin = {end}
value = 0.0
within = 1e9
unit = "{unit}"
source = "none: only the error bar is looked at"
"""
PAIR = """
[components.{one}]
kind = "exact_pairs:{one_kind}"
{one_keys}
[components.{two}]
kind = "exact_pairs:{two_kind}"
{two_keys}
[[links]]
kind = "direct"
pairs = [[{there}], [{back}]]
"""
MOTION = ("motion.position", "motion.velocity")


def head(name, scheme, window, windows, state):
    """The keys of a scene; all of the state is recorded, for the exact answer."""
    fields = ", ".join(f'"{path}"' for path in state)
    interval = max(1, windows // SAMPLES)
    end = window * windows
    return HEAD.format(
        name=name, end=end, window=window, scheme=scheme, state=fields, every=interval
    )


def expectations(watch, end):
    """Expect each quantity at the end, so that the run reports its error bar."""
    texts = []
    for path in watch:
        component, _, field = path.partition(".")
        is_warm = field.endswith("temperature")
        axis, unit = ("", "K") if is_warm else ("axis = 0", "m")
        texts.append(
            EXPECT.format(
                path=path, component=component, field=field, axis=axis, end=end, unit=unit
            )
        )
    return "".join(texts)


def keys(table):
    return "\n".join(f"{key} = {value}" for key, value in table.items())


def pair(name, about, scheme, window, windows, kinds, tables, joins, watch, state, flow, exact=""):
    """A case of two components."""
    text = head(name, scheme, window, windows, state) + PAIR.format(
        one="one",
        two="two",
        one_kind=kinds[0],
        two_kind=kinds[1],
        one_keys=keys(tables[0]),
        two_keys=keys(tables[1]),
        there=joins[0],
        back=joins[1],
    )
    text += expectations(watch, window * windows)
    return Case(name, about, text, state, flow, watch, exact or "matrix exponential")


MECHANICAL = ('"one.motion", "two.foot"', '"two.foot_load", "one.load"')
STATE = tuple(f"{name}.{key}" for name in ("one", "two") for key in MOTION)
THERMAL = ('"one.surface", "two.outside"', '"two.loss", "one.heat"')
WATCH = ("one.motion.position", "two.motion.position")
TEMPERATURES = ("one.surface.temperature", "two.surface.temperature")


def mechanical(name, about, scheme, window, windows, carrier, rider):
    """A carrier, and a rider on it with a spring and a damper."""
    m, M = rider["mass"], carrier["mass"]
    k, c = rider.get("stiffness", 0.0), rider.get("damping", 0.0)
    K, C = carrier.get("stiffness", 0.0), carrier.get("damping", 0.0)
    matrix = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-(K + k) / M, -(C + c) / M, k / M, c / M],
            [0.0, 0.0, 0.0, 1.0],
            [k / m, c / m, -k / m, -c / m],
        ]
    )
    kinds = ("Carrier", "Rider")
    return pair(
        name, about, scheme, window, windows, kinds, (carrier, rider), MECHANICAL, WATCH, STATE,
        linear(matrix),
    )  # fmt: skip


def thermal(name, about, scheme, window, windows, store, cooler):
    """Two bodies that exchange heat."""
    G, C, c = cooler["conductance"], store["capacity"], cooler["capacity"]
    matrix = np.array(
        [
            [-(G + store.get("loss", 0.0)) / C, G / C],
            [G / c, -(G + cooler.get("loss", 0.0)) / c],
        ]
    )
    kinds = ("Store", "Cooler")
    return pair(
        name, about, scheme, window, windows, kinds, (store, cooler), THERMAL, TEMPERATURES,
        TEMPERATURES, linear(matrix),
    )  # fmt: skip


def dragged(name, about, scheme, window, windows, stream, swimmer):
    """A particle in a stream of finite mass, with quadratic drag."""
    M, m, d = stream["mass"], swimmer["mass"], swimmer["drag"]

    def rates(y):
        force = d * abs(y[3] - y[1]) * (y[3] - y[1])
        return np.array([y[1], force / M, y[3], -force / m])

    return pair(
        name, about, scheme, window, windows, ("Carrier", "Swimmer"), (stream, swimmer),
        MECHANICAL, WATCH, STATE, integrated(rates), "equations solved to 3e-14",
    )  # fmt: skip


SPRINGS = """
[components.lower]
kind = "springs:Mass"
mass = {lower}
stiffness = 100.0
arm = [0.0, 0.0, 0.0]
start = [0.0, 0.0, 0.0]
[components.upper]
kind = "springs:Mass"
mass = {upper}
stiffness = 100.0
arm = [0.0, 0.0, 0.0]
start = [0.1, 0.0, 0.0]
[[links]]
kind = "direct"
name = "spring"
pairs = [["lower.motion", "upper.foot"], ["upper.foot_load", "lower.load"]]
"""
LOWER, UPPER = "lower.motion.position", "upper.motion.position"


def springs(name, about, scheme, window, windows, lower=1.0, upper=1.0):
    """The masses of the scene two_springs, moving along x about their rest."""
    watch = (LOWER, UPPER)
    state = tuple(f"{component}.{key}" for component in ("lower", "upper") for key in MOTION)
    matrix = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-200.0 / lower, 0.0, 100.0 / lower, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [100.0 / upper, 0.0, -100.0 / upper, 0.0],
        ]
    )
    text = head(name, scheme, window, windows, state)
    text += SPRINGS.format(lower=lower, upper=upper) + expectations(watch, window * windows)
    return Case(name, about, text, state, linear(matrix), watch)


def cases():
    """All cases, in the order of the table."""
    return [
        springs("springs_serial", "two_springs", "serial", 2e-3, 1000),
        springs("springs_parallel", "two_springs", "parallel", 2e-3, 1000),
        springs("springs_iterated", "two_springs", "iterated", 8e-3, 300),
        springs("springs_heavy", "two_springs, masses 10 : 1", "serial", 2e-3, 1000, 10.0, 1.0),
        mechanical(
            "damped_serial", "damped springs", "serial", 5e-3, 1000,
            {"mass": 1.0, "stiffness": 100.0, "damping": 0.4},
            {"mass": 0.5, "stiffness": 40.0, "damping": 0.1, "start": 0.1},
        ),
        mechanical(
            "damped_iterated", "damped springs", "iterated", 2e-2, 300,
            {"mass": 1.0, "stiffness": 100.0, "damping": 0.2},
            {"mass": 0.5, "stiffness": 40.0, "damping": 0.1, "start": 0.1},
        ),
        mechanical(
            "floating_body", "body on a restoring spring, with a lump of water", "serial",
            5e-3, 1000,
            {"mass": 2.0, "stiffness": 50.0, "start": 0.05},
            {"mass": 1.0, "stiffness": 200.0, "damping": 2.0},
        ),
        mechanical(
            "drag_linear", "particle in a gas, Stokes drag", "serial", 3e-3, 500,
            {"mass": 1.0},
            {"mass": 0.5, "damping": 1.0, "speed": 1.0},
        ),
        dragged(
            "drag_quadratic", "particle in a gas, quadratic drag", "serial", 3e-3, 500,
            {"mass": 1.0, "speed": 0.5},
            {"mass": 0.5, "drag": 2.0, "speed": -0.5},
        ),
        thermal(
            "heat_serial", "two bodies exchange heat", "serial", 1.6e-2, 500,
            {"capacity": 1.0, "start": 300.0},
            {"capacity": 2.0, "conductance": 0.5, "start": 200.0},
        ),
        thermal(
            "heat_parallel", "two bodies exchange heat and cool", "parallel", 1.6e-2, 500,
            {"capacity": 1.0, "start": 300.0, "loss": 0.05},
            {"capacity": 0.5, "conductance": 0.5, "start": 200.0, "loss": 0.1},
        ),
        thermal(
            "heat_iterated", "two bodies exchange heat", "iterated", 2e-2, 300,
            {"capacity": 1.0, "start": 300.0},
            {"capacity": 2.0, "conductance": 0.5, "start": 200.0},
        ),
    ]  # fmt: skip


def calibration_cases():
    """Cases of other parameters, from which the constants of the value's bar were chosen."""
    return [
        springs("springs_light", "two_springs, masses 1 : 4", "serial", 8e-4, 4000, 1.0, 4.0),
        springs("springs_both", "two_springs, masses 3 : 1", "parallel", 6e-4, 4000, 3.0, 1.0),
        mechanical(
            "stiff_iterated", "damped springs", "iterated", 6e-3, 4000,
            {"mass": 2.0, "stiffness": 300.0, "damping": 0.1},
            {"mass": 0.3, "stiffness": 20.0, "damping": 0.05, "start": 0.1},
        ),
        mechanical(
            "drag_heavy", "particle in a gas, Stokes drag", "serial", 2e-3, 4000,
            {"mass": 0.4},
            {"mass": 1.5, "damping": 0.6, "speed": 1.0},
        ),
        mechanical(
            "towed", "particle dragged by an oscillating stream", "serial", 2e-3, 4000,
            {"mass": 1.0, "stiffness": 30.0, "start": 0.2},
            {"mass": 0.2, "damping": 0.3},
        ),
        thermal(
            "heat_light", "two bodies exchange heat and cool", "serial", 4e-3, 4000,
            {"capacity": 3.0, "start": 300.0, "loss": 0.2},
            {"capacity": 0.4, "conductance": 0.3, "start": 250.0},
        ),
    ]  # fmt: skip
