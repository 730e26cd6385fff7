"""Where things are: the ground, its cells, the grass on it, and what a view cone holds; arrays in, arrays out."""
