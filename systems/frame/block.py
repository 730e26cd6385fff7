"""What every program knows of a frame, in one uniform block."""

from collections.abc import Mapping, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.camera import View
from ...engine.declared.grass import MOST_KINDS
from ...engine.gl.guest import block_binding
from ...engine.gl.shaders import program
from ..grow.record import GIVES

SHADES = 8
"""How many bodies cast shadows at most."""

GROUPS = -(-MOST_KINDS // 4)
"""Vectors of four that a figure takes for each kind that there can be."""

FRAME = np.dtype(
    [
        ("clip", "16f4"),
        ("unclip", "16f4"),
        ("eye", "4f4"),
        ("sun", "4f4"),
        ("sunlight", "4f4"),
        ("skylight", "4f4"),
        ("zenith", "4f4"),
        ("horizon", "(3,4)f4"),
        ("drift", "4f4"),
        ("shades", f"({SHADES},4)f4"),
        ("shaped", f"({SHADES},4)f4"),
        ("soil", "4f4"),
        ("terrain", "4f4"),
        ("field", "4f4"),
        ("screen", "4f4"),
        ("crown", f"({GROUPS},4)f4"),
        ("leaf", f"({GROUPS},4)f4"),
        ("lying", f"({GROUPS},4)f4"),
        ("understorey", f"({GROUPS},4)f4"),
        ("undertone", f"({GROUPS},4)f4"),
        ("root", f"({MOST_KINDS},4)f4"),
        ("tip", f"({MOST_KINDS},4)f4"),
        ("through", f"({MOST_KINDS},4)f4"),
        ("grain_c", f"({MOST_KINDS},4)f4"),
        ("grain_s", f"({MOST_KINDS},4)f4"),
        ("give", f"({GROUPS * GIVES},4)f4"),
    ]
)
"""The block's fields, as `lib/frame.glsl` declares them (std140)."""


def aim(record: NDArray[np.void], view: View, size: tuple[int, int], /) -> None:
    """Write the frame's matrices, eye and picture size [pixels] into the block."""
    row = record[0]
    row["clip"] = view.clip.T.reshape(16)
    row["unclip"] = view.unclip.T.reshape(16)
    row["screen"][:2] = size[0] / 2, size[1] / 2
    row["eye"][:3] = view.eye


class FrameBlock:
    """The uniform block on the graphics card."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.defines: dict[str, str | int] = {}
        """What every program is told that is made from now on."""
        self.buffer = ctx.buffer(reserve=FRAME.itemsize, dynamic=True)
        self.binding = block_binding(ctx)

    def join(self, program: moderngl.Program) -> None:
        """Tell a program where the block is."""
        program["Frame"].binding = self.binding  # type: ignore[union-attr]

    def write(self, record: NDArray[np.void]) -> None:
        """Send the block and bind it."""
        self.buffer.write(record)
        self.buffer.bind_to_uniform_block(self.binding)

    def release(self) -> None:
        """Give the buffer back."""
        self.buffer.release()


def by_kind(values: Sequence[float], /) -> tuple[float, ...] | list[tuple[float, ...]]:
    """Return a figure per kind as a shader's `ByKind` takes it: four to a vector, and of one vector that alone."""
    padded = (*values, *[0.0] * (-len(values) % 4))
    groups = [padded[start : start + 4] for start in range(0, len(padded), 4)]
    return groups if len(groups) > 1 else groups[0]


def joined(
    ctx: moderngl.Context,
    block: FrameBlock,
    units: Mapping[str, int],
    vertex: str,
    fragment: str | None,
    defines: Mapping[str, str | int],
    *,
    varyings: tuple[str, ...] = (),
) -> moderngl.Program:
    """Return a program that knows where the block and the textures are; `units` gives each sampler its unit.

    Without a fragment shader, the outputs that `varyings` names are written into a buffer.
    """
    made = program(ctx, vertex, fragment, defines={**block.defines, **defines}, varyings=varyings)
    block.join(made)
    for name, unit in units.items():
        if name in made:
            made[name] = unit
    return made
