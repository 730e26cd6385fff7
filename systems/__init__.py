"""What happens: growth, tiling, culling, levels of detail, wind and drawing."""
