"""Two rubber rings collide and bounce off: large elastic strains without a tear."""
