"""``quintet launch`` writes a job script that bash can read, and refuses impossible jobs."""

import os
import subprocess

import pytest

from quintet.coupler.cli.commands import main
from quintet.coupler.launch.slurm_job import limit_of
from quintet.interfaces.errors import SceneError

SLURM = ("--slurm", "--time", "02:00:00")


@pytest.fixture
def launch(tmp_path, monkeypatch, capsys):
    """Status, output and errors of quintet launch in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        with pytest.raises(SystemExit) as end:
            main(["launch", *arguments])
        return end.value.code, *capsys.readouterr()

    return call


def _script(tmp_path, name="dam_break_cubes.slurm"):
    subprocess.run(["bash", "-n", tmp_path / name], check=True)
    return (tmp_path / name).read_text()


def test_a_script_has_every_rank_on_its_node_with_its_threads(launch, tmp_path):
    arguments = ("dam_break_cubes", "--preset", "quick", "--nodes", "2", *SLURM)
    assert launch(*arguments, "--partition", "short", "--account", "me")[0] == 0
    text = _script(tmp_path)
    assert "#SBATCH --nodes=2 --ntasks=2 --ntasks-per-node=1\n#SBATCH --cpus-per-task=2\n" in text
    assert "#SBATCH --time=02:00:00 --signal=TERM@120\n" in text
    assert "#SBATCH --partition=short\n#SBATCH --account=me\n" in text
    assert "nodes=(1 1 0)\n" in text and "--ntasks=${#nodes[@]}" in text
    assert "    1) component cubes 1 dem_bodies ;;\n    2) component water 2 sph_fluid ;;" in text
    assert f"begin=(dam_break_cubes --preset quick --out {tmp_path}/runs/dam_break_cubes)" in text
    assert "srun --mpi=pmi2" in text and "--grace 90" in text


def test_texts_of_a_scene_cannot_break_out_of_the_script(launch, tmp_path):
    title = 'title="it\'s $(touch broken); `touch broken`"'
    assert launch("two_springs", "--set", title, *SLURM, "-o", "a b.slurm")[0] == 0
    text = _script(tmp_path, "a b.slurm")
    assert f"#SBATCH '--output={tmp_path}/a b-%j.out'\n" in text
    begin = next(line for line in text.splitlines() if line.startswith("begin="))
    result = subprocess.run(
        ["bash", "-c", begin + '; printf "%s\\n" "${begin[@]}"'], capture_output=True, text=True
    )
    assert title in result.stdout.splitlines() and not (tmp_path / "broken").exists()


@pytest.mark.parametrize(("step", "status"), [(7, 7), (1, 3), (0, 3)])
def test_the_end_of_the_job_before_is_not_taken_for_that_of_this_one(
    launch, tmp_path, step, status
):
    """A step that fails before the coupler begins has written nothing."""
    assert launch("two_springs", *SLURM)[0] == 0
    log = tmp_path / "runs/two_springs/log"
    log.mkdir(parents=True)
    (log / "mpi.json").write_text('{"status": 130}')
    programs = {"scontrol": "echo n1", "squeue": "echo RUNNING", "srun": f"exit {step}"}
    (tmp_path / "bin").mkdir()
    for name, text in programs.items():
        (tmp_path / "bin" / name).write_text(f"#!/bin/sh\n{text}\n")
        (tmp_path / "bin" / name).chmod(0o700)
    env = {**os.environ, "PATH": f"{tmp_path}/bin:{os.environ['PATH']}"}
    command = ["bash", tmp_path / "two_springs.slurm", "--resume"]
    result = subprocess.run(command, env=env, capture_output=True, text=True)
    assert result.returncode == status
    assert f"the run failed with status {status}; it is not submitted again" in result.stdout


def test_in_an_image_every_rank_runs_in_it(launch, tmp_path):
    assert launch("two_springs", *SLURM, "--image", "q.sif", "--mpi", "pmix")[0] == 0
    text = _script(tmp_path, "two_springs.slurm")
    assert f"python=(apptainer exec --writable-tmpfs {tmp_path}/q.sif python -P)" in text
    assert "--mpi=pmix" in text and "NETMOD" not in text, "which is for pmi2"


def test_a_former_run_places_by_measured_times(launch, tmp_path, capsys):
    with pytest.raises(SystemExit):
        main(["run", "two_springs", "--transport", "memory", "--set", "end=0.01", "--out", "old"])
    capsys.readouterr()
    assert launch("two_springs", *SLURM, "--measured", "old")[0] == 0
    status, _, errors = launch("two_springs", *SLURM, "--measured", "nowhere", "-o", "b")
    assert status == 2 and "it has no results.json" in errors


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "launch writes a job script for a batch system: say which"),
        (("two_springs",), "quintet launch SCENE --slurm --nodes 2 --time 02:00:00"),
        (("two_springs", "--slurm"), "Give --time, as in --time 02:00:00"),
        (("two_springs", "--slurm", "--time", "soon"), "as sbatch takes it"),
        (("two_springs", "--slurm", "--time", "1"), "--margin must be shorter than --time, 60 s"),
        (("two_springs", *SLURM, "--transport", "zenoh"), "--transport must be mpi; found zenoh"),
        (("two_springs", *SLURM, "--nodes", "9"), "--nodes must be at most"),
        (("two_springs", *SLURM, "-o", "mine"), "no job script. Name another file"),
        (("two_springs", *SLURM, "--out", "full"), "a new or an empty folder"),
    ],
)
def test_what_cannot_run_is_refused(launch, tmp_path, arguments, words):
    (tmp_path / "mine").write_text("my notes")
    (tmp_path / "full").mkdir()
    (tmp_path / "full/notes").write_text("")
    status, _, errors = launch(*arguments)
    assert status == 2 and words in errors
    assert (tmp_path / "mine").read_text() == "my notes"


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("5", 300),
        ("5:30", 330),
        ("02:00:00", 7200),
        ("1-12", 129600),
        ("1-12:30", 131400),
        ("0-0:0:7", 7),
    ],
)
def test_limits_are_read_as_sbatch_reads_them(text, seconds):
    assert limit_of(text) == seconds


@pytest.mark.parametrize("text", ["", "1:2:3:4", "-5", "1.5", "two"])
def test_other_limits_are_refused(text):
    with pytest.raises(SceneError):
        limit_of(text)
