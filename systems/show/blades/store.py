"""The blades of all patch models on the graphics card, and the records of the patches that they stand on."""

from collections.abc import Generator

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.gl.emit import emitted, record_lookup
from ....engine.gl.stream import Records, release_all, released_unless_finished
from ....engine.gl.texture import by_texel
from ..strips.stock import StripStock
from .organs import organ_defines
from .plant import BladeStock
from .pool import BLADE, ORGAN

STANDING = np.dtype(
    [
        ("cell", "2f4"),
        ("model_turn", "f4"),
        ("cover", "f4"),
        ("sublevel", "f4"),
        ("morph", "f4"),
        ("growth", "f4"),
        ("along", "f4"),
        ("ring", "f4"),
        ("first_edge", "f4"),
        ("unused", "2f4"),
    ]
)
"""Record of a patch with blades: its cell; 4 * model + quarter turns; cover; number of the ring within its group of
draws, plus the slide of joints to the next ring. For a morphing patch also: the morph of its blades; the relative
height of its strips, the axis that they run along, their ring, and their first receiver. The shader reads three
texels."""

STANDING_ROW, BLADES_ROW, SLICES_ROW, TARGETS_ROW = 64, 256, 1024, 64
"""Records per row of the textures of patches, blades, the strips that blades are painted on, and painted places."""


GLSL = (
    record_lookup("Standing", STANDING, "standing", STANDING_ROW)
    + f"#ifdef ORGANS\n{record_lookup('Blade', ORGAN, 'blades', BLADES_ROW)}"
    + f"#else\n{record_lookup('Blade', BLADE, 'blades', BLADES_ROW)}#endif\n"
    + emitted({"SLICES_ROW": SLICES_ROW, "TARGETS_ROW": TARGETS_ROW})
)


class BladeStore:
    """Textures of everything about all patch models' blades that is the same in every frame."""

    def __init__(self, stock: BladeStock, blades: Records, slices: moderngl.Texture, targets: moderngl.Texture) -> None:
        self.count = stock.records.shape[1]
        self.organs = organ_defines(stock.records.dtype)
        self.blades, self.slices, self.targets = blades, slices, targets
        self.points = targets.width // TARGETS_ROW

    @property
    def defines(self) -> dict[str, str | int]:
        """Defines of the layout, for shaders that read it."""
        return {"POINTS": self.points, **self.organs}

    def release(self) -> None:
        """Give everything back."""
        release_all(self.blades, self.slices, self.targets)


def storing(ctx: moderngl.Context, stock: BladeStock, strips: StripStock, /) -> Generator[None, None, BladeStore]:
    """Return a store, whose data is sent to GL a piece at a time."""
    records, (*_, points, _) = stock.records, strips.targets.shape
    blades = Records(ctx, records.dtype, BLADES_ROW, rows=-(-records.size // BLADES_ROW))
    blades.write(records.reshape(-1))
    with released_unless_finished(blades):
        yield
        slices = _texture(ctx, strips.slices.reshape(-1, 1, 1), SLICES_ROW)
        with released_unless_finished(slices):
            yield
    return BladeStore(stock, blades, slices, _texture(ctx, strips.targets.reshape(-1, points, 2), TARGETS_ROW))


def _texture(ctx: moderngl.Context, values: NDArray[np.generic], per_row: int) -> moderngl.Texture:
    """Return a texture of records (n, texels, channels), with `per_row` records in a row."""
    count, texels, channels = values.shape
    rows = -(-count // per_row)
    padded = np.zeros((rows * per_row, texels, channels), np.float32)
    padded[:count] = values
    return by_texel(ctx.texture((per_row * texels, rows), channels, padded.tobytes(), dtype="f4"))
