"""Shadows that a game casts on the prairie: shadow maps and shades."""
