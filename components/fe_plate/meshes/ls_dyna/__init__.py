"""Meshes in LS-DYNA keyword files, which OpenRadioss reads as well."""
