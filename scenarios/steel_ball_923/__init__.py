"""A steel ball strikes a steel plate at 923 m/s: what velocity is left behind the plate."""
