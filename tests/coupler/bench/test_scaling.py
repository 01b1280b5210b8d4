"""`quintet scaling` keeps measured and extrapolated values apart, and reports bad input."""

import json

import pytest

from quintet.coupler.bench import throughput
from quintet.coupler.bench.cost_model import Network, faces
from quintet.coupler.bench.ping_pong import measure_network, network_of
from quintet.coupler.cli import main

STEPS = 10
NETWORK = {"latency": 1e-6, "bandwidth": 1e10, "cores": 2}


def row(items, ranks, series="block"):
    """An entry of `quintet bench --json`: 1 µs an item, 1 ns a byte of halo, 0.1 ms a step."""
    halo = 50.0 * faces(items / ranks, ranks, 3)
    compute = 1e-6 * items / ranks + 1e-9 * halo + 1e-4
    return {
        "name": "toy",
        "case": f"{series}, {items}",
        "series": series,
        "items": items,
        "ranks": ranks,
        "threads": 1,
        "rate": 1.0,
        "unit": "toy-steps/s",
        "cpu_seconds": STEPS * ranks * compute,
        "wall_seconds": STEPS * 2.0 * compute,
        "imbalance": 1.05 if ranks > 1 else 1.0,
        "messages": 4.0 * (ranks - 1),
        "halo_bytes": halo,
        "collectives": 8.0 if ranks > 1 else 0.0,
        "gathered_bytes": 0.0,
        "network": NETWORK,
        "options": {"steps": STEPS},
    }


ROWS = [row(items, ranks) for items in (8000, 32_000) for ranks in (1, 2, 4)]


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "rows.json"
    path.write_text(json.dumps(ROWS))
    return path


