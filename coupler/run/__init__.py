"""One run: the window loop, output, progress, snapshots, results."""
