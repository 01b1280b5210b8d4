"""Tools that examine the scheme from outside; the solver imports none of them."""
