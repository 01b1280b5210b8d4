"""Scans of scenes with one solver: every wrong result has a warning."""

import json
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.slow
@pytest.mark.full
@pytest.mark.parametrize(
    "scene",
    [
        "couette",
        "dam_break_front",
        "heated_slab",
        "hot_bar_coupled",
        "lattice_in_motion",
        "plate_modes",
        "still_water",
        "vortex",
        "blunt_sphere --preset quick",
        "standing_wave --preset quick",
    ],
)
def test_no_row_of_a_scan_is_silent(tmp_path, scene):
    file = tmp_path / "scan.json"
    quintet = str(Path(sys.executable).parent / "quintet")
    command = [quintet, "scan", *scene.split(), "--json", str(file)]
    subprocess.run(command, cwd=tmp_path, check=False, timeout=1200)
    rows = [row for scan in json.loads(file.read_text())["scans"] for row in scan["rows"]]
    assert rows and not [row for row in rows if row["verdict"] == "SILENT"]
    assert any(row["verdict"] == "told" for row in rows)
