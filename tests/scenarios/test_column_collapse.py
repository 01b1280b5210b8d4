"""A column of spheres collapses: coarse, its run-out; in two runs, the same bits as in one."""

import pytest
from stages import is_the_end_of, run

# A few spheres behind a gate that vanishes after 0.02 s.
FEW = (
    "components.grains.bodies.0.copies.number=[2, 4, 2]",
    "components.grains.bodies.1.copies.number=[2, 4, 2]",
    "components.grains.planes.2.point=[0.0222, 0.0, 0.0]",
)


@pytest.mark.slow
def test_the_column_runs_out_between_sand_and_glass_beads(run_scene):
    expectations = run_scene("column_collapse", "--preset", "quick")["expect"]
    assert [outcome["met"] for outcome in expectations] == [True] * 4


def test_a_settled_column_collapses_in_a_second_run_with_the_bits_of_one_run(tmp_path):
    gate = "components.grains.planes.2.until"
    whole_run = run("column_collapse", tmp_path / "whole", *FEW, f"{gate}=0.02", "end=0.06")
    keeps = ("end=0.02", "output.states=[1e9]")
    first = run("column_collapse", tmp_path / "first", *FEW, f"{gate}=0.02", *keeps)
    begins = (f"{gate}=1e-12", f'begin_from="{first}"', "end=0.04")
    second = run("column_collapse", tmp_path / "again", *FEW, *begins)
    assert is_the_end_of(second, whole_run)
