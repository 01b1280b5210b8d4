"""Tools that examine lines from outside; the component imports none of them."""
