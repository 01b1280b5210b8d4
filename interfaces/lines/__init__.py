"""Lines between a component and the coupler: messages over memory, zenoh or MPI."""
