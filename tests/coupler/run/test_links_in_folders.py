"""Nothing is written, moved or removed through a link in a run's folder."""

import os
import shutil

import pytest
from started import write_scene
from test_folder import STUDY, content, status

from quintet.coupler.files.run_files import LOCK, MARKER
from quintet.coupler.run.folder import FORMER

PLACES = [
    "results.json",
    "recording.h5",
    "ledger.csv",
    "scene.toml",
    "scene.toml.part",
    "scene.png",
    "ping.vtkhdf",
    "pong.walls.vtkhdf",
    "snapshot-5.h5",
    "snapshot-6.h5.part",
    "quintet-reserve",
    LOCK,
    MARKER + ".part",
    "log/coupler.out",
    f"{FORMER}/ledger.csv",
]
FOLDERS = ["log", FORMER]


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    """A scene, and the folder of a run of it."""
    folder = tmp_path_factory.mktemp("ended")
    path = write_scene(folder, end=0.005)
    path.write_text(path.read_text() + STUDY)
    assert status("run", path, "--out", folder / "out") == 0
    return folder


@pytest.fixture
def here(ended, tmp_path):
    """Copies of them, beside a folder of somebody else."""
    shutil.copytree(ended, tmp_path, dirs_exist_ok=True)
    (tmp_path / "foreign" / "log").mkdir(parents=True)
    for name in ("mine.txt", "ledger.csv", "log/ping.log"):
        (tmp_path / "foreign" / name).write_text("mine")
    return tmp_path


def put(place, make):
    """Put something in a place, whatever is there."""
    place.parent.mkdir(exist_ok=True)
    if place.is_dir():
        shutil.rmtree(place)
    place.unlink(missing_ok=True)
    make(place)


def refused(here, capsys, words, *arguments):
    """Whether a command is refused in one sentence, with nothing changed."""
    before = content(here)
    assert status(*arguments) == 2
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1 and words in said[0], said
    assert content(here) == before
    return True


@pytest.mark.parametrize("how", ["--force", "--resume"])
@pytest.mark.parametrize("name", PLACES)
def test_a_link_in_the_place_of_a_file_is_refused(here, capsys, name, how):
    out, foreign = here / "out", here / "foreign" / "mine.txt"
    put(out / name, lambda place: place.symlink_to(foreign))
    asked = ["--resume", out] if how == "--resume" else [here / "scene.toml", "--out", out, how]
    assert refused(here, capsys, f"{name} must be this folder's own", "run", *asked)


@pytest.mark.parametrize("how", ["--force", "--resume"])
@pytest.mark.parametrize("name", FOLDERS)
def test_a_link_in_the_place_of_a_folder_is_refused(here, capsys, name, how):
    out = here / "out"
    put(out / name, lambda place: place.symlink_to(here / "foreign"))
    asked = ["--resume", out] if how == "--resume" else [here / "scene.toml", "--out", out, how]
    words = f"it is a symbolic link to {here / 'foreign'}."
    assert refused(here, capsys, words, "run", *asked)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda place: os.link(place.parents[1] / "foreign" / "mine.txt", place), "2 hard links"),
        (os.mkfifo, "a named pipe"),
        (lambda place: place.mkdir(), "a folder in the place of a file"),
        (lambda place: place.symlink_to("nowhere"), "a symbolic link to nowhere"),
    ],
)
def test_what_is_no_plain_file_is_refused(here, capsys, make, words):
    out = here / "out"
    put(out / "ledger.csv", make)
    for asked in (["--resume", out], [here / "scene.toml", "--out", out, "--force"]):
        assert refused(here, capsys, words, "run", *asked)


def test_a_link_above_a_folder_is_followed(here):
    (here / "data").mkdir()
    (here / "runs").symlink_to(here / "data")
    for force in ([], ["--force"]):
        assert status("run", here / "scene.toml", "--out", here / "runs" / "a", *force) == 0
    assert (here / "data" / "a" / "results.json").is_file()


def test_a_link_in_an_empty_folder_is_refused(here, capsys):
    (here / "new").mkdir()
    (here / "new" / LOCK).symlink_to(here / "foreign" / "mine.txt")
    asked = ("run", here / "scene.toml", "--out", here / "new")
    assert refused(here, capsys, f"{LOCK} must be this folder's own", *asked)


def test_a_link_in_a_study_is_refused(here, capsys):
    asked = ("study", here / "scene.toml", "--out", here / "s")
    assert status(*asked) == 0
    capsys.readouterr()
    (run,) = (path for path in (here / "s").iterdir() if path.is_dir() and path.name.endswith("a"))
    put(run, lambda place: place.symlink_to(here / "foreign"))
    for how in ("--force", "--keep"):
        assert refused(here, capsys, f"{run.name} must be this folder's own", *asked, how)
