"""The representations of the grass: how each grows, what it keeps, and how it is drawn. `registry` lists them."""
