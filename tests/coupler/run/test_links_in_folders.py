"""No file is written, moved or removed through a link in a run's folder."""

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
def scene_folder(tmp_path_factory):
    """A scene, and the folder of a run of it."""
    folder = tmp_path_factory.mktemp("ended")
    path = write_scene(folder, end=0.005)
    path.write_text(path.read_text() + STUDY)
    assert status("run", path, "--out", folder / "out") == 0
    return folder


@pytest.fixture
def user_folder(scene_folder, tmp_path):
    """Copies of the scene and its run, beside a folder of somebody else."""
    shutil.copytree(scene_folder, tmp_path, dirs_exist_ok=True)
    (tmp_path / "foreign" / "log").mkdir(parents=True)
    for name in ("mine.txt", "ledger.csv", "log/ping.log"):
        (tmp_path / "foreign" / name).write_text("mine")
    return tmp_path


def put(place, make):
    """Make an entry at a place, instead of the present one."""
    place.parent.mkdir(exist_ok=True)
    if place.is_dir():
        shutil.rmtree(place)
    place.unlink(missing_ok=True)
    make(place)


def is_refused(user_folder, capsys, words, *arguments):
    """Whether a command is refused in one sentence, with all files unchanged."""
    old_content = content(user_folder)
    assert status(*arguments) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1 and words in lines[0], lines
    assert content(user_folder) == old_content
    return True


@pytest.mark.parametrize("option", ["--force", "--resume"])
@pytest.mark.parametrize("name", PLACES)
def test_a_link_in_the_place_of_a_file_is_refused(user_folder, capsys, name, option):
    out, foreign = user_folder / "out", user_folder / "foreign" / "mine.txt"
    put(out / name, lambda place: place.symlink_to(foreign))
    arguments = (
        ["--resume", out]
        if option == "--resume"
        else [user_folder / "scene.toml", "--out", out, option]
    )
    assert is_refused(user_folder, capsys, f"{name} must be this folder's own", "run", *arguments)


@pytest.mark.parametrize("option", ["--force", "--resume"])
@pytest.mark.parametrize("name", FOLDERS)
def test_a_link_in_the_place_of_a_folder_is_refused(user_folder, capsys, name, option):
    out = user_folder / "out"
    put(out / name, lambda place: place.symlink_to(user_folder / "foreign"))
    arguments = (
        ["--resume", out]
        if option == "--resume"
        else [user_folder / "scene.toml", "--out", out, option]
    )
    words = f"it is a symbolic link to {user_folder / 'foreign'}."
    assert is_refused(user_folder, capsys, words, "run", *arguments)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda place: os.link(place.parents[1] / "foreign" / "mine.txt", place), "2 hard links"),
        (os.mkfifo, "a named pipe"),
        (lambda place: place.mkdir(), "a folder in the place of a file"),
        (lambda place: place.symlink_to("nowhere"), "a symbolic link to nowhere"),
    ],
)
def test_what_is_no_plain_file_is_refused(user_folder, capsys, make, words):
    out = user_folder / "out"
    put(out / "ledger.csv", make)
    for arguments in (["--resume", out], [user_folder / "scene.toml", "--out", out, "--force"]):
        assert is_refused(user_folder, capsys, words, "run", *arguments)


def test_a_link_above_a_folder_is_followed(user_folder):
    (user_folder / "data").mkdir()
    (user_folder / "runs").symlink_to(user_folder / "data")
    for force in ([], ["--force"]):
        assert (
            status("run", user_folder / "scene.toml", "--out", user_folder / "runs" / "a", *force)
            == 0
        )
    assert (user_folder / "data" / "a" / "results.json").is_file()


def test_a_link_in_an_empty_folder_is_refused(user_folder, capsys):
    (user_folder / "new").mkdir()
    (user_folder / "new" / LOCK).symlink_to(user_folder / "foreign" / "mine.txt")
    arguments = ("run", user_folder / "scene.toml", "--out", user_folder / "new")
    assert is_refused(user_folder, capsys, f"{LOCK} must be this folder's own", *arguments)


def test_a_link_in_a_study_is_refused(user_folder, capsys):
    arguments = ("study", user_folder / "scene.toml", "--out", user_folder / "s")
    assert status(*arguments) == 0
    capsys.readouterr()
    (run,) = (
        path for path in (user_folder / "s").iterdir() if path.is_dir() and path.name.endswith("a")
    )
    put(run, lambda place: place.symlink_to(user_folder / "foreign"))
    for option in ("--force", "--keep"):
        assert is_refused(
            user_folder, capsys, f"{run.name} must be this folder's own", *arguments, option
        )
