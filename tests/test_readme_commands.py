"""The commands of the README and of scenarios/README.md, pasted in order into a fresh folder."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SHELL = re.compile(r"^```sh\n(.*?)^```$", re.M | re.S)
MAIN = SHELL.findall((ROOT / "README.md").read_text())[0]
RUNNING = SHELL.findall((ROOT / "scenarios/README.md").read_text())[0]
LONGEST = 3600.0  # s for all of it; fifteen minutes on two quiet cores

# Commands that end with another status than 0, as the text beside them says.
STATUS = {
    "quintet diff runs/two_springs runs/finer": 1,  # it names the first difference
    "quintet run dam_break_cubes --preset quick --set end=0.1": 1,  # too short
    "timeout --foreground -s INT 20": 124,
    "quintet run --resume runs/heave": 1,  # so coarse a cube misses its draught
}


def commands(block: str) -> list[str]:
    """Commands of a block, each on one line."""
    lines = block.replace("\\\n", " ").splitlines()
    return [line for line in lines if line.strip() and not line.startswith("#")]


def expected(command: str) -> int:
    return next((code for head, code in STATUS.items() if command.startswith(head)), 0)


@pytest.fixture
def folder(tmp_path):
    """The files of the project as a clone has them, and nothing else."""
    clone = tmp_path / "quintet"
    names = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True
    )
    for name in filter(None, names.stdout.split("\0")):
        if (ROOT / name).exists():
            (clone / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, clone / name, follow_symlinks=False)
    return clone


def paste(folder: Path, lines: list[str], seconds: float) -> list[tuple[str, int]]:
    """Paste commands into a shell; return each with its exit status."""
    mark = "status of the command:"
    text = "".join(f"{line}\necho '{mark}' $?\n" for line in lines)
    environment = {
        k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "VIRTUAL_ENV"))
    }
    scripts = str(Path(sys.prefix) / "bin")
    path = os.pathsep.join(
        entry for entry in environment["PATH"].split(os.pathsep) if entry != scripts
    )
    shell = subprocess.run(
        ["bash"],
        input=text + "wait\n",
        cwd=folder,
        env={**environment, "PATH": path},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=seconds,
    )
    print(shell.stdout)
    statuses = [int(status) for status in re.findall(rf"^{mark} (\d+)$", shell.stdout, re.M)]
    return list(zip(lines, statuses, strict=True))


@pytest.mark.full
def test_all_commands_work_as_pasted(folder):
    (main,), running = commands(MAIN), commands(RUNNING)
    statuses = paste(folder, [main, *running], LONGEST)
    assert statuses == [(line, expected(line)) for line in (main, *running)]
    assert '"done"' in (folder / "runs/joined/results.json").read_text()  # in the background
    assert '"done"' in (folder / "runs/heave/results.json").read_text()


def test_commands_with_another_status_are_in_the_text():
    lines = commands(RUNNING)
    for head in STATUS:
        assert any(line.startswith(head) for line in lines), head
