"""Receivers on the graphics card: the messages of the wind in a frame."""
