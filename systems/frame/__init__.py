"""What every program knows of a frame: its uniform block, its light, the maps over the terrain."""
