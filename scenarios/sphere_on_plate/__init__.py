"""A steel sphere strikes a thin plate of finite elements: Hertz's contact and bending waves."""
