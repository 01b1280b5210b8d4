"""Threads are advised by Amdahl's law and by the components for which others wait."""

import pytest

from quintet.coupler.coupling.plan import CouplingPlan
from quintet.coupler.measures.advice import (
    Load,
    Stage,
    advice,
    advised_cores,
    duration,
    loads_of,
    sentences,
    serial_share,
    stages,
    times_on,
    waits,
)
from quintet.coupler.scene.planned_times import planned_advice, planned_load, planned_seconds
from quintet.coupler.scene.read import load

SLOW_AND_FAST = {"slow": Load(90.0, serial=0.1), "fast": Load(10.0, serial=0.1)}
AFTER, AT_ONCE = (Stage(("slow", "fast"), at_once) for at_once in (False, True))


def _plan(scheme, **members):
    return CouplingPlan("", members, scheme)


def _seconds(stage, loads, **cores):
    return duration(stage, times_on(loads, cores))


def test_times_follow_amdahls_law_from_whatever_cores_were_measured():
    load = Load(100.0, 1, 0.2)
    assert load.on(4) == pytest.approx(100.0 * (0.2 + 0.8 / 4))
    assert Load(load.on(4), 4, 0.2).on(1) == pytest.approx(100.0)
    assert Load(load.on(4), 2, 0.2, ranks=2).on(8) == pytest.approx(load.on(8))


def test_serial_share_is_found_from_processor_time():
    """On 4 cores a share of 0.2 takes 40 s of 100 s, and its threads compute for 100 s."""
    assert serial_share(40.0, 100.0, 4) == pytest.approx(0.2)
    assert serial_share(40.0, 170.0, 4) == 0.0 and serial_share(40.0, 40.0, 4) == 1.0
    assert serial_share(40.0, 40.0, 1) is None and serial_share(0.0, 0.0, 4) is None
    assert serial_share(40.0, 20.0, 4) is None, "other programs used the cores"


def test_of_components_at_once_the_slow_one_gets_the_cores_and_the_opposite_is_slower():
    cores = advised_cores(AT_ONCE, SLOW_AND_FAST, 4)
    assert cores == {"slow": 3, "fast": 1}
    advised, opposite = (_seconds(AT_ONCE, SLOW_AND_FAST, **c) for c in (cores, _swapped(cores)))
    assert advised == pytest.approx(90.0 * (0.1 + 0.9 / 3)) and opposite == 90.0


def _swapped(cores):
    return {"slow": cores["fast"], "fast": cores["slow"]}


def test_components_that_follow_each_other_all_get_all_cores_unless_they_gain_nothing():
    assert advised_cores(AFTER, SLOW_AND_FAST, 4) == {"slow": 4, "fast": 4}
    tiny = {"slow": Load(90.0, serial=0.1), "fast": Load(0.1, serial=0.1)}
    assert advised_cores(AFTER, tiny, 4) == {"slow": 4, "fast": 1}
    no_threads = {"slow": Load(90.0), "fast": Load(10.0, serial=0.1)}
    assert advised_cores(AFTER, no_threads, 4) == {"slow": 1, "fast": 4}


def test_no_other_division_of_the_cores_is_faster():
    loads = {"a": Load(50.0, 2, 0.3), "b": Load(70.0, 1, 0.05), "c": Load(5.0, 1, 0.1)}
    stage = stages(_plan("parallel", a=None, g=_plan("serial", b=None, c=None)))
    best = _seconds(stage, loads, **advised_cores(stage, loads, 6))
    times = [_seconds(stage, loads, a=number, b=6 - number, c=6 - number) for number in range(1, 6)]
    assert best <= 1.01 * min(times)


def test_one_waits_for_those_after_whom_it_steps_and_for_the_slowest_at_once():
    times = {"slow": 90.0, "fast": 10.0}
    assert waits(AFTER, times) == {"slow": {"fast": 10.0}, "fast": {"slow": 90.0}}
    assert waits(AT_ONCE, times) == {"slow": {}, "fast": {"slow": pytest.approx(80.0)}}


