"""What judges a coupling as it runs: its start, its windows, its stability, whether it settles."""
