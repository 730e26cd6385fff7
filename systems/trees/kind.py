"""A kind of tree in one GL context: its twig's card, and its models with their pictures from all sides."""

from collections.abc import Mapping
from typing import NamedTuple

import moderngl
import numpy as np

from ...components.arrays import Bytes, Doubles, Mask
from ...engine.declared.tree import TreeKind
from ...engine.gl.mipmaps import mipmapped
from ...engine.gl.shaders import PackedUniforms, pack, pack_array, set_packed, set_used_uniforms
from ...engine.gl.stream import release_all
from ..light.materials import pigment
from . import parameter
from .bake import (
    CARD,
    card_matrix,
    card_texels,
    coverage,
    equalised,
    mip_levels,
    pictures,
    texture_of,
    tree_levels,
    view_matrix,
)
from .far import COLUMNS, ROWS
from .habit import HABITS, NEEDLES, Leaf
from .kept import keep_pictures, kept_pictures, kind_key
from .model import models_of
from .noise import bark_noise
from .normals import Normals, card_normals, pictured, tree_normals
from .outline import (
    BOX,
    CLOSE_MARGIN,
    FAINTEST,
    FULL,
    MARGIN,
    TRIANGLE,
    card_outline,
    corner_list,
    covered_at,
    picture_outline,
    solid_above,
    solid_outline,
)
from .programs import Programs
from .segments import Segments
from .stream import LEAVES, PICTURED, WOOD, GpuModel, Uniforms
from .twig import BEHIND, FINER_EACH, HANGING_OFF, SHOOTS_OFF, card_reach
from .twig import PICTURES as OF_TWIGS
from .wood import CLOSED, SOLID

DARKER = 0.62
"""Pigment of a kind's darkest leaves, relative to its brightest, where a scene gives one colour for both."""


class Binding(NamedTuple):
    """A texture and its unit."""

    texture: moderngl.Texture | moderngl.TextureArray
    unit: int


