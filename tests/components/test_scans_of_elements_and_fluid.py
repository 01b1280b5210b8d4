"""Scans of the scenes of finite elements and of the fluid: no wrong result goes unsaid."""

import json
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.slow
@pytest.mark.full
@pytest.mark.parametrize("scene", ["dam_break_front", "heated_slab", "plate_modes", "still_water"])
def test_no_row_of_a_scan_is_silent(tmp_path, scene):
    file = tmp_path / "scan.json"
    quintet = str(Path(sys.executable).parent / "quintet")
    command = [quintet, "scan", scene, "--json", str(file)]
    subprocess.run(command, cwd=tmp_path, check=False, timeout=1200)
    rows = [row for scan in json.loads(file.read_text())["scans"] for row in scan["rows"]]
    assert rows and not [row for row in rows if row["verdict"] == "SILENT"]
    assert any(row["verdict"] == "told" for row in rows)
