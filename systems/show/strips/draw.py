"""The programs of the 2.5D strips, and the textures that they read."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from ....engine.declared.quality import StripRing
from ....engine.gl.emit import emitted, record_lookup
from ....engine.gl.shaders import set_uniform_array
from ....engine.gl.stream import Records, release_all, released_unless_finished
from ...frame.block import filled, room_for
from .gather import ALL_BLADES, BY_RANK, EDGED, LIES_AHEAD, OF_RING, PLACEMENT, RUNS_ALONG
from .stock import StripStock
from .textures import Atlas, extent_texture, sending_strips

PLACEMENTS_ROW, STRIPS_ROW = 64, 1024
"""Records in a row of the texture of placements, and numbers in a row of the texture of polygon strips."""

READY_ROWS = 256
"""Rows reserved in both textures once a game has prepared."""

GLSL = record_lookup("Placement", PLACEMENT, "placements", PLACEMENTS_ROW) + emitted(
    {"STRIPS_ROW": STRIPS_ROW, "RUNS_ALONG": RUNS_ALONG, "LIES_AHEAD": LIES_AHEAD, "OF_RING": OF_RING}
)

Defines = dict[str, str | int]

MODES: dict[int, Defines] = {ALL_BLADES: {}, BY_RANK: {"THIN": 1}, EDGED: {"THIN": 1, "EDGED": 1}}
"""Defines of each drawing mode."""


def _in_all_modes(*variants: Defines) -> list[Defines]:
    """Return the defines of each variant of the program in each drawing mode."""
    return [{**variant, **mode} for variant in variants for mode in MODES.values()]


PROGRAMS = _in_all_modes({}, {"SHADED": 1}, {"SHADED": 1, "CUT": 1})
"""Defines of the programs that draw strips: the plain ones, those with cast shadows, and those with cut grass too."""

DEEP_PROGRAMS = _in_all_modes({"DEEP": 1, "CUT": 1})
"""Defines of the programs that write depth alone."""

FILES = "systems/show/strips/strips.vert", "systems/show/strips/strips.frag"

NUMBER = np.dtype([("number", "u4")])


class StripShelf:
    """One viewer's textures of placements and of numbers of polygon strips, with room for `rows` rows at first."""

    def __init__(self, ctx: moderngl.Context, rows: int) -> None:
        self.placements = Records(ctx, PLACEMENT, PLACEMENTS_ROW, rows=rows)
        self.strips = Records(ctx, NUMBER, STRIPS_ROW, rows=rows)
        self.sent: object = None
        """Gathered frame that was uploaded last."""
        self.numbers: object = None
        """Numbers of polygon strips uploaded last."""

    def reserve(self, rows: int) -> None:
        """Make room for `rows` rows; the contents are lost."""
        self.placements.reserve(rows)
        self.strips.reserve(rows)
        self.sent = self.numbers = None

    def release(self) -> None:
        """Release the textures."""
        release_all(self.placements, self.strips)


@dataclass(frozen=True, slots=True, eq=False)
class Uploaded:
    """The textures of a stock's strips; the atlas holds the pictures of all its forms, as `strip_atlas` makes it."""

    stock: StripStock
    rings: Sequence[StripRing]
    atlas: moderngl.TextureArray
    ranks: moderngl.TextureArray
    extents: moderngl.Texture

    @property
    def stride(self) -> int:
        """Number of polygon strips set aside for a patch: the first of patch i has number i * `stride`."""
        return self.stock.strips_per_plane * max(ring.strips * ring.columns for ring in self.rings)

    def release(self) -> None:
        """Release the textures."""
        release_all(self.atlas, self.ranks, self.extents)


def uploading(
    ctx: moderngl.Context, rings: Sequence[StripRing], stock: StripStock, atlas: Atlas, /
) -> Generator[None, None, Uploaded]:
    """Upload an atlas a piece at a time."""
    texels = yield from sending_strips(ctx, atlas.texels)
    with released_unless_finished(texels):
        ranks = yield from sending_strips(ctx, atlas.ranks)
    return Uploaded(stock, rings, texels, ranks, extent_texture(ctx, atlas.extents))


def set_stacks(program: moderngl.Program, rings: Sequence[StripRing], /) -> None:
    """Set the uniform `stacks` to each ring's number of columns, sections and strips."""
    stacks = [(ring.columns, ring.sections, ring.strips, 0) for ring in rings]
    set_uniform_array(program, "stacks", filled(stacks, room_for(len(rings))))


def set_sizes(program: moderngl.Program, stock: StripStock, /) -> None:
    """Set the uniform `sizes`, if the program has it, to the margin and the height of each form's strips [m]."""
    sizes = [(0.0, 1.0)] * (2 * stock.kinds)
    for form, strips in zip(stock.forms, stock.strips[0], strict=True):
        sizes[form.number] = strips.margin, strips.height
    set_uniform_array(program, "sizes", sizes)
