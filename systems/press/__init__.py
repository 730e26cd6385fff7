"""Pressing: grass that people and animals tread."""
