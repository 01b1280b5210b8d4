"""Energy and mass that a run loses are told at its end, whatever else the scene asks for."""

import json

import pytest
from spring_scene import command, write

LEAKY = '''
from quintet.interfaces.component import Totals
from toy_spring import Spring


class Leaky(Spring):
    """Its potential energy falls from 100 J by 12 J/s, its mass from 50 kg by 2 %/s."""

    time = 0.0

    def step(self, dt):
        super().step(dt)
        self.time += dt

    def totals(self):
        return Totals(mass=50.0 * (1.0 - 0.02 * self.time), potential=100.0 - 12.0 * self.time)
'''


@pytest.mark.parametrize("end", [0.5, 1.0])
def test_a_run_tells_the_energy_and_mass_that_it_lost(tmp_path, capfd, end):
    path = write(tmp_path, within=1e9)
    (tmp_path / "leaky.py").write_text(LEAKY)
    text = path.read_text().replace("toy_spring:Spring", "leaky:Leaky")
    text = text[: text.index("[[expect]]")].replace("end = 1.0", f"end = {end}")
    path.write_text(text)
    assert command("run", path, "--out", tmp_path / "out") == 0
    ledger = json.loads((tmp_path / "out" / "results.json").read_text())["ledger"]
    lost = {"gained": 0.0, "lost": 12.0 * end, "turned_over": 12.0 * end, "times": 2}
    assert ledger["energy_change"] == pytest.approx(lost)
    assert ledger["mass_drift"]["spring"] == pytest.approx({"kg": -end, "relative": -0.02 * end})
    printed = capfd.readouterr().out
    assert f"Energy: rose by 0 J, lost {12 * end:g} J from start to end\n" in printed
    assert f"mass of spring changed by {-2 * end:g} % ({-end:g} kg)" in printed
