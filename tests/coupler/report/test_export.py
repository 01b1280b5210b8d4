"""A run's recording is exported to other programs with units, times and names."""

import csv
import sys

import numpy as np
import pytest
from spring_scene import command, write

import quintet
from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.coupler.report import series_drawing as drawing
from quintet.coupler.report.columns import columns_of
from quintet.coupler.report.recorded import Series
from quintet.interfaces.errors import SceneError

PUSH = '''
from quintet.interfaces.component import Port
from quintet.interfaces.ports import FORCE
from toy_spring import Spring


class Pushing(Spring):
    """It also gives its pull as an impulse, which nobody takes."""

    gives = (*Spring.gives, Port("pushed", (FORCE,)))

    def give(self, wanted):
        fields = {**super().give(wanted), "pushed.force": self.pull()}
        return {key: array for key, array in fields.items() if key in wanted}
'''


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder of a run of a spring for 0.1 s in windows of 0.02 s, whose pull is recorded."""
    place = tmp_path_factory.mktemp("spring")
    path = write(place, '[output]\nfields = ["spring.pushed.force", "spring.motion.velocity"]\n')
    (place / "pushing.py").write_text(PUSH)
    text = path.read_text().replace("toy_spring:Spring", "pushing:Pushing")
    begin, end = text.index("[[expect]]"), text.index("[output]")
    path.write_text((text[:begin] + text[end:]).replace("end = 1.0", "end = 0.1"))
    assert command("run", path, "--out", place / "out") == 0
    return place / "out"


def _rows(path):
    with open(path, newline="") as file:
        return list(csv.reader(file))


def test_each_port_and_the_ledger_are_a_file_with_units_in_its_head(folder, tmp_path, capsys):
    assert command("export", folder, "--out", tmp_path / "csv") == 0
    names = sorted(path.name for path in (tmp_path / "csv").iterdir())
    assert names == ["ledger.csv", "spring.motion.csv", "spring.pushed.csv"]
    head, *rows = _rows(tmp_path / "csv/spring.motion.csv")
    assert head == ["time [s]", *(f"velocity {axis} [m/s]" for axis in "xyz")]
    velocity = quintet.load(folder).fields["spring.motion.velocity"]
    np.testing.assert_array_equal(np.array(rows, float)[:, 0], velocity.times)
    np.testing.assert_array_equal(np.array(rows, float)[:, 1:], velocity.values[:, 0])
    head, *rows = _rows(tmp_path / "csv/ledger.csv")
    assert {"time [s]", "name", "kinetic [J]", "impulse_x [N s]", "momentum_residual [1]"} <= {
        *head
    }
    assert {row[1] for row in rows} == {"spring"}


def test_an_impulse_is_its_mean_over_each_window(folder, tmp_path):
    assert command("export", folder, "spring.pushed", "--out", tmp_path / "csv") == 0
    head, start, *rows = _rows(tmp_path / "csv/spring.pushed.csv")
    assert head[1] == "force x [N]" and start[1:] == ["", "", ""]
    run = quintet.load(folder)
    integral = run.fields["spring.pushed.force"]
    assert integral.unit == "N s"
    mean = np.diff(integral.times)[:, None] * np.array(rows, float)[:, 1:]
    np.testing.assert_allclose(mean, integral.values[1:, 0], rtol=1e-12)


def test_nothing_is_overwritten_and_unknown_names_are_told(folder, tmp_path, capsys):
    out = tmp_path / "csv"
    assert command("export", folder, "--out", out) == 0
    (out / "mine.csv").write_text("mine")
    assert command("export", folder, "--out", out) == 2
    assert (
        "3 of the files do. Name another folder by --out, or use --force."
        in capsys.readouterr().err
    )
    assert command("export", folder, "--out", out, "--force") == 0
    assert (out / "mine.csv").read_text() == "mine"
    assert command("export", folder, "spring.moton", "--out", tmp_path / "b") == 2
    assert "spring.moton is not known. Did you mean spring.motion?" in capsys.readouterr().err
    assert command("export", tmp_path) == 2
    assert "it has no results.json" in capsys.readouterr().err
    assert command("export", folder, "--out", out / "mine.csv") == 2
    assert "must be a folder; found a file" in capsys.readouterr().err


def test_an_export_does_not_replace_the_ledger_of_the_run(folder, capsys):
    ledger = (folder / "ledger.csv").read_bytes()
    assert command("export", folder, "--out", folder, "--force") == 2
    assert "must not be the folder of the run" in capsys.readouterr().err
    assert (folder / "ledger.csv").read_bytes() == ledger


def test_names_of_columns_say_field_item_axis_and_unit():
    times = np.arange(2.0)
    wide = columns_of("velocity", Series(np.arange(12.0).reshape(2, 2, 3), times, "m/s"))
    assert wide.names == [f"velocity {k} {axis} [m/s]" for k in (0, 1) for axis in "xyz"]
    assert wide.values[1].tolist() == [6.0, 7.0, 8.0, 9.0, 10.0, 11.0]
    assert columns_of("height", Series(np.zeros((2, 1)), times, "m")).names == ["height [m]"]
    assert columns_of("q", Series(np.zeros((2, 1, 4)), times, "1")).names[0] == "q w [1]"
    assert columns_of("s", Series(np.zeros((2, 1, 2)), times, "Pa")).names[1] == "s 1 [Pa]"


def test_wide_fields_are_left_out_unless_they_are_named(folder, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("quintet.coupler.report.columns.MOST", 2)
    assert command("export", folder, "--out", tmp_path / "a") == 0
    assert "left out" in (output := capsys.readouterr().out) and "spring.motion.velocity" in output
    assert command("export", folder, "spring.motion", "--out", tmp_path / "b") == 0
    assert (tmp_path / "b/spring.motion.csv").is_file()
    assert command("draw", folder, "--series") == 2
    assert "Name those that shall be drawn." in capsys.readouterr().err


def test_a_run_becomes_a_table_of_pandas(folder):
    pandas = pytest.importorskip("pandas")
    run = quintet.load(folder)
    table = run.to_pandas()
    assert isinstance(table, pandas.DataFrame) and table.index.name == "time [s]"
    velocity = run.fields["spring.motion.velocity"]
    column = table["spring.motion.velocity x [m/s]"]
    np.testing.assert_array_equal(column.to_numpy(), velocity.values[:, 0, 0])
    assert run.to_pandas("spring.pushed").shape == (len(velocity), 3)
    with pytest.raises(SceneError, match="Did you mean spring"):
        run.to_pandas("sprong")


def test_a_run_becomes_a_data_set_of_xarray(folder):
    pytest.importorskip("xarray")
    data = quintet.load(folder).to_xarray()
    velocity = data["spring.motion.velocity"]
    assert velocity.attrs["units"] == "m/s" and velocity.dims[0] == "time"
    assert data.time.attrs["units"] == "s"
    assert float(velocity.sel(axis="x", time=0.0).squeeze()) == 0.0
    assert data["spring.pushed.force"].attrs["cell_methods"] == "mean over each window"


@pytest.mark.parametrize("library", ["pandas", "xarray"])
def test_a_library_that_lacks_is_named_with_its_extra(folder, monkeypatch, library):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(SceneError, match=rf"needs the library {library}.*quintet\[tables\]"):
        getattr(quintet.load(folder), f"to_{library}")()


def test_recorded_fields_are_drawn_though_nothing_is_expected_of_them(folder, monkeypatch):
    figures, save = [], drawing.save
    monkeypatch.setattr(drawing, "save", lambda f, out: figures.append(f) or save(f, out))
    assert command("draw", folder, "--series") == 0
    assert (folder / "series.png").is_file()
    first, second = figures[0].axes
    assert first.get_ylabel() == "velocity [m/s]" and len(first.lines) == 3
    assert second.get_ylabel() == "force [N]" and "mean over each window" in second.get_title()
    x = quintet.load(folder).fields["spring.motion.velocity"]
    np.testing.assert_array_equal(first.lines[0].get_ydata(), x.values[:, 0, 0])


def test_a_view_is_read_at_a_time(folder):
    file = VtkHdf(folder / "water.vtkhdf", {"velocity": "m/s"})
    for k in range(3):
        points = np.full((4, 3), float(k))
        file.append(0.1 * k, {"points": points, "velocity": points})
    file.close()
    views = quintet.load(folder).views
    assert list(views) == ["water"] and views["water"].times.tolist() == [0.0, 0.1, 0.2]
    step = views["water"].at(0.11)
    assert step.time == 0.1 and step.units["velocity"] == "m/s"
    np.testing.assert_array_equal(step["points"], np.ones((4, 3)))
    with pytest.raises(SceneError, match=r"from 0 to 0\.2 s; found 0\.3"):
        views["water"].at(0.3)
    with pytest.raises(KeyError, match="Did you mean water"):
        views["watr"]
    with pytest.raises(KeyError, match="Did you mean velocity"):
        step["velocty"]
