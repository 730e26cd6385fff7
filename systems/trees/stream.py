"""A grown tree in one GL context, and the streams of instances that are drawn as it is."""

from bisect import bisect_left
from collections.abc import Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.gl.stream import Records, Stream, release_all
from .bark import PACKED, PIXEL_RADII, packed, ranges_of
from .bounds import blocks_inside
from .model import Model
from .normals import Depths, Normals
from .outline import NOWHERE
from .segments import Segment, Segments
from .shells import RINGS, SHELLS
from .standing import HUNG, HUNG_LEAVES, INSTANCE, ROW_SPACING
from .twig import BLOCK, ROW, TWIG
from .wood import Parts, parts

Uniforms = Mapping[str, tuple[float, ...]]
"""Uniforms of programs, by name."""

NEAR, FAR, LEAVES, WOOD, CAST, PICTURED = "near", "far", "leaves", "wood", "cast", "pictured"
"""Ways to draw trees: twigs on cards, pictures far off, twigs leaf by leaf, and wood; far pictures into shade maps, and
twigs leaf by leaf into far pictures."""

IN_ROWS = "in rows"
"""Way to draw pictures far off where some stand for rows of trees, in a large forest."""

QUAD = 6
"""Vertices of a quad as two triangles."""

BACKS = tuple(f"back{number}" for number in range(SHELLS + RINGS))
"""Streams of far pictures from far to near, as soft edges are blended: beyond the grass, by its shells, and in rings
beyond it but for the nearest. The stream `FAR` has all pictures, from near to far."""

WOOD_LIMITS = *PIXEL_RADII[:-1:2], *PIXEL_RADII[-2:]
"""Limits between radii of a stem a pixel wide [m]. The wood of trees between two is drawn together."""

CARDS = tuple(f"{NEAR}{number}" for number in range(SHELLS + 1))
SMALL_CARDS = CARDS[:3]
"""Streams of cards so far off that triangles cost more than their area: beyond about half of the grass."""

WOODS = tuple(f"{WOOD}{number}" for number in range(len(WOOD_LIMITS) + 1 + SHELLS))
"""Streams of cards and of wood: beyond the grass, of wood by `WOOD_LIMITS`, and by shells of grass."""

SHELL_OF = {
    FAR: 0, LEAVES: SHELLS + 1,
    **{name: number if number <= SHELLS else 0 for number, name in enumerate(BACKS)},
    **{name: number for number, name in enumerate(CARDS)},
    **{name: max(number - len(WOOD_LIMITS), 0) for number, name in enumerate(WOODS)},
}  # fmt: skip
"""Shell of grass that each stream's trees stand in: 0 is beyond all grass; single leaves are in front of it."""

STREAMS = (LEAVES, *CARDS, *WOODS, FAR, *BACKS)
"""All streams of a model: at equal distance, trees of the first ones are drawn first."""

FIRST_OF = {name: number for number, name in enumerate(STREAMS)}


def _alone() -> NDArray[np.void]:
    tree = np.zeros(1, INSTANCE)
    for name in ("twig_share", "columns", "opacity", "scale", "foliage", "tint"):
        tree[name] = 1.0
    tree["turn"] = 1.0, 0.0
    return tree


ALONE = _alone()
"""A tree at the origin with all its leaves, a record of `INSTANCE`: to bake its pictures, or to draw it once."""


class GpuModel:
    """A grown tree in one GL context, and the streams of instances that are drawn as it is."""

    def __init__(self, ctx: moderngl.Context, model: Model, segments: Segments) -> None:
        self.model = model
        ranges = ranges_of(model.vertices)
        self.numbers: Uniforms = {
            "tall": (model.height,), "twigs": (len(model.twigs),),
            "picture_span": (model.middle, model.half), "aspect": (model.aspect,), "lines": (model.lines,),
            "grass_shade": model.shade,
            "column": (ROW_SPACING * model.radius,), **ranges._asdict(),
        }  # fmt: skip
        """Uniforms of the model."""
        twigs = np.concatenate([model.twigs, model.limbs])
        self.twigs = Records(ctx, TWIG, ROW, rows=-(-len(twigs) // ROW))
        self.twigs.write(twigs)
        self.vertices = ctx.buffer(packed(model.vertices, ranges))
        triangles = [faces.triangles for wood in model.wood for faces in wood]
        self.triangles = ctx.buffer(np.concatenate(triangles))
        self.first_triangle: list[int] = np.cumsum([0, *map(len, triangles)]).tolist()
        """First triangle of the faces of each of `PIXEL_RADII`: of the whole wood, then of its edges."""
        self.bare = Stream(ctx, INSTANCE)
        self.bare.write(ALONE)
        self.streams: Mapping[str, Segment] = {name: segments.segment() for name in STREAMS}
        """The trees that each stream draws."""
        self.hung = {**{name: Stream(ctx, HUNG) for name in CARDS}, LEAVES: Stream(ctx, HUNG_LEAVES)}
        """Outputs of `hang.vert` for streams of twigs."""
        self.twigs_of_leaves = 1
        """Number of twigs that an instance of `LEAVES` draws."""
        self.wood = dict.fromkeys(WOODS, Parts(0, 0))
        """Triangles that the trees of a stream of wood draw."""
        self.wood_class = dict.fromkeys(WOODS, 0)
        """Index in `PIXEL_RADII` of a stream's wood."""
        self.far: moderngl.TextureArray | None = None
        """Pictures of the model from all around, and the optical depths before what they show."""
        self.depths: moderngl.TextureArray | None = None
        self.normals = Normals()
        """Normals of its leaves."""
        self.leaf_depths = Depths()
        """Mean optical depths of the leaves of each."""
        self.outline = self.solid_outline = NOWHERE
        """Outlines of its pictures, and of what in them is dense enough to be drawn as opaque."""

    def bark(self, program: moderngl.Program) -> tuple[moderngl.Buffer | str, ...]:
        """Return the vertex buffer of its wood as content of a vertex array: the attributes that a program has."""
        names, forms = list(PACKED.names or ()), ("4u2", "4f1", "4f1", "2f2", "2u2")
        ends = [*(PACKED.fields[name][1] for name in names), PACKED.itemsize] if PACKED.fields else []
        kept = [
            form if name in program else f"{end - start}x"
            for name, form, start, end in zip(names, forms, ends, ends[1:], strict=False)
        ]
        return self.vertices, " ".join(kept), *(name for name in names if name in program)

    def show_wood(self, name: str, pixel_radius: float, foliage: float, rows: NDArray[np.void], sides: Doubles) -> None:
        """Choose the triangles that a stream of wood draws, as `parts` returns them.

        Next to the eye, those outside the picture are left out before the first and after the last one inside. `rows`
        are the stream's instances, and `sides` planes of the frustum.
        """
        self.wood_class[name] = wood_class = bisect_left(PIXEL_RADII, pixel_radius)
        wood = self.model.wood[wood_class]
        drawn = self.wood[name] = parts(wood.whole.radii, wood.edges.radii, pixel_radius, foliage)
        if wood_class == 0:
            inside = np.array([blocks_inside(blocks, rows, sides) for blocks in self.model.near_blocks])
            self.wood[name] = Parts(*np.minimum(BLOCK * inside.T, drawn[:2])[::-1].reshape(-1).tolist())

    def rehearse(self) -> None:
        """Let each stream of wood draw a triangle."""
        self.wood = dict.fromkeys(WOODS, Parts(1, 1))

    def release(self) -> None:
        """Release all GL objects."""
        release_all(self.twigs, self.vertices, self.triangles, self.bare)
        release_all(*self.hung.values(), self.far, self.depths)
