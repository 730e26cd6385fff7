"""Blades on their way between their own places and their painted places."""
