"""OpenCL devices, and laws printed for them: the functions that numba compiles, in OpenCL C."""
