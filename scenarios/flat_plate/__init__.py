"""A laminar boundary layer on a flat plate."""
