"""Pressing: what people and animals do to the grass that they go through."""
