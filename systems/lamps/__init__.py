"""Lamps: what shines beside sun and sky."""
