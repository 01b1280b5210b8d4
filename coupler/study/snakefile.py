"""A sweep as a Snakefile: one rule for all its runs, into the same folders as the sweep itself."""

import json
import shlex
from collections.abc import Sequence
from pathlib import Path

from quintet.coupler.files.disk import write_whole
from quintet.coupler.launch.processes import PYTHON
from quintet.coupler.scene.sweep_axes import label
from quintet.coupler.study.job_file import MODULE, cores_of, write_request
from quintet.coupler.study.sweep_run import Job
from quintet.interfaces.errors import SceneError

MARK = "# Written by quintet sweep"  # in the first line
TEXT = """{mark}: {scene}, {count} runs. snakemake --snakefile {file} --cores 2
# A run that is complete is not repeated; a run that was interrupted goes on from its snapshot.
RUNS = {runs}


rule table:
    input: expand({results}, run=RUNS)
    output: {table}
    shell: {sweep}


rule run:
    output: {results}
    wildcard_constraints: run="[0-9a-f]+"
    threads: {threads}
    shell: {command}
"""


def check_place(path: Path) -> None:
    """Refuse a file that is there and was not written by a sweep."""
    if not path.parent.is_dir() or path.is_dir():
        raise SceneError(f"--snakefile {path}: it must be a file in a folder; it is not. Make it.")
    if path.exists() and not path.read_bytes().startswith(MARK.encode()):
        raise SceneError(f"--snakefile {path}: it exists. Name another file.")


def write_snakefile(
    path: Path, scene: str, jobs: Sequence[Job], sweep_command: Sequence[str], table: str
) -> None:
    """Write the rules, and a file for each run beside the runs.

    Parameters
    ----------
    scene : str
        Its name.
    jobs : sequence of Job
        With the folder of the sweep.
    sweep_command : sequence of str
        Gathers the table once all runs are complete.
    table : str
        Name of that.
    """
    for job in jobs:
        write_request(job)
    place = jobs[0].place
    runs = {job.name: label(job.settings) for job in jobs}
    command = [*PYTHON, "-m", MODULE, str(place)]
    text = TEXT.format(
        mark=MARK,
        scene=scene,
        count=len(jobs),
        file=path.name,
        runs=json.dumps(runs, indent=4),
        results=json.dumps(f"{_plain(str(place))}/{{run}}/results.json"),
        table=json.dumps(f"{_plain(str(place))}/{table}"),
        sweep=json.dumps(_plain(shlex.join(sweep_command))),
        threads=max(cores_of(job.resolved) for job in jobs),
        command=json.dumps(f"{_plain(shlex.join(command))} {{wildcards.run}}"),
    )
    write_whole(path, text)


def _plain(text: str) -> str:
    """A text in which Snakemake finds no wildcard."""
    return text.replace("{", "{{").replace("}", "}}")
