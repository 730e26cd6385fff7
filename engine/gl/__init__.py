"""Everything that touches GL: context, guest guard, shaders, buffers."""
