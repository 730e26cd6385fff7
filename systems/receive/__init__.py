"""Receivers on the graphics card: what the wind tells those that are seen in a frame."""
