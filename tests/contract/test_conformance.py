"""What every component must keep to, tried on all of them: add a case to `cases.py`."""

import numpy as np
import pytest
from cases import CASES, frozen

from quintet.interfaces.component import Array, Fields, outputs_of
from quintet.interfaces.lines.message import decode, encode
from quintet.interfaces.manifest import known_kinds
from quintet.interfaces.units import UNITS


@pytest.fixture(params=CASES.values(), ids=CASES.keys())
def case(request):
    return request.param


@pytest.fixture
def component(case, tmp_path):
    return case.build(tmp_path)


def _move(component, case, dt, steps=3, seed=1):
    """Take inputs and step, again and again; return the outputs after each step."""
    found = []
    for number in range(steps):
        component.take(case.inputs(seed + number))
        component.step(dt)
        found.append({key: np.array(array) for key, array in outputs_of(component).items()})
    return found


def _same_bits(one: Fields, other: Fields) -> None:
    assert one.keys() == other.keys()
    for key in one:
        assert np.asarray(one[key]).tobytes() == np.asarray(other[key]).tobytes(), key


def test_every_installed_kind_has_a_case():
    assert known_kinds().keys() <= {case.kind for case in CASES.values()}


def test_units_are_legal_and_names_told_apart(component):
    for ports in (component.takes, component.gives):
        names = [port.name for port in ports]
        assert len(set(names)) == len(names)
        for port in ports:
            fields = [*port.fields, *port.static, *port.states]
            assert {one.unit for one in fields} <= UNITS
            assert {one.rate for one in port.fields} <= {"", *(f.name for f in port.fields)}


def test_give_matches_the_ports(component, case):
    shapes = {f"{port.name}.{f.name}": f.shape for port in component.gives for f in port.fields}
    _move(component, case, case.dt)
    given = outputs_of(component)
    assert given.keys() == shapes.keys()
    for key, array in given.items():
        assert array.shape[1:] == shapes[key]
        assert array.dtype == np.float64
        assert np.isfinite(array).all()
    for port in component.gives:  # one row per item
        assert len({len(given[f"{port.name}.{f.name}"]) for f in port.fields}) <= 1


def test_describe_tells_what_its_ports_announce(component):
    static = {f"{port.name}.{f.name}": f.shape for port in component.gives for f in port.static}
    states = {f"{port.name}.{f.name}": f.shape for port in component.takes for f in port.states}
    described = component.describe()
    assert described.keys() <= static.keys() | states.keys()
    assert states.keys() <= described.keys()
    for key, array in described.items():
        assert array.shape[1:] == (static | states)[key]


def test_stable_dt_is_positive(component, case):
    assert component.stable_dt() > 0.0
    _move(component, case, case.dt)
    assert component.stable_dt() > 0.0


def test_it_counts_what_it_advances_and_what_it_holds(component, case):
    _move(component, case, case.dt)
    assert component.items() >= 1
    totals = component.totals()
    numbers = [totals.mass, totals.kinetic, totals.potential, totals.internal]
    assert np.isfinite([*numbers, *totals.momentum, *totals.angular_momentum]).all()
    assert totals.mass >= 0.0 and totals.kinetic >= 0.0


def test_zero_input_gives_zero_output(component, case):
    if not case.still:
        pytest.skip("it moves by itself")
    impulses = {
        f"{port.name}.{f.name}"
        for port in component.gives
        for f in port.fields
        if f.centring == "impulse"
    }
    before = {key: np.array(array) for key, array in outputs_of(component).items()}
    for _ in range(3):
        component.take(case.inputs())
        component.step(case.dt)
    for key, array in outputs_of(component).items():
        expected = 0.0 if key in impulses else before[key]
        np.testing.assert_allclose(array, expected, rtol=0.0, atol=1e-14, err_msg=key)


def test_two_half_steps_come_to_one(case, tmp_path):
    """They differ by the step's square or better: a half as long, a quarter as far apart."""
    if not case.smooth:
        pytest.skip("its answer is not smooth in time")
    steps = [case.dt, 0.5 * case.dt] if case.any_time else [case.dt]
    gaps = [_gap(case, tmp_path, dt) for dt in steps]
    if not case.any_time:
        assert max(gaps[0].values()) == 0.0
        return
    for key, gap in gaps[0].items():
        assert gaps[1][key] <= 0.3 * gap + 1e-13, key


def _gap(case, tmp_path, dt):
    """Difference of one step and two half ones, for instants and for impulses."""
    ends, sums = [], []
    for pieces in (1, 2):
        component = case.build(tmp_path)
        component.take(case.inputs(1))
        total: dict[str, Array] = {}
        for piece in range(pieces):
            component.step(dt / pieces)
            if case.any_time or piece + 1 == pieces:
                given = outputs_of(component)
            total = {key: total.get(key, 0.0) + dt / pieces * given[key] for key in given}
        ends.append(given)
        sums.append(total)
    found = {}
    for port in component.gives:
        for one in port.fields:
            key = f"{port.name}.{one.name}"
            a, b = sums if one.centring == "impulse" else ends
            found[key] = float(np.abs(a[key] - b[key]).max())
    return found


def test_load_then_repeat_gives_the_same_bits(component, case, tmp_path):
    _move(component, case, case.dt)
    saved = {key: np.array(array) for key, array in component.save().items()}
    first = _move(component, case, case.dt, seed=9)
    component.load(frozen(saved))
    _same_bits(component.save(), saved)
    fresh = case.build(tmp_path)
    fresh.load(frozen(saved))
    for other in (component, fresh):
        for one, again in zip(first, _move(other, case, case.dt, seed=9), strict=True):
            _same_bits(one, again)


def test_what_is_saved_goes_over_a_line(component, case):
    _move(component, case, case.dt)
    saved = {key: np.array(array) for key, array in component.save().items()}
    _same_bits(decode(bytes(encode({"order": "done"}, saved, None))).fields, saved)


def test_what_is_saved_does_not_change_afterwards(component, case):
    _move(component, case, case.dt)
    saved = component.save()
    bits = {key: np.array(array) for key, array in saved.items()}
    _move(component, case, case.dt, seed=9)
    _same_bits(saved, bits)


def test_what_is_loaded_is_not_written_to(component, case):
    _move(component, case, case.dt)
    saved = frozen(component.save())
    bits = {key: np.array(array) for key, array in saved.items()}
    component.load(saved)
    _move(component, case, case.dt, seed=9)
    _same_bits(saved, bits)


def test_outputs_are_copies(component, case):
    _move(component, case, case.dt)
    first = outputs_of(component)
    kept = {key: np.array(array) for key, array in first.items()}
    for array in first.values():
        array[...] = np.nan
    _same_bits(outputs_of(component), kept)
    _move(component, case, case.dt, seed=9)
    assert all(np.isfinite(array).all() for array in outputs_of(component).values())


def test_received_arrays_are_neither_written_to_nor_kept(case, tmp_path):
    """Buffers of a line are used again: what they hold later must not matter."""
    outputs = []
    for spoils in (False, True):
        component = case.build(tmp_path)
        buffers = {key: np.array(array) for key, array in case.inputs(1).items()}
        views = {key: array.view() for key, array in buffers.items()}
        for view in views.values():
            view.flags.writeable = False
        component.take(views)
        component.step(case.dt)
        assert all((buffers[key] == array).all() for key, array in case.inputs(1).items())
        for buffer in buffers.values() if spoils else ():
            buffer[...] = 1e9
        component.step(case.dt)
        outputs.append(outputs_of(component))
    _same_bits(*outputs)
