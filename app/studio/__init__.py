"""Drawing in commands: a take, a studio that draws it, and files for the pictures."""
