"""What every program knows of a frame: its uniform block."""
