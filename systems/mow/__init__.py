"""Mowing: how high a game lets grass stand, place by place."""
