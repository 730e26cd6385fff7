"""Mowing: grass that a game cuts, sows and clears."""
