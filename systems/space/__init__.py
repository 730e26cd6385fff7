"""Geometry: ground, cells, canopy, view cone and frustum; arrays in, arrays out."""
