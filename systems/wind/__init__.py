"""Wind: its kinds, in numpy and GLSL, and the sending of their messages to receivers."""
