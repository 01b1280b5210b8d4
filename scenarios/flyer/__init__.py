"""A plate strikes another: shock, release and spall against the equation of state."""
