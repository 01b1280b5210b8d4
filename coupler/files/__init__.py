"""Files that a run leaves: recording, VTKHDF, TOML."""
