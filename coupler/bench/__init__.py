"""Benchmarks: throughput of a kind, time of one exchange."""
