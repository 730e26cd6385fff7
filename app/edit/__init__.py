"""Editing a scene while walking in it: `tallgrass walk --edit`."""
