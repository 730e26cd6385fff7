"""Trees and bushes: how they grow, where they stand, and how they are drawn near and far."""
