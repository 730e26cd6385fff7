"""A kind of tree as one GL context holds it: its twig's card, and its models with their pictures from all around."""

from collections.abc import Mapping
from typing import NamedTuple

import moderngl
import numpy as np

from ...components.arrays import Bytes, Doubles
from ...engine.declared.tree import TreeKind
from ...engine.gl.mipmaps import mipmapped
from ...engine.gl.shaders import PackedUniforms, pack, pack_array, set_packed, set_used_uniforms
from ...engine.gl.stream import release_all
from ..light.materials import pigment
from . import told as told_of
from .bake import CARD, covers, evened, filtered, from_around, of_tree, on_card, on_cards, pictures, smaller
from .card import LEAVES, PICTURED, QUAD, WOOD, ModelOnCard, Numbers
from .far import COLUMNS, ROWS
from .habit import HABITS, NEEDLES, Leaf
from .kept import keep_pictures, kept_pictures, kind_key
from .lies import Lies, lies_of, lies_on
from .model import models_of
from .noise import bark_noise
from .outline import BOX, CLOSE, FAINTEST, ONE, around, core, covered_at, outline, pairs, solid_above
from .programs import Programs
from .twig import BEHIND, FINER_EACH, HANGING_OFF, SHOOTS_LONG, SHOOTS_OFF
from .twig import PICTURES as OF_TWIGS
from .wood import CLOSED, SOLID

ASIDE, TURNED, BACK, ON = 0.95, 0.25, 0.3, 1.2
"""How far leaves reach from their twig, of their length: aside, by the sine of their angle and so much more, as that
differs; back from its foot, and on from its tip."""

SHOOTS_ASIDE, HANGING_ASIDE = 0.7, 0.35
"""How far side shoots reach aside, of the length of the longest; and shoots that hang side by side."""

DARKER = 0.62
"""Pigment of a kind's darkest leaves, of its brightest, where a scene has one colour for both."""


class Read(NamedTuple):
    """A texture that is read, and its unit."""

    texture: moderngl.Texture | moderngl.TextureArray
    unit: int


