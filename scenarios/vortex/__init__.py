"""An isentropic vortex that drifts through a periodic box."""
