"""Spheres on an OpenCL device; imported only by a scene that asks for one."""
