"""Editing a scene while one walks in it: what `tallgrass walk --edit` is made of."""
