"""Light: the sun and the sky, what they send to the grass, and what lies between them and the ground."""
