"""`quintet check --picture`: what a scene shows at its start, without a step."""

from pathlib import Path

import pytest

from quintet.coupler.cli import main
from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.report import three_views
from quintet.coupler.run import loop
from quintet.coupler.run.first_view import write_first_view
from quintet.coupler.scene.read import load

SIZE = 5000  # bytes, of a picture that shows something


def status(*arguments: str) -> object:
    with pytest.raises(SystemExit) as exit_info:
        main(["check", *arguments])
    return exit_info.value.code


def test_check_draws_the_start_and_no_window_passes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("a window was advanced")

    monkeypatch.setattr(loop, "advance", refuse)
    picture = tmp_path / "start.png"
    assert status("taylor_bar", "--preset", "quick", "--picture", str(picture)) == 0
    assert picture.stat().st_size > SIZE
    assert f"picture: {picture}" in capsys.readouterr().out
    assert [path.name for path in tmp_path.iterdir()] == ["start.png"]


def test_all_components_and_walls_are_written_at_time_0(tmp_path: Path) -> None:
    scene = load("two_springs", transport="memory")
    names = write_first_view(scene, tmp_path)
    assert names
    for name in names:
        (path,) = tmp_path.glob(f"{name}*.vtkhdf")
        assert vtkhdf_reader.times(path).tolist() == [0.0]
    out = three_views.draw_three_views(tmp_path, tmp_path / "start.svg", title="springs")
    text = out.read_text()
    # Matplotlib names each panel in a comment of the file.
    assert all(f"<!-- {view} view" in text for view in ("side", "front", "top"))


def test_a_picture_that_is_there_is_kept_unless_forced(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = tmp_path / "start.png"
    picture.write_text("mine")
    assert status("taylor_bar", "--preset", "quick", "--picture", str(picture)) == 2
    assert f"--picture {picture}: it exists" in capsys.readouterr().err
    assert picture.read_text() == "mine"
    assert status("taylor_bar", "--preset", "quick", "--force", "--picture", str(picture)) == 0
    assert picture.stat().st_size > SIZE


def test_a_picture_needs_a_known_ending(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert status("taylor_bar", "--picture", str(tmp_path / "start.txt")) == 2
    assert "it must end with one of .png" in capsys.readouterr().err


def test_code_of_a_scene_is_not_imported_for_a_picture(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "evil.py").write_text("raise AssertionError('it was imported')")
    scene = tmp_path / "scene.toml"
    scene.write_text('name = "evil"\nend = 1.0\n[components.a]\nkind = "evil:Class"\n')
    picture = tmp_path / "start.png"
    assert status(str(scene), "--picture", str(picture)) == 2
    assert "evil:Class is code that check does not import by itself" in capsys.readouterr().err
    assert not picture.exists()


def test_a_picture_whose_folder_is_a_file_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("mine")
    assert status("two_springs", "--import", "--picture", str(tmp_path / "file/start.png")) == 2
    assert "it must lie in a folder" in capsys.readouterr().err
