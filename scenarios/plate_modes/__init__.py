"""A cantilever of finite elements swings: scene, exact by Euler and Bernoulli."""
