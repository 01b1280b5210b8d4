"""The steps of bodies of particles on OpenCL devices."""
