"""The frame block: a uniform block with the numbers of a frame, which all programs share."""

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from typing import TypeVar

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.camera import View
from ...engine.declared.grass import MOST_KINDS
from ...engine.gl.emit import block, emitted
from ...engine.gl.guest import block_binding
from ...engine.gl.shaders import Texts, program, texts
from ...engine.memo import by_identity
from ..around.asked import Asked
from ..grow.record import GIVES

BODIES = 8
"""Most flying bodies that cast shadows."""

MAPS = 4
"""Most shadow maps that a game may give."""

GROUPS = -(-MOST_KINDS // 4)
"""Number of vec4 that hold one number for each of the most kinds."""

EVERYWHERE = 1e9
"""Distance beyond all ground [m]."""

BODY = np.dtype([("middle", "3f4"), ("radius", "f4"), ("axis", "3f4"), ("pressed", "f4")])
"""A body that casts a shadow: middle and radius [m], 0 for none; its axis, a unit vector, and its flatness along that:
diameter over height, minus 1, so that a ball has 0."""

MAP = np.dtype([("clip_of", "16f4"), ("bias", "f4"), ("apart", "V12")])
"""A shadow map: matrix from the world to its clip space; bias, by which places are moved towards the sun [m]."""

KIND = np.dtype(
    [
        ("root", "3f4"), ("gloss", "f4"),  # pigment at the root; gloss as declared
        ("tip", "3f4"), ("taper", "f4"),  # pigment at the tip
        ("through", "3f4"), ("bloom", "f4"),  # transmittance of leaves, relative to their albedo
        ("grain_c", "3f4"), ("apart", "f4"),  # change of pigment with the cosine of twice the face normal's azimuth
        ("grain_s", "3f4"), ("narrowed", "f4"),  # the same with the sine
        ("head", "3f4"), ("eyed", "f4"),  # a head's numbers, as `Headed`; bit mask of eyes, see below
        ("eye_pigment", "3f4"), ("pad_eye", "V4"),  # pigment of a head's eye
    ]
)  # fmt: skip
"""A kind of grass. `apart` is the contrast of light on a face's two sides; `narrowed` the part of its width that a
blade lacks at its root, below 0 if it is round; `bloom` the part of it with the pigment of tips. `eyed` is the sum of 1
if its heads have eyes of a colour of their own, and 2 if those of its replacement have."""

FRAME = np.dtype(
    [
        ("clip", "16f4"),  # world to clip space
        # Line of sight through (x, y) of the picture, each in [-1, 1]: ahead + x * across + y * up.
        ("ray_ahead", "3f4"), ("anything_sown", "f4"),  # 1 if a game has sown or cleared anything
        ("ray_across", "3f4"), ("anything_open", "f4"),  # 1 if grass is missing anywhere that is dense on the map
        ("ray_up", "3f4"), ("anything_cut", "f4"),  # 1 if any grass has been cut
        ("eye", "3f4"), ("writes_raw", "f4"),  # [m]; 1 if raw radiance is written, without the tone curve
        # Direction to the sun; factor from the scene's radiance, with `SUN` above the air, to the picture's.
        ("sun", "3f4"), ("exposure", "f4"),
        # Radiance of a thin cloud in full shade; threshold of clouds in their map, above 1 for none.
        ("cloudlight", "3f4"), ("cloud_edge", "f4"),
        # Mean radiance of the ground, which lights clouds from below; light of a star of magnitude 0 [radiance sr].
        ("groundlight", "3f4"), ("starlight", "f4"),
        ("sunlight", "3f4"), ("haze_density", "f4"),  # radiance of a white leaf in full sun; 1 / haze distance [1/m]
        ("skylight", "3f4"), ("tallest_grass", "f4"),  # under the whole sky; bound of blades' height [m]
        ("zenith", "3f4"), ("patch_side", "f4"),  # radiance overhead; [m]
        ("soil", "3f4"), ("terrain_cell", "f4"),  # pigment of bare ground; [m]
        ("horizon", "(4,4)f4"),  # radiance of horizon and haze, in the directions of `scattered`
        ("clouds_drift", "2f4"),  # drift of the clouds, in sides of their map
        ("toward_sun", "2f4"),  # azimuth of the sun as a direction (x, z)
        ("terrain_origin", "2f4"), ("terrain_size", "2f4"),  # x, z [m]
        ("lie_origin", "2f4"),  # corner of the map of the terrain's normals, x, z [m]
        ("half_screen", "2f4"),  # half the picture's size, across and up [pixels]
        ("posture_links", "f4"), ("posture_rows", "f4"), ("posture_variants", "f4"),  # of a kind's posture texture
        ("over_hosts", "f4"),  # 1 if grass is blended over the game's own ground
        ("lamplight", "f4"),  # factor like `exposure`, for lamps
        ("beside_sun", "f4"),  # 1 if anything shines beside sun and sky
        ("mesh_low", "2f4"), ("mesh_high", "2f4"),  # x, z [m]: corners of the drawn ground
        ("patches_per_metre", "f4"), ("windows_per_patch", "f4"),  # 1 / patch side [1/m]; 1 / window side [1/patch]
        ("lamps_grid", "4f4"),  # grid of lamps: corner (x, z) [m]; cells a metre; cells along a side, 0 for none
        ("shades_grid", "4f4"),  # grid of shadows of shades, with the same numbers
        # Window of the carpet's shares: the viewer's cell; half its side [cells]; share of the carpet beyond it.
        ("carpet_window", "4f4"),
        ("plots_half", "2f4"),  # half the number of plots along the terrain's sides
        ("earth_side", "f4"), ("earth_power", "f4"),  # a game's ground: period [m]; exponent to pigment
        ("haze_given", "(5,4)f4"),  # a game's haze: radiance by 1, x, z, x^2, xz of the direction; 1 if given
        ("crown", f"({GROUPS},4)f4"),  # by kind, four in a vector: height of the canopy [m]
        ("leaf", f"({GROUPS},4)f4"),  # leaf area projected sideways, over the ground's area
        ("lying", f"({GROUPS},4)f4"),  # leaf area projected from above, over that projected sideways
        ("understorey", f"({GROUPS},4)f4"),  # coverage of the ground by low leaves, relative to their most
        ("undertone", f"({GROUPS},4)f4"),  # tone of low leaves: 0 for the root, 1 for the tip
        ("steepest", f"({GROUPS},4)f4"),  # slope of the ground at which a kind ends
        ("came", f"({GROUPS},4)f4"),  # fraction of plants replaced, where a kind is becoming another
        ("thins", f"({GROUPS},4)f4"),  # loss of density per slope before that
        ("bears", f"({GROUPS},4)f4"),  # 1 if it bears heads
        # Shade maps of trees: axes across and up of the sun's two maps; from places on these to texture coordinates
        # on the near and the far one: scale [1/m] and offset; middle (x, z) [m] of the sky's map and 1 / its side.
        ("trees_across", "3f4"), ("pad_c", "V4"), ("trees_up", "3f4"), ("pad_d", "V4"),
        ("trees_near", "4f4"), ("trees_far", "4f4"), ("trees_sky", "3f4"), ("pad_e", "V4"),
        ("depth_ends", "2f4"),  # clip depth at the near and the far end
        # Displacement of a tree's crown by the mean wind (x, z) [m]; phases of its two modes of swing [turns].
        ("trees_aside", "2f4"), ("trees_tones", "2f4"), ("pad_f", "V8"),
        ("kinds", KIND, (MOST_KINDS,)),
        ("bodies", BODY, (BODIES,)),
        ("maps", MAP, (MAPS,)), ("maps_shown", "f4"), ("pad_maps", "V12"),  # number of shadow maps
        # For each four kinds, a lookup table from a message's length, 0 to 1, to the posture index.
        ("give", f"({GROUPS * GIVES},4)f4"),
    ]
)  # fmt: skip
"""Fields of the block in the layout std140; shaders use the same names."""


GLSL = emitted({"BODIES": BODIES, "EVERYWHERE": EVERYWHERE}) + block("Frame", FRAME)


@by_identity(most=16)
def rays(view: View, /) -> Doubles:
    """Return the line of sight ahead, and its changes across and up the picture, each for x, y in [-1, 1], (3, 3).

    They come from the projection's rows for x, y and w, and not from a plane of depth, which may be tilted or
    infinitely far.
    """
    rows = view.clip[[0, 1, 3], :3]
    others = rows[[1, 2, 0]]
    # Cross products, written out.
    normals = rows[:, [1, 2, 0]] * others[:, [2, 0, 1]] - rows[:, [2, 0, 1]] * others[:, [1, 2, 0]]
    ahead = normals[0] @ view.view[2, :3]
    return np.asarray(normals * (-np.sign(ahead) / np.sqrt(normals[0] @ normals[0])), np.float64)


def aim(
    record: NDArray[np.void], view: View, size: tuple[int, int], /, *, ends: tuple[float, float] = (-1.0, 1.0)
) -> None:
    """Write the frame's matrices, eye and picture size [pixels] into the block, and clip depth at both ends."""
    row = record[0]
    row["clip"] = view.clip.T.reshape(16)
    row["ray_ahead"], row["ray_across"], row["ray_up"] = rays(view)
    row["half_screen"] = size[0] / 2, size[1] / 2
    row["eye"] = view.eye
    row["depth_ends"] = ends


def confine(record: NDArray[np.void], asked: Asked, /) -> None:
    """Write the limits of ground and carpet, and whether they are blended over a game's ground.

    The terrain's fields must have been written before.
    """
    row = record[0]
    row["over_hosts"] = asked.over_hosts
    row["mesh_low"], row["mesh_high"] = -EVERYWHERE, EVERYWHERE
    if "beyond" not in asked.parts:
        row["mesh_low"], row["mesh_high"] = row["terrain_origin"], row["terrain_origin"] + row["terrain_size"]


@dataclass(slots=True)
class Given:
    """What a game has given for the frame, which decides what programs draw it."""

    casts: bool = False
    """Whether it has shadow maps or shades; programs with the define PLAIN read none."""

    earth: int = 0
    """GL name of the texture of its own ground; 0 for none."""


class FrameBlock:
    """The uniform block on the graphics card."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.defines: dict[str, str | int] = {}
        """Defines of every program that is compiled with it from now on."""
        self.record = np.zeros(1, FRAME)
        """Record uploaded last."""
        self.buffer = ctx.buffer(reserve=FRAME.itemsize, dynamic=True)
        self.binding = block_binding(ctx)
        self.given = Given()

    def with_defines(self, defines: dict[str, str | int]) -> "FrameBlock":
        """Return this same block for programs with other defines."""
        other = copy(self)
        other.defines = defines
        return other

    def texts(self, vertex: str, fragment: str, defines: Mapping[str, str | int]) -> Texts:
        """Return the sources of a program with the block's defines."""
        return texts(vertex, fragment, {**self.defines, **defines})

    def join(self, program: moderngl.Program) -> None:
        """Set a program's binding of the block."""
        program["Frame"].binding = self.binding  # type: ignore[union-attr]

    def write(self, record: NDArray[np.void]) -> None:
        """Upload a record and bind the block."""
        self.record, row = record, record[0]
        self.given.casts = bool(row["maps_shown"] or row["shades_grid"][3])
        self.buffer.write(record)
        self.buffer.bind_to_uniform_block(self.binding)

    def release(self) -> None:
        """Release the buffer."""
        self.buffer.release()


Value = TypeVar("Value")

ROOM = 8
"""Arrays in shaders have a multiple of this length, so that most scenes share their programs."""


def room_for(count: int, /) -> int:
    """Return the length of a shader's array for `count` values."""
    return -(-count // ROOM) * ROOM


def filled(values: Sequence[Value], count: int, /) -> list[Value]:
    """Pad values to the length `count` of a shader's array by repeating the last one."""
    return [*values, *[values[-1]] * (count - len(values))]


def by_kind(values: Sequence[float], /) -> tuple[float, ...] | list[tuple[float, ...]]:
    """Return a number per kind as a shader's uniform `ByKind`: one vec4, or a list of them for more than four kinds."""
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
    """Compile a program with the block's defines; bind the block, and each sampler to its unit in `units`.

    Without a fragment shader, the outputs named in `varyings` are captured into a buffer.
    """
    made = program(ctx, vertex, fragment, defines={**block.defines, **defines}, varyings=varyings)
    return wired(made, block, units)


def wired(made: moderngl.Program, block: FrameBlock, units: Mapping[str, int], /) -> moderngl.Program:
    """Bind a program's block, and each sampler to its unit in `units`; return the program."""
    block.join(made)
    for name, unit in units.items():
        if name in made:
            made[name] = unit
    return made
