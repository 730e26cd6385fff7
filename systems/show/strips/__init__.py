"""2.5D: vertical strips with the blades painted on them."""
