"""The settling packing by the GRANULAR package of LAMMPS: its input and runs."""
