"""The contract between solvers and coupler; nothing here knows any solver."""
