"""Settings of bodies of particles from safe to absurd: none is silently wrong."""

import json
from pathlib import Path

import pytest

from quintet.coupler.cli import main


@pytest.mark.full
@pytest.mark.parametrize("scene", ["flyer", "rubber_rings", "taylor_bar_sph"])
def test_no_setting_of_solid_bodies_is_silently_wrong(scene: str, tmp_path: Path) -> None:
    content = tmp_path / "scan.json"
    out = ("--out", str(tmp_path / "runs"), "--json", str(content))
    with pytest.raises(SystemExit) as end:
        main(["scan", scene, "--preset", "quick", *out])
    assert not end.value.code
    rows = [row for scan in json.loads(content.read_text())["scans"] for row in scan["rows"]]
    assert len(rows) > 10 and all(row["verdict"] != "SILENT" for row in rows), rows
