"""Absurd scenes are refused in little time; settings are taken whole or not at all."""

import time

import pytest

from quintet.coupler.cli import main
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError

BASE = 'name = "a"\nend = 1.0\nwindow = 0.1\n[components.a]\nkind = "echo"\nitems = 3\n'
EXPECT = (
    '[[expect]]\nname = "z"\ncomponent = "b"\nfield = "a.b"\nmeasure = "max"\nvalue = 1.0\n'
    'within = 1.0\nunit = "m"\nsource = "s"\n'
)
LARGE = {
    "dotted key": ".".join("a" * 21000) + " = 1\n" + BASE,
    "quoted dotted key": '."b c". '.join("a" * 11000) + " = 1\n" + BASE,
    "header": BASE + "[" + " . ".join("a" * 9000) + "]\n",
    "inline keys": BASE + "x = { " + ".".join("a" * 21000) + " = 1 }\n",
    "long key": "a" * 900_000 + " = 1\n" + BASE,
    "long name": BASE.replace("echo", "e" * 900_000),
    "long list": "order = [" + "1, " * 200_000 + "]\n" + BASE,
    "large file": BASE + "x = [" + "1, " * 4_000_000 + "]\n",
    "deep lists": BASE + "x = " + "[" * 5000 + "]" * 5000 + "\n",
    "components": BASE + "".join(f'[components.c{k}]\nkind = "echo"\n' for k in range(9000)),
    "wrong kinds": BASE + "".join(f'[components.c{k}]\nkind = "ech{k}"\n' for k in range(100)),
    "links": BASE + '[[links]]\nkind = "dirct"\n' * 20_000,
    "expectations": BASE + EXPECT * 900,
    "unknown tables": BASE + "".join(f"[t{k}]\n" for k in range(20_000)),
    "unknown keys": BASE + "".join(f"k{k} = 1\n" for k in range(20_000)),
}


@pytest.mark.parametrize("name", LARGE)
def test_an_absurd_scene_is_refused_soon(tmp_path, name):
    path = tmp_path / "scene.toml"
    path.write_text(LARGE[name])
    start = time.process_time()
    with pytest.raises(SceneError) as error_info:
        load(str(path))
    assert time.process_time() - start < 5.0
    assert max(map(len, error_info.value.mistakes)) < 5000


@pytest.mark.parametrize(
    "setting",
    [
        "end=1.0\nwindow=0.2",
        "end=1.0\r",
        "end=",
        "end= ",
        "end=1.0 # s",
        "end=1.0,",
        "end=1.0, 2.0",
        "order=['a'",
        'title="a" "b"',
        "title='a",
        'title="a" b',
        ".".join("a" * 9000) + "=1",
    ],
)
def test_a_setting_is_taken_whole_or_refused(tmp_path, setting):
    path = tmp_path / "scene.toml"
    path.write_text(BASE)
    with pytest.raises(SceneError, match="--set"):
        load(str(path), settings=[setting])


@pytest.mark.parametrize(
    ("setting", "title"),
    [
        ("title=word", "word"),
        ("title=two words", "two words"),
        ('title="a # b"', "a # b"),
        ("title= é ", " é "),
    ],
)
def test_a_word_needs_no_quotes(tmp_path, setting, title):
    path = tmp_path / "scene.toml"
    path.write_text(BASE)
    assert load(str(path), settings=[setting]).file.title == title


def test_a_path_that_is_set_twice_is_told(tmp_path, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(BASE)
    with pytest.raises(SystemExit) as exit_info:
        main(["check", str(path), "--set", "end=2.0", "--set", "end=0.5"])
    screen = capsys.readouterr()
    assert exit_info.value.code == 0 and "0.5 s over" in screen.out
    assert "quintet: --set 'end' is given 2 times: the last one counts" in screen.err


def test_the_run_of_another_kind_than_replay_is_refused(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(BASE)
    for swap in ("a=echo@runs/x", "a=replay@"):
        with pytest.raises(SceneError, match="@ names the run of a replay"):
            load(str(path), swaps=[swap])


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ('expect.1.name="lower.end"', "expect: 2 have the name 'lower.end'"),
        (
            'links.0.pairs=[["lower.motion", "upper.foot"], ["lower.motion", "upper.foot"]]',
            "pairs must be different",
        ),
    ],
)
def test_what_is_given_twice_is_refused(setting, words):
    with pytest.raises(SceneError, match=words):
        load("two_springs", settings=[setting])


def test_check_says_which_expectations_a_run_does_not_reach(tmp_path, capsys):
    with pytest.raises(SystemExit):
        main(["check", "two_springs", "--set", "end=0.5"])
    assert "not reached, as it needs t = 1 s and the run ends at 0.5 s" in capsys.readouterr().out
