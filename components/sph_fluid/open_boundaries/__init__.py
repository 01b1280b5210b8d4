"""Fluid that comes and goes: inflows, outflows, and tanks that repeat."""
