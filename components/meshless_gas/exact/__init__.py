"""Exact solutions, for the scenes that have one."""
