"""Lamps and shades: grids over the ground that list them for shaders."""
