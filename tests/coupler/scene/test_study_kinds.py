"""The kinds of refinements, and the orders to which they contribute."""

import copy

import pytest

from quintet.coupler.scene.overrides import put
from quintet.coupler.scene.quantity_texts import value_in_si
from quintet.coupler.scene.read import load
from quintet.coupler.scene.study_table import kind_of, read_refinements


def read(tables, scene, *si):
    def make_variant(settings):
        table = copy.deepcopy(scene)
        return table, [m for path, value in settings.items() for m in put(table, path, value)]

    return read_refinements(tables, make_variant, *si)


def refinement(label, size="", **settings):
    refines = {"refines": settings.pop("refines")} if "refines" in settings else {}
    return {"label": label, "settings": settings, **({"size": size} if size else {}), **refines}


@pytest.mark.parametrize(
    "path, has_links, kind",
    [
        ("window", True, "coupling"),
        ("window", False, "time step"),
        ("groups.slow.window", True, "coupling"),
        ("iteration.tolerance", True, "coupling"),
        ("links.0.relaxation", True, "coupling"),
        ("components.bar.courant", False, "time step"),
        ("components.ball.fixed_step", True, "time step"),
        ("components.water.spacing", True, "spacing"),
        ("components.gas.plate.layers.first_spacing", False, "spacing"),
        ("components.gas.sphere.layers.count", False, "spacing"),
        ("components.bar.parts.0.elements.1", False, "spacing"),
        ("components.water.viscosity.artificial", False, "model"),
        ("", False, "model"),
    ],
)
def test_the_kind_follows_from_the_path_of_the_size(path, has_links, kind):
    assert kind_of(path, has_links) == kind


SCENE = {"window": 0.1, "links": [{}], "water": {"spacing": 0.1, "depth": 2.0}}


def test_whole_numbers_are_counts_only_of_keys_that_count():
    """A window of 2 s is larger than one of 1 s; two elements are larger than four."""
    scene = {"window": 2, "components": {"bar": {"elements": 2}}}
    tables = [
        refinement("a", "window", window=2),
        refinement("b", "window", window=1),
        refinement("c", "components.bar.elements", **{"components.bar.elements": 4}),
    ]

    def si(path, value):
        return float(value) if path == "window" else value

    refinements, mistakes = read(tables, scene, si)
    assert not mistakes and [r.size for r in refinements] == [2.0, 1.0, 0.25]
    assert [r.varied["window"] for r in refinements] == [2.0, 1.0, 2.0]


@pytest.mark.parametrize(
    "path, value, number",
    [
        ("window", 2, 2.0),
        ("window", "2 ms", 0.002),
        ("window", "auto", "auto"),
        ("window", "2 kg", "2 kg"),
        ("components.lower.mass", 1, 1.0),
        ("components.lower.mass", "500 g", "500 g"),  # its kind states no unit
        ("components.lower.threads", 2, 2),
        ("components.lower.nothing", 2, 2),
    ],
)
def test_values_are_as_the_scene_runs_with_them(path, value, number):
    scene = load("two_springs")
    result = value_in_si(scene.resolved, scene.folder, True, path, value)
    assert result == number and type(result) is type(number)


def test_a_refinement_counts_for_each_kind_from_which_it_differs_in_the_size_alone():
    ladder = [refinement(f"{h} m", "water.spacing", **{"water.spacing": h}) for h in (0.4, 0.2)]
    windows = [
        refinement(f"{w} s", "window", window=w, **{"water.spacing": 0.2}) for w in (0.4, 0.2)
    ]
    deep_refinement = refinement(
        "deep", "water.spacing", **{"water.spacing": 0.1, "water.depth": 4.0}
    )
    refinements, mistakes = read([*ladder, *windows, deep_refinement], SCENE)
    assert not mistakes
    assert [row.kind for row in refinements] == 2 * ["spacing"] + 2 * ["coupling"] + ["spacing"]
    assert [row.ladders for row in refinements] == [
        ("spacing",), ("spacing", "coupling"), ("coupling",), ("coupling",), ("spacing",),
    ]  # fmt: skip
    assert refinements[1].sizes == {"spacing": 0.2, "coupling": 0.1}
    assert refinements[2].sizes == {"spacing": 0.2, "coupling": 0.4}
    assert refinements[0].varied == {"water.spacing": 0.4, "window": 0.1, "water.depth": 2.0}


def test_what_is_refined_may_be_said():
    table = refinement("a", "water.depth", refines="time step", **{"water.depth": 1.0})
    (row,), mistakes = read([table], SCENE)
    assert row.kind == "time step" and not mistakes
    (row,), _ = read([refinement("a", refines="spacing")], SCENE)
    assert row.kind == "spacing" and row.size is None and row.ladders == ()
    _, mistakes = read([refinement("a", refines="mesh")], SCENE)
    assert "study.a.refines" in mistakes[0] and "'coupling', 'time step', 'spacing'" in mistakes[0]


def test_one_size_serves_all_refinements_of_a_kind():
    tables = [refinement("a", "water.depth"), refinement("b", "water.spacing", refines="model")]
    _, mistakes = read(tables, SCENE)
    assert mistakes == [
        "study: one size must serve all refinements of the model; found water.depth, "
        "water.spacing. Name the same, or say what each refines with refines."
    ]
