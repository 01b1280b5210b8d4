"""A bar, half of finite elements and half of mass points: scene, exchanges one by one."""
