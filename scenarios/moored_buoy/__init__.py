"""A buoy on three chains, against another program."""
