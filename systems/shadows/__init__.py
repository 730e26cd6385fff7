"""Shadows that a game throws on the prairie, by its shadow maps."""