def quintet(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main([*map(str, arguments)])
    return exit_info.value.code


def test_measured_and_extrapolated_stand_in_tables_of_their_own(file, capsys):
    assert quintet("scaling", file) == 0
    text = capsys.readouterr().out
    measured, extrapolated = text.split("toy, block: extrapolated")
    assert "toy, block: measured" in measured and "extrapolated" not in measured
    rows = [line.split() for line in extrapolated.splitlines()]
    marks = {int(words[0]): words[1] for words in rows if words and words[0].isdecimal()}
    assert {ranks for ranks, mark in marks.items() if mark == "model"} == {1, 2, 4}
    assert {ranks for ranks, mark in marks.items() if mark == "extrapolated"} == {
        24, 48, 96, 192, 512, 1024, 2048, 4096,
    }  # fmt: skip
    assert extrapolated.count("(measured") == 3  # of strong scaling on 1, 2, 4 ranks
    assert "weak scaling: no case has about 3.2e+04 items on each" in measured


def test_fit_residual_and_network_are_said(file, capsys):
    assert quintet("scaling", file) == 0
    text = capsys.readouterr().out
    assert (
        "fit: 1 µs an item, 1 ns a byte of halo, 100 µs a step; 6 measurements, 3 numbers" in text
    )
    assert "compute 0.0%, halo 0.0%, messages 0.0%, collectives 0.0%, gathered 0.0%" in text
    assert "latency: 1 µs (as measured between two ranks of this host, no network)" in text
    assert "*: more ranks than the 2 cores of this host" in text
    assert "LOGOS, strong scaling: 58 to 70 % on 24 to 96 cores" in text
    assert "SWIFT, weak scaling: loses 25 % from 1 to 4096 cores" in text
    assert quintet("scaling", file, "--latency", 3e-6, "--bandwidth", 2e9) == 0
    text = capsys.readouterr().out
    assert "latency: 3 µs (as given by --latency; measured on this host: 1 µs)" in text
    assert "bandwidth: 2 GB/s (as given by --bandwidth; measured on this host: 10 GB/s)" in text


def test_weak_scaling_is_measured_where_a_case_has_as_many_on_each(file, capsys):
    assert quintet("scaling", file, "--items-per-rank", 8000) == 0
    text = capsys.readouterr().out
    assert "weak scaling: no case" not in text
    (four,) = [line for line in text.splitlines() if line.startswith("    4         model")]
    assert four.count("(measured") == 2  # strong, and 32 000 on four against 8000 on one


def test_a_file_for_programs_has_both_apart(file, tmp_path):
    out = tmp_path / "out.json"
    run = ("--items", 1e6, "--step", 0.9, "--measured-on", 2, "--on", 64, "--steps", 100)
    assert quintet("scaling", file, "--json", out, *run) == 0
    (entry,) = json.loads(out.read_text())
    assert [m["ranks"] for m in entry["measured"]] == [1, 2, 4, 1, 2, 4]
    assert [m["ranks_share_cores"] for m in entry["measured"]] == 2 * [False, False, True]
    assert all(abs(m["residual"]) < 1e-9 for m in entry["measured"])
    strong = entry["extrapolated"]["strong"]["rows"]
    assert min(r["ranks"] for r in strong) == 24 and strong[-1]["ranks"] == 4096
    for r in strong:
        assert r["step"] == pytest.approx(sum(r["terms"].values()))
    assert entry["model"]["per_item"] == pytest.approx(1e-6)
    assert entry["run"]["seconds"] == pytest.approx(100 * entry["run"]["step"])
    assert 0.9 / 32 < entry["run"]["step"] < 0.9  # slower than 32 times faster
    assert quintet("scaling", file, "--json", out) == 0  # replaces its own


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_efficiency_is_drawn_filled_hollow_and_with_a_line_between(file, tmp_path, ending):
    pytest.importorskip("matplotlib")
    out = tmp_path / f"plot.{ending}"
    assert quintet("scaling", file, "--plot", out, "--items-per-rank", 8000) == 0
    begin = out.read_bytes()[:100]
    assert begin.startswith(b"\x89PNG") if ending == "png" else b"<?xml" in begin
    assert out.stat().st_size > 10_000


def test_markers_of_measurements_are_filled_and_of_predictions_hollow(file, monkeypatch, tmp_path):
    pytest.importorskip("matplotlib")
    figures = []
    monkeypatch.setattr(
        "quintet.coupler.bench.scaling_plot.save", lambda figure, out: figures.append(figure) or out
    )
    out = tmp_path / "plot.png"
    assert quintet("scaling", file, "--plot", out, "--items-per-rank", 8000) == 0
    for panel in figures[0].axes:
        lines = {line.get_label(): line for line in panel.get_lines()}
        (measured,) = [line for label, line in lines.items() if label.startswith("measured")]
        hollow = lines["extrapolated by the model"]
        assert measured.get_fillstyle() == "full" and hollow.get_fillstyle() == "none"
        assert max(measured.get_xdata()) == 4 and min(hollow.get_xdata()) == 24
        upright = [line for line in panel.get_lines() if set(line.get_xdata()) == {4}]
        assert len(upright) == 1
    assert "LOGOS" in str(figures[0].axes[0].get_legend_handles_labels()[1])
    assert "SWIFT" in str(figures[0].axes[1].get_legend_handles_labels()[1])


BAD = {
    ("--latency", "0"): "must be a number above 0; found '0'",
    ("--bandwidth", "fast"): "must be a number above 0; found 'fast'",
    ("--on", "1.5"): "must be a whole number from 1; found '1.5'",
    ("--plot", "efficiency.txt"): "it must end in .png, .svg, .pdf; found .txt",
    ("--plot", "nowhere/at/all.png"): "it must be a file in a folder that exists",
    ("--series", "blok"): "--series blok is not known. Did you mean block?",
    ("--step", "0.9", "--on", "64"): "--measured-on is missing. Give it.",
    ("--step", "0.9", "--measured-on", "2", "--on", "64", "--steps", "9"): "Give --items.",
}
FOR_A_RUN = ("--items", "1e6", "--measured-on", "2", "--on", "64", "--steps", "9", "--step")


@pytest.mark.parametrize("options", [*BAD, (*FOR_A_RUN, "1e-9")])
def test_bad_options_are_refused(file, capsys, options):
    assert quintet("scaling", file, *options) == 2
    message = BAD.get(options, "must take longer than its messages")
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("text", ["", "{}", "[]", "[1, 2]", '[{"name": "toy"}]'])
def test_another_file_is_refused(tmp_path, capsys, text):
    path = tmp_path / "other.json"
    path.write_text(text)
    assert quintet("scaling", path) == 2
    assert "it must be what quintet bench KIND --ranks 1" in capsys.readouterr().err
    assert quintet("scaling", tmp_path / "none.json") == 2


def test_a_series_on_too_few_numbers_of_ranks_is_refused(tmp_path, capsys):
    path = tmp_path / "rows.json"
    path.write_text(json.dumps([r for r in ROWS if r["ranks"] < 4]))
    assert quintet("scaling", path) == 2
    assert "on 3 numbers of ranks; there is none" in capsys.readouterr().err
    path.write_text(json.dumps([row(8000, ranks) for ranks in (2, 3, 4)]))
    assert quintet("scaling", path) == 2
    assert "one rank must be among --ranks. Add --ranks 1." in capsys.readouterr().err


def test_bench_fits_a_model_to_three_numbers_of_ranks(tmp_path, monkeypatch, capsys):
    """Its cases are not run here: they have the times of `row`."""
    sizes = {"lattice, 160": 160, "lattice, 24k": 24_000, "lattice, 100k": 100_352}
    names = list(sizes)
    monkeypatch.setattr(
        throughput,
        "run_case",
        lambda kind, number, threads, ranks: {
            **row(sizes[names[number]], ranks, "lattice"),
            "wall_rate": 1.0,
            "bytes_per_item": 1.0,
            "waits": 0.0,
        },
    )
    monkeypatch.setattr(throughput, "network_here", lambda: NETWORK)
    out, kind = tmp_path / "rows.json", "particle_lattice"
    cases = ("--case", "lattice, 160", "--case", "lattice, 24k", "--threads", 1)
    ranks = [word for p in (1, 2, 4) for word in ("--ranks", p)]
    assert quintet("bench", kind, *cases, *ranks, "--json", out) == 0
    *rows, entry = json.loads(out.read_text())
    assert [r["ranks"] for r in rows] == [1, 2, 4, 1, 2, 4]
    assert entry["case"] == "lattice" and entry["model"]["per_item"] == pytest.approx(1e-6)
    assert "particle_lattice" not in capsys.readouterr().err
    assert quintet("scaling", out) == 0  # the same from the file, its model left out
    assert quintet("bench", kind, *cases, *ranks[:4], "--json", tmp_path / "two.json") == 0
    assert len(json.loads((tmp_path / "two.json").read_text())) == 4  # no model of two
    capsys.readouterr()
    assert quintet("bench", kind, *cases, *ranks[:4], "--plot", tmp_path / "a.png") == 2
    assert "--plot needs a model of cost" in capsys.readouterr().err
    assert quintet("bench", kind, *cases, *ranks, "--series", "latice") == 2
    assert "--series latice is not known. Did you mean lattice?" in capsys.readouterr().err


def test_a_network_is_that_of_a_short_and_a_long_message():
    times = {1: 2e-6, 100_000: 2e-6 + 8e5 / 4e9}
    assert network_of(times) == pytest.approx(Network(2e-6, 4e9))


@pytest.mark.mpi
def test_latency_and_bandwidth_are_measured_between_two_ranks():
    latency, bandwidth = measure_network()
    assert 1e-8 < latency < 1e-2 and 1e7 < bandwidth < 1e12