class GpuKind:
    """What a kind of tree is drawn with."""

    def __init__(
        self, ctx: moderngl.Context, units: Mapping[str, int], segments: Segments, declared: TreeKind, *, seed: int
    ) -> None:
        self.ctx, self.units, self.declared = ctx, units, declared
        self.habit = HABITS[declared.habit]
        self._seed = seed
        self.models = [GpuModel(ctx, each, segments) for each in models_of(declared.habit, seed)]
        self.card: moderngl.TextureArray | None = None
        self.outline = self.solid_outline = corner_list(BOX)
        """Outlines of its card, and of the part dense enough to be drawn as opaque."""
        self.triangle = self.solid_triangle = self.outline
        """Triangles about these: a third larger, and half as many to draw."""
        self.solid, self._behind = SOLID, BEHIND * self.habit.twigs.length
        """Coverage from which on its card is drawn as opaque; depth behind its soft edges that is clear of leaves
        [m]."""
        self._normals = Normals()
        self._picture_cover: tuple[float, ...] = (1.0,) * OF_TWIGS
        """Coverage of its card on each of its pictures, relative to that on the first."""
        self.bark = mipmapped(ctx, bark_noise())
        self.bark.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
        self.reach = card_reach(self.habit)
        self._uniforms = self._kind_uniforms()
        self._vectors = {id(each): parameter.vectors({**self._uniforms, **each.numbers}) for each in self.models}

    def bake(self, programs: Programs) -> None:
        """Bake its twig's card, and then its models' pictures from all sides, unless they are cached."""
        key = kind_key(self.declared.habit, self._seed, self.ctx.info["GL_RENDERER"])
        found = kept_pictures(key)
        if found is None:
            found = [self._twig_pictures(programs)]
            for model in self.models:
                found += self._model_pictures(programs, model)
            keep_pictures(key, found)
        self._load_card(found[0])
        for model, seen, depths in zip(self.models, found[1::2], found[2::2], strict=True):
            model.far, model.depths = texture_of(self.ctx, seen), texture_of(self.ctx, depths)
            turn = self.habit.leaf.form == NEEDLES
            model.normals, model.leaf_depths = tree_normals(model.model.twigs, self._normals, turn=turn)
            cover = coverage(seen[0], model.model.wide, model.model.lines)
            model.outline = picture_outline(cover)
            model.solid_outline = solid_outline(cover, FULL * CLOSED, model.outline)

    def _load_card(self, twig: list[Bytes]) -> None:
        """Make the card's texture, outlines and normals from its twig's pictures."""
        release_all(self.card)
        shown = [each[::2, ..., 3].max(axis=0) for each in twig]
        self.solid = solid_above(twig[1][0, ..., 3])  # the largest level of such cards on screen, about
        self.card = texture_of(self.ctx, [equalised(card_texels(each), FULL * self.solid) for each in twig])
        solid = covered_at(shown, FULL * self.solid)
        self.outline, self.triangle = _outlines(shown[0] > FAINTEST, MARGIN)
        self.solid_outline, self.solid_triangle = _outlines(solid, CLOSE_MARGIN) if solid.any() else ([], [])
        self._normals = card_normals(twig[0][:2])
        cover = twig[0][::2, ..., 3].mean(axis=(1, 2))
        self._picture_cover = tuple((cover / (cover[0] or 1.0)).tolist())

    def _twig_pictures(self, programs: Programs) -> list[Bytes]:
        """Return the pictures of its twig, each with more and smaller leaves; the depth test is on meanwhile."""
        each = [self._twig_picture(programs, FINER_EACH**number) for number in range(OF_TWIGS)]
        return [np.concatenate(layers) for layers in zip(*each, strict=True)]

    def _twig_picture(self, programs: Programs, finer: float) -> list[Bytes]:
        """Return its twig's picture with leaves `finer` times as small, and more of them to cover as much."""
        twig = programs.array(LEAVES, self.models[0].bare, baked=True)
        matrix, leaf = card_matrix(self.reach, self.habit.twigs.length), self.habit.leaf.finer(finer)
        off = SHOOTS_OFF if self.habit.leaf.shoots > 1 else HANGING_OFF
        numbers = {**_leaf_uniforms(leaf, self.habit.twigs.length), "finer": (finer,), "shoots_off": (off,)}

        def draw_twig(_: int) -> None:
            self.set_uniforms(twig.program, self.models[0], numbers)
            _set_matrix(twig.program, matrix)
            twig.render(moderngl.TRIANGLES, vertices=TRIANGLE * leaf.quads, instances=1)

        return mip_levels(pictures(self.ctx, 1, 1, CARD, CARD, draw_twig))

    def _model_pictures(self, programs: Programs, model: GpuModel) -> tuple[list[Bytes], list[Bytes]]:
        """Return a model's pictures from all sides, and the optical depths before what they show."""
        wood, twigs = (programs.array(sort, model.bare, model, baked=True) for sort in (WOOD, PICTURED))
        triangles, leaves = len(model.model.wood[0].whole.triangles), self.habit.leaf.quads

        def draw_tree(number: int) -> None:
            matrix = view_matrix(number, model.model.middle, model.model.half, model.model.aspect)
            for array, count, instances in (
                (wood, triangles, 1),
                (twigs, leaves, len(model.model.twigs)),
            ):
                self.set_uniforms(array.program, model, {}, noise=array is wood)
                _set_matrix(array.program, matrix)
                array.render(moderngl.TRIANGLES, vertices=TRIANGLE * count, instances=instances)

        return tree_levels(pictures(self.ctx, COLUMNS, ROWS, model.model.wide, model.model.lines, draw_tree))

    def _kind_uniforms(self) -> Uniforms:
        """Return the uniforms of the kind, whichever of its models is drawn."""
        habit, declared = self.habit, self.declared
        leaf, twig_length = habit.leaf, habit.twigs.length
        dark, bright = habit.leaves if declared.leaf is None else (declared.leaf, declared.leaf)
        young, old = (tuple(pigment(declared.bark or each).tolist()) for each in habit.bark)
        darker, (begins, ends) = DARKER if declared.leaf is not None else 1.0, habit.ripens
        return {
            "twig_length": (twig_length,), "leaf_length": (leaf.length,), "card": (*self.reach, 0.0),
            "form": (leaf.form,), **_leaf_uniforms(leaf, twig_length), "finer": (1.0,), "shoots_off": (SHOOTS_OFF,),
            "dark": tuple((darker * pigment(dark)).tolist()), "bright": tuple(pigment(bright).tolist()),
            "young_bark": young, "bark": old, "ripens": (begins, 1.0 / (ends - begins)), "rough": (habit.rough,),
        }  # fmt: skip

    def set_uniforms(self, program: moderngl.Program, model: GpuModel, *numbers: Uniforms, noise: bool = False) -> None:
        """Set a program's uniforms of the kind, a model and others, and bind its textures."""
        set_packed(self.uniforms(program, model))
        set_used_uniforms(program, *numbers)
        for texture, unit in self.textures(program, model, noise=noise):
            texture.use(unit)

    def uniforms(self, program: moderngl.Program, model: GpuModel) -> PackedUniforms:
        """Return a program's uniforms of the kind and a model."""
        key = id(model)
        if key not in program.extra:  # the entry keeps the model alive, so its id is not reused
            uniforms = pack(program, self._uniforms, model.numbers)
            normals = model.normals if "tree_far" in set_used_uniforms(program) else self._normals
            own = {
                "picture_cover": self._picture_cover,
                "behind": (self._behind,),
                "pictured_normal": pictured(normals),
            }
            uniforms += pack(program, own)
            uniforms += pack_array(program, parameter.NAME, self._vectors[key]) + pack_array(
                program, "leaf_normals", normals
            )
            uniforms += pack_array(program, "leaf_depths", model.leaf_depths)
            program.extra[key] = model, uniforms
        found: PackedUniforms = program.extra[key][1]
        return found

    def textures(self, program: moderngl.Program, model: GpuModel, *, noise: bool = False) -> list[Binding]:
        """Return the textures that a program reads of the kind and a model; `noise` stands in place of cards."""
        cards = self.bark if noise else self.card
        textures = {
            "tree_twigs": model.twigs.texture,
            "tree_far": model.far,
            "tree_depths": model.depths,
            "tree_cards": cards,
        }
        used = set_used_uniforms(program)
        return [
            Binding(texture, self.units[name])
            for name, texture in textures.items() if texture is not None and name in used
        ]  # fmt: skip

    def release(self) -> None:
        """Release all GL objects."""
        release_all(*self.models, self.bark, self.card)


def _outlines(covered: Mask, margin: int) -> list[list[tuple[float, float]]]:
    """Return the outline of a card, and the triangle about it."""
    return [corner_list(card_outline(covered, margin, corners=corners)) for corners in (len(BOX), TRIANGLE)]


def _leaf_uniforms(leaf: Leaf, twig_length: float) -> Uniforms:
    """Return the uniforms of a twig's leaves; `twig_length` is the usual length of a twig [m]."""
    shape = leaf.length / twig_length, 0.5 * leaf.width / twig_length, leaf.angle
    return {"leaf_count": (leaf.count,), "shoots": (leaf.shoots,), "leaf_shape": shape}


def _set_matrix(program: moderngl.Program, matrix: Doubles) -> None:
    program["baked"].write(np.ascontiguousarray(matrix.T, np.float32))  # type: ignore[union-attr]
