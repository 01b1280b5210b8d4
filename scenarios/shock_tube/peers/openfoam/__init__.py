"""Sod's tube by rhoCentralFoam of OpenFOAM: its case and runs."""
