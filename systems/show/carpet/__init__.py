"""2D: a textured carpet on the terrain, and the ground under it."""
