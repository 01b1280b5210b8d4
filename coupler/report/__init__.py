"""Reports of runs: summary, pictures, differences, work-precision diagrams."""
