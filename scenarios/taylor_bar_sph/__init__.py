"""A bar of 42CrMo4 strikes a rigid wall: its length, its foot and the strain at the axis."""
