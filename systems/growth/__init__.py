"""Growth: from a grass kind to postures, response and patch models, the finest first."""
