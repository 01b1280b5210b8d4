"""A run that begins from the state of another run: the same bits if the scene is unchanged."""

import json
from pathlib import Path

import numpy as np
import pytest
from stages import is_the_end_of, rows, run, status, two_stages
from started import write_scene

from quintet.coupler.files.states import hash_of, states_of
from quintet.coupler.run import simulate
from quintet.coupler.scene.read import load
from quintet.coupler.study.run_hash import run_hash
from quintet.interfaces.errors import SceneError

SCENARIOS = Path(__file__).parents[2] / "scenarios"
ZENOH = pytest.param("zenoh", marks=pytest.mark.zenoh)


@pytest.mark.parametrize("transport", ["memory", ZENOH])
@pytest.mark.parametrize("scheme", ["serial", "parallel", "iterated"])
def test_toys_go_on_with_the_same_bits(tmp_path, scheme, transport):
    scene = write_scene(tmp_path, ping="substeps = 7", pong="substeps = 3")
    whole, continued = two_stages(scene, tmp_path, 0.03, f'scheme="{scheme}"', transport=transport)
    assert len(rows(continued)["ping/out.number"]) == 31 and is_the_end_of(continued, whole)


def test_two_springs_that_iterate_go_on_with_the_same_bits(tmp_path):
    assert is_the_end_of(*reversed(two_stages("two_springs", tmp_path, 0.04)))


def test_water_and_a_body_go_on_with_the_same_bits(tmp_path):
    stages = two_stages(SCENARIOS / "small_dam.toml", tmp_path, 0.02)
    assert is_the_end_of(*reversed(stages))


@pytest.mark.parametrize("scheme", ["serial", "iterated"])
def test_toys_in_a_group_go_on_with_the_same_bits(tmp_path, scheme):
    scene = write_scene(tmp_path, ping="substeps = 4", pong="substeps = 2")
    lines = ["[groups.both]", 'members = ["ping", "pong"]', "window = 5e-4"]
    scene.write_text("\n".join([scene.read_text(), *lines, f'scheme = "{scheme}"']))
    stages = two_stages(scene, tmp_path, 0.03)
    assert is_the_end_of(*reversed(stages))


def test_components_that_are_not_named_start_as_they_are_described(tmp_path):
    scene = write_scene(tmp_path)
    first = run(scene, tmp_path / "first", "end=0.03", "output.states=[1.0]")
    begin = f'begin_from={{run="{first}", components=["ping"]}}'
    first_rows, second_rows = rows(first), rows(run(scene, tmp_path / "again", begin, "end=0.01"))
    assert np.array_equal(second_rows["ping/out.number"][0], first_rows["ping/out.number"][-1])
    assert np.array_equal(second_rows["pong/out.number"][0], first_rows["pong/out.number"][0])


def test_time_begins_at_0_and_the_books_close(tmp_path):
    scene = write_scene(tmp_path)
    _, continued = two_stages(scene, tmp_path, 0.03)
    results = json.loads((continued / "results.json").read_text())
    assert results["time"] == 0.03 and results["windows"] == 30
    link = results["ledger"]["links"][0]
    assert link["momentum_residual"] < 1e-12


def test_another_link_begins_with_components_where_they_were(tmp_path):
    scene = write_scene(tmp_path)
    first = run(scene, tmp_path / "first", "end=0.03", "output.states=[1.0]")
    settings = (f'begin_from="{first}"', "end=0.01", 'links.0.name="other"')
    continued = run(scene, tmp_path / "again", *settings)
    first_rows, second_rows = rows(first), rows(continued)
    instants = [key for key in first_rows if key.endswith("number")]
    assert all(np.array_equal(first_rows[key][-1], second_rows[key][0]) for key in instants)


def test_a_state_is_chosen_by_its_time(tmp_path):
    scene = write_scene(tmp_path)
    whole = run(scene, tmp_path / "whole", "end=0.03", "output.states=[0.01, 0.02]")
    assert [path.name for path in states_of(whole)] == ["state-10.h5", "state-20.h5"]
    begin = f'begin_from={{run="{whole}", time=0.01}}'
    continued = run(scene, tmp_path / "again", begin, "end=0.02")
    assert is_the_end_of(continued, whole)
    with pytest.raises(SceneError, match=r"time must be .* at 0\.01, 0\.02 s; found 0\.015 s"):
        load(str(scene), settings=[f'begin_from={{run="{whole}", time=0.015}}'])


def test_results_name_the_run_begun_from(tmp_path):
    scene = write_scene(tmp_path)
    _, continued = two_stages(scene, tmp_path, 0.01)
    beginning = json.loads((continued / "results.json").read_text())["begin_from"]
    first = tmp_path / "first"
    marker = json.loads((first / "quintet-run.json").read_text())
    assert (
        beginning["run"] == str(first)
        and beginning["id"] == marker["run"]
        and beginning["scene"] == "toy"
    )
    assert beginning["hash"] == hash_of(first / beginning["state"]) and beginning["time"] == 0.01
    assert beginning["components"] == ["ping", "pong"]


def test_a_run_is_kept_though_the_one_that_it_began_from_is_gone(tmp_path, monkeypatch):
    scene = write_scene(tmp_path)
    first = run(scene, tmp_path / "first", "end=0.01", "output.states=[1.0]")
    evaluate = simulate.results.outcomes

    def evaluate_and_move(*arguments):
        first.rename(tmp_path / "moved")
        return evaluate(*arguments)

    monkeypatch.setattr(simulate.results, "outcomes", evaluate_and_move)
    continued = run(scene, tmp_path / "again", f'begin_from="{first}"', "end=0.01")
    assert json.loads((continued / "results.json").read_text())["begin_from"]["run"] == str(first)


