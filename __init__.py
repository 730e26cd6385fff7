"""Tallgrass grows, animates and draws whole prairies in real time."""

__version__ = "0.1.0"
