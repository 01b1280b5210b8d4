"""Two bars of finite elements strike each other end to end: face to face contact."""
