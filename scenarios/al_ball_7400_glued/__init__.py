"""A ball of aluminium strikes particles that are glued to finite elements, at 7400 m/s."""
