"""At its end a run reports the energy and mass that it lost, whatever else the scene asks for."""

import json
import re

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
    balance = ledger["energy_balance"]
    assert balance["times"] == 2
    assert balance["scale"] == pytest.approx(12.0 * end)
    for part in (balance["run"], balance["components"]["spring"]):
        assert (part["change"], part["lost"]) == pytest.approx((-12.0 * end, 12.0 * end))
        assert part["gained"] == 0.0
        assert part["unexplained"] is None, "it does not report what it dissipates"
    assert ledger["mass_drift"]["spring"] == pytest.approx({"kg": -end, "relative": -0.02 * end})
    screen = capfd.readouterr().out
    assert f"100 % = {12 * end:g} J" in screen
    assert re.search(rf"lost \(dissipated\) +{12 * end:g} \(100 %\)\n", screen)
    assert f"mass of spring changed by {-2 * end:g} % ({-end:g} kg)" in screen
