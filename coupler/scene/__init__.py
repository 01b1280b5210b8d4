"""Scenes: reading TOML, presets and overrides, tables of studies, listing."""
