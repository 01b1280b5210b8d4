"""A ball of aluminium strikes a plate at 7400 m/s: crater and spall, as rings and as quarters."""