def test_members_of_groups_wait_for_what_holds_up_their_group():
    """Groups of a parallel coupling step one after the other, while other members compute."""
    pair = _plan("serial", a=None, b=None)
    stage = stages(_plan("parallel", lone=None, pair=pair))
    times = {"a": 30.0, "b": 10.0, "lone": 20.0}
    assert duration(stage, times) == 40.0
    assert waits(stage, times) == {
        "lone": {"a": 15.0, "b": 5.0}, "a": {"b": 10.0}, "b": {"a": 30.0}
    }  # fmt: skip
    assert duration(stages(_plan("parallel", lone=None, pair=pair), False), times) == 60.0


def test_advice_says_who_should_get_what_and_how_the_share_is_known():
    loads = {"slow": Load(90.0, 1, 0.1), "fast": Load(10.0, 3, 0.2, True)}
    advised = advice(AT_ONCE, loads, 4)
    assert advised["seconds"] == 90.0 and advised["advised_seconds"] == pytest.approx(36.0)
    assert advised["components"]["slow"]["advised_threads"] == 3
    waits, text = sentences(advised)
    assert waits == "Waits: fast 80 s for slow"
    assert text == (
        "Advice for 4 cores: slow 3 threads instead of 1 thread (components.slow.threads; serial "
        "share 0.1, planned), fast 1 thread instead of 3 threads (components.fast.threads; serial "
        "share 0.2, measured): 36 s of computing instead of 90 s (Amdahl's law)"
    )
    best = {"slow": Load(36.0, 3, 0.1), "fast": Load(10.0)}
    text = sentences(advice(AT_ONCE, best, 4))[-1]
    assert text == "Advice for 4 cores: as they are, slow 3 threads, fast 1 thread"


def test_ranks_are_kept_and_their_threads_are_advised():
    advised = advice(Stage(("wide",), False), {"wide": Load(50.0, 1, 0.05, ranks=2)}, 8)
    row = advised["components"]["wide"]
    assert (row["advised_ranks"], row["advised_threads"]) == (2, 4)
    assert "wide 2 ranks of 4 threads instead of 2 ranks of 1 thread" in sentences(advised)[-1]
    lone = advice(Stage(("wide",), False), {"wide": Load(50.0, 1, 0.05, divisible=True)}, 8)
    assert (
        "wide 8 threads or 8 ranks instead of 1 thread (components.wide.threads or ranks; "
        in (sentences(lone)[-1])
    )
    assert loads_of(advised) == {"wide": Load(50.0, 1, 0.05, ranks=2)}


def test_times_before_a_run_are_items_times_steps_over_the_planned_rate(monkeypatch):
    scene = load("dam_break_cubes", "quick", ["components.water.threads=1"])
    plan = scene.components["water"].planned
    step = min(plan.dt, scene.file.window)
    seconds = planned_seconds(scene.components["water"], scene.file)
    assert seconds == pytest.approx(plan.items * scene.file.end / step / plan.rate, rel=1e-3)
    monkeypatch.setattr("os.sched_getaffinity", lambda _: {0, 1})
    monkeypatch.delenv("SLURM_CPUS_ON_NODE", raising=False)
    row = planned_advice(scene)["components"]["water"]
    assert row["advised_threads"] == 2 and not row["serial_measured"]
    assert row["advised_seconds"] == pytest.approx(seconds * (plan.serial + (1 - plan.serial) / 2))


def test_cores_do_not_shorten_what_a_device_computes():
    settings = ["components.water.threads=1", "components.water.device='opencl'"]
    scene = load("dam_break_cubes", "quick", settings)
    planned = planned_load(scene.components["water"], scene.file)
    assert planned.on(8) == planned.seconds > 0.0 and not planned.divisible
