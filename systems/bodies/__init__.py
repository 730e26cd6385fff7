"""What flies over the prairie: how it flies, and how it is drawn."""
