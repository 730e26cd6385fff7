"""What every program knows of a frame, in one uniform block."""

from collections.abc import Mapping, Sequence
from math import cos, dist, hypot, radians, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.shade import Shade
from ...engine.camera import View
from ...engine.declared.grass import MOST_KINDS, GrassKind
from ...engine.declared.light import Light
from ...engine.declared.scene import Scene
from ...engine.gl.shaders import program
from ...engine.terrain.record import Terrain
from ..around.canopy import canopy_height
from ..grow.record import GIVES, Growth
from ..grow.section import SECTIONS
from ..light.daylight import Daylight, daylight
from ..light.materials import apart, bloom, grain, leaves_of, let_through, pigment, understorey, undertone
from ..light.sun import sun_at

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


def frame_record(
    scene: Scene, growths: list[Growth], terrain: Terrain, patch: float, /, *, raw: bool = False
) -> NDArray[np.void]:
    """Return the block with all that holds for the whole scene, shape (1,); `aim` and `cast` fill in the rest.

    With `raw`, linear radiance is written in place of display colours.
    """
    record = np.zeros(1, FRAME)
    row = record[0]
    row["sun"][3], row["soil"][3] = raw, patch
    shine(record, scene.light, daylight(scene.light), list(scene.grass.values()))
    postures = growths[0].postures.shape
    row["terrain"] = (*terrain.origin, terrain.cell, postures.shape[2] - 1)
    row["field"] = (*terrain.size, postures.shape[1], postures.shape[0])
    crown, leaf, lying = (row[name].reshape(-1) for name in ("crown", "leaf", "lying"))
    low, tipped = (row[name].reshape(-1) for name in ("understorey", "undertone"))
    give = row["give"].reshape(GROUPS, GIVES, 4)
    for index, (kind, growth) in enumerate(zip(scene.grass.values(), growths, strict=True)):
        _write_kind(row, index, kind)
        leaves = leaves_of(kind, growth, patch)
        crown[index], leaf[index] = canopy_height(growth), leaves.side
        lying[index] = leaves.above / leaves.side
        low[index] = understorey(kind, crown[index])
        row["through"][index, 3] = bloom(kind, growth)
        tipped[index] = undertone(kind, row["through"][index, 3])
        give[index // 4, :, index % 4] = growth.postures.give
    return record


def shine(record: NDArray[np.void], declared: Light, light: Daylight, kinds: Sequence[GrassKind], /) -> None:
    """Write the light that is `declared`, and what it does to the kinds of grass."""
    row = record[0]
    row["sun"][:3] = light.direction
    row["sunlight"] = (*light.sun, declared.clouds)
    row["skylight"] = (*light.down, 1.0 / declared.haze)
    row["zenith"][:3] = light.sky.map[-1].mean(axis=0)
    row["horizon"][:, :3] = light.sky.horizon
    row["drift"][2:] = toward_sun(declared)
    row["soil"][:3] = pigment(declared.ground)
    for index, kind in enumerate(kinds):
        row["grain_c"][index, :3], row["grain_s"][index, :3] = grain(kind, light)
        row["grain_c"][index, 3] = apart(kind, light)


def toward_sun(light: Light, /) -> tuple[float, float]:
    """Return the direction over the ground that the sun stands in (x, z)."""
    azimuth = radians(sun_at(light)[0])
    return sin(azimuth), -cos(azimuth)


def _write_kind(row: np.void, index: int, kind: GrassKind) -> None:
    row["root"][index] = (*pigment(kind.root), kind.gloss)
    row["tip"][index] = (*pigment(kind.tip), kind.taper)
    row["through"][index, :3] = let_through(kind)
    section = SECTIONS[kind.profile]
    row["grain_s"][index, 3] = -1.0 if section.is_round else 1.0 - section.waist


def nearest(shades: Sequence[Shade], eye: tuple[float, float, float], /) -> list[Shade]:
    """Return the shades that count, nearest to the eye first: at most `SHADES`."""
    return sorted(shades, key=lambda shade: dist(shade.place, eye))[:SHADES]


def cast(record: NDArray[np.void], shades: Sequence[Shade], drift: tuple[float, float], /) -> None:
    """Write what casts shadows, at most `SHADES`, and how far the clouds have drifted, in sides."""
    row = record[0]
    row["shades"] = 0.0
    for into, shaped, shade in zip(row["shades"], row["shaped"], shades, strict=False):
        into[:] = (*shade.place, shade.radius)
        length, high = hypot(*shade.up), 2.0 * shade.radius if shade.height is None else shade.height
        shaped[:3], shaped[3] = np.divide(shade.up, length), 2.0 * shade.radius / high - 1.0
    row["drift"][:2] = drift


def aim(record: NDArray[np.void], view: View, size: tuple[int, int], /) -> None:
    """Write the frame's matrices, eye and picture size [pixels] into the block."""
    row = record[0]
    row["clip"] = view.clip.T.reshape(16)
    row["unclip"] = view.unclip.T.reshape(16)
    row["screen"][:2] = size[0] / 2, size[1] / 2
    row["eye"][:3] = view.eye


def frame_binding(ctx: moderngl.Context) -> int:
    """Return the binding point of the block: the highest, away from a host's own."""
    return int(ctx.info["GL_MAX_UNIFORM_BUFFER_BINDINGS"]) - 1


class FrameBlock:
    """The uniform block on the graphics card."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.defines: dict[str, str | int] = {}
        """What every program is told that is made from now on."""
        self.buffer = ctx.buffer(reserve=FRAME.itemsize, dynamic=True)
        self.binding = frame_binding(ctx)

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
