"""The energy of a run, where the machine counts it."""

import pytest

from quintet.coupler.run.energy import EnergyMeter


def counter(folder, name, microjoules, size=1e9):
    (folder / name).mkdir(exist_ok=True)
    (folder / name / "energy_uj").write_text(f"{microjoules:.0f}\n")
    (folder / name / "max_energy_range_uj").write_text(f"{size:.0f}\n")


def test_the_energy_is_the_sum_of_all_packages_also_where_a_counter_starts_anew(tmp_path):
    counter(tmp_path, "intel-rapl:0", 5e6)
    counter(tmp_path, "intel-rapl:1", 999e6)
    counter(tmp_path, "intel-rapl:0:0", 1e6)  # a part of the first package
    meter = EnergyMeter(tmp_path)
    counter(tmp_path, "intel-rapl:0", 12e6)
    counter(tmp_path, "intel-rapl:1", 2e6)
    counter(tmp_path, "intel-rapl:0:0", 9e6)
    assert meter.joules() == pytest.approx(7.0 + 3.0)


def test_counters_that_start_anew_often_are_read_meanwhile(tmp_path):
    counter(tmp_path, "intel-rapl:0", 0.0, 10e6)
    meter = EnergyMeter(tmp_path, poll=3600.0)
    for microjoules in (6e6, 2e6, 8e6, 4e6):
        counter(tmp_path, "intel-rapl:0", microjoules, 10e6)
        meter._add()
    assert meter.joules() == pytest.approx(24.0)


def test_a_machine_without_counters_has_no_energy(tmp_path):
    assert EnergyMeter(tmp_path).joules() is None
    assert EnergyMeter(tmp_path / "none").joules() is None
    (tmp_path / "intel-rapl:0").mkdir()  # readable by the superuser alone
    assert EnergyMeter(tmp_path).joules() is None
