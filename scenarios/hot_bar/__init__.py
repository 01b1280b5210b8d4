"""A bar of mass points is heated by a driven pair: scene, edges of finite elements, comparison."""
