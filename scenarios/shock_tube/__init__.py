"""Sod's shock tube, and harder ones as presets."""