class KindOnCard:
    """What is drawn of a kind of tree."""

    def __init__(self, ctx: moderngl.Context, units: Mapping[str, int], declared: TreeKind, *, seed: int) -> None:
        self.ctx, self.units, self.declared = ctx, units, declared
        self.habit = HABITS[declared.habit]
        self._seed = seed
        self.models = [ModelOnCard(ctx, each) for each in models_of(declared.habit, seed)]
        self.card: moderngl.TextureArray | None = None
        self.outline = self.core = pairs(BOX)
        """Corners about what its card shows, and about what it covers so that it is drawn as solid."""
        self.solid, self._behind = SOLID, BEHIND * self.habit.twigs.length
        """Coverage from which on it is so; how far behind its soft edges there is nothing [m]."""
        self._lies = Lies()
        self._hides: tuple[float, ...] = (1.0,) * OF_TWIGS
        """How much its card covers on each of its pictures, of what it does on the first."""
        self.bark = mipmapped(ctx, bark_noise())
        self.bark.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
        leaf, usual = self.habit.leaf, self.habit.twigs.length
        wide = ASIDE * leaf.length * (np.sin(leaf.angle) + TURNED)
        wide += SHOOTS_LONG * usual * (SHOOTS_ASIDE if leaf.shoots > 1 else HANGING_ASIDE)
        self.reach = wide / usual, -BACK * leaf.length / usual, 1.0 + ON * leaf.length / usual
        self._numbers = self._told()
        self._told_of = {id(each): told_of.vectors({**self._numbers, **each.numbers}) for each in self.models}

    def bake(self, programs: Programs) -> None:
        """Draw its twig, and then its models from all around, unless that was done in a run before."""
        key = kind_key(self.declared.habit, self._seed, self.ctx.info["GL_RENDERER"])
        found = kept_pictures(key, [(model.model.wide, model.model.lines) for model in self.models])
        if found is None:
            found = [self._twig_pictures(programs)]
            for model in self.models:
                self._use(found[0])
                found += self._model_pictures(programs, model)
            keep_pictures(key, found)
        self._use(found[0])
        for model, shows, met in zip(self.models, found[1::2], found[2::2], strict=True):
            model.far, model.met = filtered(self.ctx, shows), filtered(self.ctx, met)
            model.lies = lies_on(model.model.twigs, self._lies, turn=self.habit.leaf.form == NEEDLES)
            seen = covers(shows[0], model.model.wide, model.model.lines)
            model.around = around(seen)
            model.core = core(seen, ONE * CLOSED, model.around)

    def _use(self, twig: list[Bytes]) -> None:
        """Show twigs as in this picture."""
        if self.card is None:
            shown = [each[::2, ..., 3].max(axis=0) for each in twig]
            self.solid = solid_above(twig[1][0, ..., 3])  # about as large as such cards are at most
            self.card = filtered(self.ctx, [evened(on_cards(each), ONE * self.solid) for each in twig])
            solid = covered_at(shown, ONE * self.solid)
            self.outline = pairs(outline(shown[0] > FAINTEST))
            self.core = pairs(outline(solid, CLOSE)) if solid.any() else []
            self._lies = lies_of(twig[0][:2])
            cover = twig[0][::2, ..., 3].mean(axis=(1, 2))
            self._hides = tuple((cover / cover[0]).tolist())

    def _twig_pictures(self, programs: Programs) -> list[Bytes]:
        """Return the pictures of its twig, with ever more and smaller leaves; a depth test is set meanwhile."""
        each = [self._twig_picture(programs, FINER_EACH**number) for number in range(OF_TWIGS)]
        return [np.concatenate(layers) for layers in zip(*each, strict=True)]

    def _twig_picture(self, programs: Programs, finer: float) -> list[Bytes]:
        """Return its picture with leaves so many times as small, and as many more as cover as much."""
        twig = programs.array(LEAVES, self.models[0].bare, baked=True)
        matrix, leaf = on_card(self.reach, self.habit.twigs.length), self.habit.leaf.finer(finer)
        off = SHOOTS_OFF if self.habit.leaf.shoots > 1 else HANGING_OFF
        numbers = {**_leaves(leaf, self.habit.twigs.length), "finer": (finer,), "shoots_off": (off,)}

        def draw_twig(number: int) -> None:
            del number
            self.tell(twig.program, self.models[0], numbers)
            _matrix(twig.program, matrix)
            twig.render(moderngl.TRIANGLES, vertices=QUAD * leaf.quads, instances=1)

        return smaller(pictures(self.ctx, 1, 1, CARD, CARD, draw_twig))

    def _model_pictures(self, programs: Programs, model: ModelOnCard) -> tuple[list[Bytes], list[Bytes]]:
        """Return the pictures of a model from all around, and how light has come to what they show."""
        wood, cards = (programs.array(sort, model.bare, model, baked=True) for sort in (WOOD, PICTURED))

        def draw_tree(number: int) -> None:
            matrix = from_around(number, model.model.middle, model.model.half, model.model.slim)
            for array, count in (
                (wood, 3 * len(model.model.wood[0].triangles)),
                (cards, QUAD * len(model.model.twigs)),
            ):
                self.tell(array.program, model, {}, noise=array is wood)
                _matrix(array.program, matrix)
                array.render(moderngl.TRIANGLES, vertices=count, instances=1)

        return of_tree(pictures(self.ctx, COLUMNS, ROWS, model.model.wide, model.model.lines, draw_tree))

    def _told(self) -> Numbers:
        """Return what programs are told of the kind, whichever of its models they draw."""
        habit, declared = self.habit, self.declared
        leaf, usual = habit.leaf, habit.twigs.length
        dark, bright = habit.leaves if declared.leaf is None else (declared.leaf, declared.leaf)
        young, old = (tuple(pigment(declared.bark or each).tolist()) for each in habit.bark)
        darker, (begins, ends) = DARKER if declared.leaf is not None else 1.0, habit.ripens
        return {
            "usual": (usual,), "card": (*self.reach, 0.0), "form": (leaf.form,), **_leaves(leaf, usual),
            "finer": (1.0,), "shoots_off": (SHOOTS_OFF,),
            "dark": tuple((darker * pigment(dark)).tolist()), "bright": tuple(pigment(bright).tolist()),
            "young_bark": young, "bark": old, "ripens": (begins, 1.0 / (ends - begins)), "rough": (habit.rough,),
        }  # fmt: skip

    def tell(self, program: moderngl.Program, model: ModelOnCard, *numbers: Numbers, noise: bool = False) -> None:
        """Tell a program of the kind, a model, and what else it is to know; bind what it reads."""
        set_packed(self.due(program, model))
        set_used_uniforms(program, *numbers)
        for read in self.reads(program, model, noise=noise):
            read.texture.use(read.unit)

    def due(self, program: moderngl.Program, model: ModelOnCard) -> PackedUniforms:
        """Return what a program is told of the kind and a model."""
        key = id(model)
        if key not in program.extra:  # the model is kept with it: so no other one is taken for it
            told = pack(program, self._numbers, model.numbers)
            lies = model.lies if "tree_far" in set_used_uniforms(program) else self._lies
            told += pack(program, {"hides": self._hides, "behind": (self._behind,)})
            told += pack_array(program, told_of.NAME, self._told_of[key]) + pack_array(program, "lies", lies)
            program.extra[key] = model, told
        found: PackedUniforms = program.extra[key][1]
        return found

    def reads(self, program: moderngl.Program, model: ModelOnCard, *, noise: bool = False) -> list[Read]:
        """Return what a program reads of the kind and a model, or what one does that reads noise in place of cards."""
        cards = self.bark if noise else self.card
        textures = {
            "tree_twigs": model.twigs.texture,
            "tree_far": model.far,
            "tree_met": model.met,
            "tree_cards": cards,
        }
        asked = set_used_uniforms(program)
        return [
            Read(texture, self.units[name])
            for name, texture in textures.items() if texture is not None and name in asked
        ]  # fmt: skip

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.models, self.bark)
        if self.card is not None:
            self.card.release()


def _leaves(leaf: Leaf, usual: float) -> Numbers:
    """Return what programs are told of a twig's leaves, where twigs are usually so long [m]."""
    shape = leaf.length / usual, 0.5 * leaf.width / usual, leaf.angle
    return {"leaf_count": (leaf.count,), "shoots": (leaf.shoots,), "leaf_shape": shape}


def _matrix(program: moderngl.Program, matrix: Doubles) -> None:
    program["baked"].write(np.ascontiguousarray(matrix.T, np.float32))  # type: ignore[union-attr]
