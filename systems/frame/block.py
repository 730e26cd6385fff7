"""What every program knows of a frame, in one uniform block."""

from collections.abc import Mapping, Sequence
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
"""How many flying bodies cast shadows at most."""

MAPS = 4
"""How many shadow maps of a game's count at most."""

GROUPS = -(-MOST_KINDS // 4)
"""Vectors of four that a figure takes for each kind that there can be."""

EVERYWHERE = 1e9
"""Farther than any ground is [m]."""

BODY = np.dtype([("middle", "3f4"), ("radius", "f4"), ("axis", "3f4"), ("pressed", "f4")])
"""A body that casts a shadow: middle, radius [m], 0 where there is none; its axis, a unit vector, and how much longer
it would have to be along that to be a ball."""

MAP = np.dtype([("clip_of", "16f4"), ("bias", "f4"), ("apart", "V12")])
"""A shadow map: world to its clip space; how much nearer to the sun places are taken than they are [m]."""

KIND = np.dtype(
    [
        ("root", "3f4"), ("gloss", "f4"),  # pigment at the root; what it mirrors
        ("tip", "3f4"), ("taper", "f4"),  # pigment at the tip
        ("through", "3f4"), ("bloom", "f4"),  # light that leaves let through, of what they send back
        ("grain_c", "3f4"), ("apart", "f4"),  # change of pigment with the cosine of twice the face normal's azimuth
        ("grain_s", "3f4"), ("narrowed", "f4"),  # the same with the sine
        ("head", "3f4"), ("eyed", "f4"),  # what a head is like: `Headed`; whether it has an eye of its own
        ("eye_pigment", "3f4"), ("pad_eye", "V4"),  # that of a head's eye
    ]
)  # fmt: skip
"""A kind of grass. `apart` is how far a face's sides are lit apart, and `narrowed` how much narrower a blade is at its
root, below 0 where it is round; `bloom` is how much of it has the pigment of tips. `eyed` is 1 where what has grown has
eyes, and 2 more where what it is to be has."""

FRAME = np.dtype(
    [
        ("clip", "16f4"),  # world to clip space
        # Along the line of sight at a corner of the picture, each from -1 to 1: ahead, more across, and more up.
        ("ray_ahead", "3f4"), ("anything_sown", "f4"),  # 1 where a game has sown or cleared anything
        ("ray_across", "3f4"), ("anything_open", "f4"),  # 1 where grass is missing that is dense on the map
        ("ray_up", "3f4"), ("anything_cut", "f4"),  # 1 where any grass has been cut
        ("eye", "3f4"), ("writes_raw", "f4"),  # [m]; 1 where raw radiance is written
        # Direction to the sun; radiance in the picture, of that of the scene, where the sun before the air sends `SUN`.
        ("sun", "3f4"), ("exposure", "f4"),
        # Radiance of a cloud's underside in full shade; where clouds begin on their map, above 1 for none.
        ("cloudlight", "3f4"), ("cloud_edge", "f4"),
        ("sunlight", "3f4"), ("haze_density", "f4"),  # radiance of a white leaf in full sun; 1 / haze distance [1/m]
        ("skylight", "3f4"), ("tallest_grass", "f4"),  # that under the whole sky; height that no blade comes to [m]
        ("zenith", "3f4"), ("patch_side", "f4"),  # radiance overhead; [m]
        ("soil", "3f4"), ("terrain_cell", "f4"),  # pigment of bare ground; [m]
        ("horizon", "(4,4)f4"),  # radiance of horizon and haze, by the ways in which `scattered` has it
        ("clouds_drift", "2f4"),  # where the clouds have drifted to, in their own sides
        ("toward_sun", "2f4"),  # the sun's azimuth, as a direction (x, z)
        ("terrain_origin", "2f4"), ("terrain_size", "2f4"),  # x, z [m]
        ("lie_origin", "2f4"),  # where the map of how it lies begins, x, z [m]
        ("half_screen", "2f4"),  # pixels from the middle to the edge, across and up
        ("posture_links", "f4"), ("posture_rows", "f4"), ("posture_variants", "f4"),  # the last of each kind
        ("over_hosts", "f4"),  # 1 where grass is laid over ground that is the game's own
        ("lamplight", "f4"),  # as `exposure`, of what lamps send
        ("beside_sun", "f4"),  # 1 where anything shines beside sun and sky
        ("mesh_low", "2f4"), ("mesh_high", "2f4"),  # x, z [m]: no ground is drawn beyond
        ("patches_a_metre", "f4"), ("windows_a_patch", "f4"),  # inverse of a patch's side, of the carpet's window
        ("lamps_grid", "4f4"),  # cells that lamps shine on: corner (x, z) [m]; cells a metre; along a side, 0 for none
        ("shades_grid", "4f4"),  # the same, of cells that lie in the shadow of shades
        # Where the carpet's shares are told: the viewer's cell; half the window's side; how much it shows beyond that.
        ("carpet_window", "4f4"),
        ("plots_half", "2f4"),  # plots of the terrain that there may be, from its middle to its edges
        ("earth_side", "f4"), ("earth_power", "f4"),  # how often a game's ground comes again [m]; its texels' pigment
        ("haze_given", "(5,4)f4"),  # a game's own, radiance by 1, x, z, x^2, xz of the direction; 1 where there is one
        ("crown", f"({GROUPS},4)f4"),  # by kind, four in each: height of the canopy [m]
        ("leaf", f"({GROUPS},4)f4"),  # leaf area seen from the side, of the ground's area
        ("lying", f"({GROUPS},4)f4"),  # leaf area seen from above, of that from the side
        ("understorey", f"({GROUPS},4)f4"),  # how much of the ground low leaves cover, of what they cover at most
        ("undertone", f"({GROUPS},4)f4"),  # how much of the colour of tips low leaves have
        ("steepest", f"({GROUPS},4)f4"),  # how fast the ground rises where a kind ends
        ("came", f"({GROUPS},4)f4"),  # how many of its plants have become what it is to be, where it is to be another
        ("thins", f"({GROUPS},4)f4"),  # how much it thins out by such a rise
        ("bears", f"({GROUPS},4)f4"),  # 1 where it bears heads
        # The maps of what trees leave of the light: which way they go across and up; how much of those of the sun a
        # metre is; their middles, near by and far off; middle of that of the sky, and how much of it a metre is.
        ("trees_across", "3f4"), ("pad_c", "V4"), ("trees_up", "3f4"), ("pad_d", "V4"),
        ("trees_middle", "4f4"), ("trees_sky", "3f4"), ("pad_e", "V4"), ("trees_spans", "2f4"),
        ("depth_ends", "2f4"),  # of clip space: how deep its near and its far end is
        # How far the mean wind blows the crown of a tree aside (x, z) [m]; where its two tones are, in turns.
        ("trees_aside", "2f4"), ("trees_tones", "2f4"),
        ("kinds", KIND, (MOST_KINDS,)),
        ("bodies", BODY, (BODIES,)),
        ("maps", MAP, (MAPS,)), ("maps_shown", "f4"), ("pad_maps", "V12"),  # how many of them there are
        # By four kinds, by length of a message, evenly from 0 to 1: posture index that it bends the kinds to.
        ("give", f"({GROUPS * GIVES},4)f4"),
    ]
)  # fmt: skip
"""The block's fields, as std140 lays them out; shaders have them by the same names."""


GLSL = emitted({"BODIES": BODIES, "EVERYWHERE": EVERYWHERE}) + block("Frame", FRAME)


@by_identity(most=16)
def rays(view: View, /) -> Doubles:
    """Return the line of sight ahead, and what is added to it across and up the picture, each from -1 to 1: (3, 3).

    They come from the rows of the projection that say where on the picture a place is, and not from any plane of depth:
    it may be tilted, or infinitely far.
    """
    one = view.clip[[0, 1, 3], :3]
    other = one[[1, 2, 0]]
    made = one[:, [1, 2, 0]] * other[:, [2, 0, 1]] - one[:, [2, 0, 1]] * other[:, [1, 2, 0]]
    ahead = made[0] @ view.view[2, :3]
    return np.asarray(made * (-np.sign(ahead) / np.sqrt(made[0] @ made[0])), np.float64)


def aim(
    record: NDArray[np.void], view: View, size: tuple[int, int], /, *, ends: tuple[float, float] = (-1.0, 1.0)
) -> None:
    """Write the frame's matrices, eye and picture size [pixels] into the block, and depth at its near and far end."""
    row = record[0]
    row["clip"] = view.clip.T.reshape(16)
    row["ray_ahead"], row["ray_across"], row["ray_up"] = rays(view)
    row["half_screen"] = size[0] / 2, size[1] / 2
    row["eye"] = view.eye
    row["depth_ends"] = ends


def confine(record: NDArray[np.void], asked: Asked, /) -> None:
    """Write how far ground and carpet go, and what they are laid over, once the terrain is written."""
    row = record[0]
    row["over_hosts"] = asked.over_hosts
    row["mesh_low"], row["mesh_high"] = -EVERYWHERE, EVERYWHERE
    if "beyond" not in asked.parts:
        row["mesh_low"], row["mesh_high"] = row["terrain_origin"], row["terrain_origin"] + row["terrain_size"]


class FrameBlock:
    """The uniform block on the graphics card."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.defines: dict[str, str | int] = {}
        """What every program is told that is made from now on."""
        self.record = np.zeros(1, FRAME)
        """What it says by now."""
        self.buffer = ctx.buffer(reserve=FRAME.itemsize, dynamic=True)
        self.binding = block_binding(ctx)
        self.casts = False
        """Whether a game has shadow maps or shades: programs that are told PLAIN ask for none."""
        self.earth = 0
        """The texture of a game's own ground, by its number in GL; 0 for none."""

    def texts(self, vertex: str, fragment: str, defines: Mapping[str, str | int]) -> Texts:
        """Return what a driver is given of a program that knows the block."""
        return texts(vertex, fragment, {**self.defines, **defines})

    def join(self, program: moderngl.Program) -> None:
        """Tell a program where the block is."""
        program["Frame"].binding = self.binding  # type: ignore[union-attr]

    def write(self, record: NDArray[np.void]) -> None:
        """Send the block and bind it."""
        self.record, row = record, record[0]
        self.casts = bool(row["maps_shown"] or row["shades_grid"][3])
        self.buffer.write(record)
        self.buffer.bind_to_uniform_block(self.binding)

    def release(self) -> None:
        """Give the buffer back."""
        self.buffer.release()


Told = TypeVar("Told")

ROOM = 8
"""Arrays in shaders have room for a multiple of so many: programs are the same then for most scenes."""


def room_for(count: int, /) -> int:
    """Return how many of something shaders have room for."""
    return -(-count // ROOM) * ROOM


def filled(values: Sequence[Told], count: int, /) -> list[Told]:
    """Return what an array of a shader is told, which has room for `count`."""
    return [*values, *[values[-1]] * (count - len(values))]


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
    return wired(made, block, units)


def wired(made: moderngl.Program, block: FrameBlock, units: Mapping[str, int], /) -> moderngl.Program:
    """Tell a program where the block and the textures are, and return it; `units` gives each sampler its unit."""
    block.join(made)
    for name, unit in units.items():
        if name in made:
            made[name] = unit
    return made
