"""Elevation and density maps, from files and from noise."""
