"""Wind: the primitives, and what carries their messages to the receivers."""