def test_the_folder_that_it_begins_from_is_not_replaced(tmp_path, capsys):
    scene = write_scene(tmp_path)
    first = run(scene, tmp_path / "first", "end=0.01", "output.states=[1.0]")
    arguments = ("--set", f'begin_from="{first}"', "--out", first, "--force")
    assert status("run", scene, *arguments) == 2
    assert "it must be another folder than that of begin_from" in capsys.readouterr().err
    assert (first / "results.json").is_file() and states_of(first)


def test_a_component_that_is_no_table_is_told(tmp_path):
    scene = write_scene(tmp_path)
    first = run(scene, tmp_path / "first", "end=0.01", "output.states=[1.0]")
    with pytest.raises(SceneError, match=r"components\.pong"):
        load(str(scene), settings=[f'begin_from="{first}"', "components.pong=3"])


def test_the_hash_of_a_run_covers_the_state_that_it_begins_from(tmp_path):
    scene = write_scene(tmp_path)
    two_stages(scene, tmp_path, 0.01)
    begin_settings = [f'begin_from="{tmp_path / "first"}"']
    first_hash = run_hash(load(str(scene), settings=begin_settings))
    run_arguments = ("--transport", "memory", "--out", tmp_path / "first", "--force")
    set_arguments = (
        "--set",
        "output.states=[1.0]",
        "--set",
        "end=0.01",
        "--set",
        'scheme="parallel"',
    )
    assert status("run", scene, *run_arguments, *set_arguments) == 0
    assert run_hash(load(str(scene), settings=begin_settings)) != first_hash


def test_a_folder_may_be_named_from_the_scene_or_from_here(tmp_path, monkeypatch):
    scene = write_scene(tmp_path)
    run(scene, tmp_path / "runs/settle", "end=0.01", "output.states=[1.0]")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    for place in (tmp_path, elsewhere):
        monkeypatch.chdir(place)
        checked_scene = load(str(scene), settings=['begin_from="runs/settle"'])
        assert checked_scene.beginning.folder == tmp_path / "runs/settle"


def test_an_interrupted_second_stage_is_resumed_with_the_same_bits(tmp_path, monkeypatch):
    from quintet.coupler.run import snapshots

    scene = write_scene(tmp_path)
    whole, _ = two_stages(scene, tmp_path, 0.03)
    monkeypatch.setattr(snapshots, "remove", lambda paths: None)
    settings = [f'begin_from="{tmp_path / "first"}"', "end=0.03", "output.snapshots=0.01"]
    checked_scene = load(str(scene), settings=settings)
    folder = tmp_path / "resumed"
    simulate.make_folder(checked_scene, folder)
    assert simulate.simulate(checked_scene, folder) == 0
    snapshot = folder / "snapshot-20.h5"
    assert simulate.simulate(load(str(scene), settings=settings), folder, snapshot) == 0
    assert is_the_end_of(folder, whole)


@pytest.mark.parametrize(
    ("begin", "message"),
    [
        ('"nowhere"', r"begin_from must be the folder of a run; found 'nowhere'"),
        ('"first"', r"must have kept a state; it has none\. Let it keep one with --set"),
        ('{run="kept", components=["pang"]}', r"pang of this scene is not known\. Did you mean p"),
        ('{run="kept", tyme=1.0}', r"begin_from\.tyme is not known\. Did you mean time\?"),
        ("3", r"begin_from"),
    ],
)
def test_what_cannot_be_begun_from_is_refused(tmp_path, monkeypatch, begin, message):
    scene = write_scene(tmp_path)
    run(scene, tmp_path / "first", "end=0.01")
    run(scene, tmp_path / "kept", "end=0.01", "output.states=[1.0]")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SceneError, match=message):
        load(str(scene), settings=[f"begin_from={begin}"])


def test_components_of_other_kinds_and_names_are_refused(tmp_path):
    scene = write_scene(tmp_path)
    first = run(scene, tmp_path / "first", "end=0.01", "output.states=[1.0]")
    path = tmp_path / "other.toml"
    text = scene.read_text()
    lines = [f'begin_from = "{first}"', *text.replace("toys:Toy", "echo", 1).splitlines()]
    path.write_text("\n".join(lines))
    with pytest.raises(SceneError, match=r"ping must be of kind toys:Toy, as in .*; found echo"):
        load(str(path))
    renamed_text = text.replace("ping", "a").replace("pong", "b")
    path.write_text("\n".join([f'begin_from = "{first}"', *renamed_text.splitlines()]))
    with pytest.raises(SceneError, match=r"in the run in .* there are ping, pong, here a, b"):
        load(str(path))


def test_a_run_does_not_replace_the_one_that_it_begins_from(tmp_path, monkeypatch, capsys):
    scene = write_scene(tmp_path)
    monkeypatch.chdir(tmp_path)
    folder = Path("runs") / load(str(scene)).file.name
    run(scene, folder, "end=0.01", "output.states=[1.0]")
    begin = ("--set", f'begin_from="{folder}"', "--force")
    for out in ((), ("--out", folder)):
        assert status("run", scene, *begin, *out) == 2
        words = f"--out {folder}: it must be another folder than that of begin_from"
        assert words in capsys.readouterr().err
    assert states_of(folder)
