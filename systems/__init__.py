"""The systems of a prairie: growth, tiling, culling, levels of detail, wind and drawing."""
