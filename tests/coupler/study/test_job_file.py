"""A run of a sweep can be done from its file, by a batch system or a workflow."""

import json
import os
import re
import subprocess
import sys

import pytest
from spring_scene import command, command_json, write

from quintet.coupler.study import slurm_executor
from quintet.coupler.study.job_file import JobFiles, cores_of, main, read_end, read_request

STEP = "components.spring.step"
OVER = ("--over", f"{STEP}=0.02,0.01")


@pytest.fixture
def scene_and_rules(tmp_path):
    """A scene, and a Snakefile of its sweep."""
    path = write(tmp_path)
    rules = ("--snakefile", tmp_path / "Snakefile", "--out", tmp_path / "all")
    assert command("sweep", path, *OVER, *rules) == 0
    return path, tmp_path / "Snakefile"


@pytest.mark.slow
def test_rules_name_runs_that_a_sweep_then_finds_complete(scene_and_rules):
    path, rules = scene_and_rules
    text = rules.read_text()
    runs = json.loads(re.search(r"^RUNS = (\{.*?\n\})", text, re.M | re.S)[1])
    assert list(runs.values()) == [f"{STEP}=0.02", f"{STEP}=0.01"]
    assert not list(path.parent.glob("all/*/results.json")), "nothing is run"
    shell = json.loads(re.search(r"threads: 1\n    shell: (.*)", text)[1])
    for run in runs:
        line = shell.replace("{wildcards.run}", run)
        result = subprocess.run(["sh", "-c", line], capture_output=True, text=True)
        assert result.returncode == 0 and f"{run}: done" in result.stdout, result.stderr
    status, report = command_json("sweep", path, *OVER)
    assert status == 0 and [row["kept"] for row in report["rows"]] == [True, True]
    assert {row["run"] for row in report["rows"]} == set(runs)


def test_a_request_is_read_as_it_was_written(scene_and_rules):
    path, _ = scene_and_rules
    place = (path.parent / "all").resolve()
    for request in place.glob("jobs/*.json"):
        job, _ = read_request(JobFiles(place, request.stem))
        assert job.name == request.stem and job.place == place
        assert job.resolved["components"]["spring"]["step"] == job.settings[STEP]
        assert job.complete() is None and cores_of(job.resolved) == 1
    assert read_end(JobFiles(place, job.name), "1") is None


def test_cores_are_those_of_all_that_compute_at_once():
    components = {"a": {"threads": 2}, "b": {"ranks": 3}}
    assert cores_of({"transport": "memory", "components": components}) == 3
    assert cores_of({"transport": "mpi", "components": components}) == 5


def test_wrong_input_is_told(scene_and_rules, capsys, monkeypatch):
    path, _rules = scene_and_rules
    foreign_file = path.parent / "mine"
    foreign_file.write_text("mine")
    assert command("sweep", path, *OVER, "--snakefile", foreign_file) == 2
    assert "it exists. Name another file." in capsys.readouterr().err
    assert foreign_file.read_text() == "mine"
    missing_path = path.parent / "none" / "Snakefile"
    assert command("sweep", path, *OVER, "--snakefile", missing_path) == 2
    assert "it must be a file in a folder; it is not" in capsys.readouterr().err
    assert command("sweep", path, *OVER, "--sbatch=--time=1") == 2
    assert "--sbatch is for --engine slurm; found --time=1 without" in capsys.readouterr().err
    monkeypatch.setenv("PATH", "")
    assert command("sweep", path, *OVER, "--engine", "slurm") == 2
    assert "--engine slurm needs the programs of SLURM; sbatch, squeue" in capsys.readouterr().err
    assert main(["one"]) == 2
    assert "needs FOLDER and HASH; found 1 arguments" in capsys.readouterr().err
    assert main([str(path.parent / "all"), "0000"]) == 2
    assert "it must be a run of a sweep; it cannot be read" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("squeue", "cause"),
    [
        ("echo Unable to contact slurm controller >&2; exit 1", "Unable to contact"),
        ("exec sleep 60", "no answer within 0 s"),
    ],
)
def test_a_batch_system_that_does_not_answer_is_told_at_once(
    tmp_path, capsys, monkeypatch, squeue, cause
):
    for program in ("sbatch", "squeue", "scancel"):
        (tmp_path / program).write_text(f"#!/bin/sh\n{squeue}\n")
        (tmp_path / program).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setattr(slurm_executor, "ANSWER", 0.2)
    assert command("sweep", write(tmp_path), *OVER, "--engine", "slurm") == 2
    message = capsys.readouterr().err
    assert (
        f"--engine slurm: squeue failed: {cause}" in message
        and "Check that the controller" in message
    )


@pytest.mark.full
def test_snakemake_plans_and_does_the_runs(scene_and_rules):
    pytest.importorskip("snakemake")
    path, rules = scene_and_rules
    line = [sys.executable, "-m", "snakemake", "--snakefile", str(rules), "--cores", "1"]
    result = subprocess.run(line, capture_output=True, text=True, cwd=path.parent)
    assert result.returncode == 0, result.stderr
    assert (path.parent / "all" / "sweep.csv").is_file()
    second_result = subprocess.run(
        [*line, "--dry-run"], capture_output=True, text=True, cwd=path.parent
    )
    assert "Nothing to be done" in second_result.stderr + second_result.stdout
