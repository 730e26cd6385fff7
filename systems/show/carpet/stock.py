"""The carpet's images of all kinds, as grown now and as they are to become, and the uniforms that describe them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats
from ...frame.block import by_kind
from ...grow.organs import any_heads
from ...grow.record import NOTHING, Form, Growth, forms_of
from ...space.canopy import canopy_height
from .grow import carpet_of
from .heads import profile_of
from .textures import bents_of

HEADINGS = 4
"""Number of viewing directions, at each slope."""

RAISED = 0.66
"""Height of the carpet, as a fraction of the grass's: what it shows keeps its place in the picture."""


@dataclass(frozen=True, slots=True, eq=False)
class Images:
    """Arrays that describe the images of all kinds, each (kinds, ...)."""

    height: Floats
    """Height that the images cover [m], (kinds,)."""

    crown: Floats
    """Height of the canopy [m], (kinds,)."""

    bents: Floats
    """From `bents_of`."""

    profile: Floats
    """From `profile_of`; empty if no kind bears heads."""

    @classmethod
    def of(cls, growths: Sequence[Growth], /, *, heads: bool) -> Self:
        """Return the description of these growths; `heads` tells whether any kind bears heads."""
        return cls(
            height=np.array([carpet_of(growth.models[0]).height for growth in growths], np.float32),
            crown=np.array([canopy_height(growth) for growth in growths], np.float32),
            bents=bents_of(growths),
            profile=np.array([profile_of(growth) for growth in growths] if heads else [], np.float32),
        )


@dataclass(frozen=True, slots=True, eq=False)
class CarpetStock:
    """The images of all kinds, and of what some kinds are to become."""

    forms: tuple[Form, ...]
    """Forms of all kinds, in the order of their layers."""

    before: Images
    """Of the kinds as they are."""

    after: Images
    """Of the kinds as they are to become; of the others as they are."""

    heads: bool
    """Whether any kind bears heads."""

    @classmethod
    def of(cls, growths: Sequence[Growth], coming: Mapping[int, Growth] = NOTHING, /) -> Self:
        """Return the stock of these growths, and of what some kinds are to become, `coming` by kind number."""
        forms = forms_of(growths, coming)
        heads = any_heads([form.growth for form in forms])
        before = Images.of(growths, heads=heads)
        after = [coming.get(kind, growth) for kind, growth in enumerate(growths)]
        return cls(forms, before, Images.of(after, heads=heads) if coming else before, heads)

    @property
    def growths(self) -> list[Growth]:
        """The growth of each form."""
        return [form.growth for form in self.forms]

    def uniforms(self, came: Sequence[float], /) -> dict[str, object]:
        """Return uniforms by name.

        `came` (kinds,) is the fraction of each kind's plants that have become what the kind is to become.
        """
        height = self._blended("height", came)
        uniforms: dict[str, object] = {
            "tops": by_kind((height / self._blended("crown", came)).tolist()),
            "raised": by_kind((RAISED * height).tolist()),
        }
        if self.heads:
            uniforms["profile"] = self._blended("profile", came).reshape(-1, 2).tolist()
        return uniforms

    def bents(self, came: Sequence[float], /) -> NDArray[np.float16]:
        """Return the table of `bents_of`, with `came` as in `uniforms`."""
        return self._blended("bents", came).astype(np.float16)

    def layer_uniforms(self, seed: int, /, *, whole: bool) -> dict[str, object]:
        """Return uniforms by name that tell the texture layers of images; `seed` is the scene's.

        One of them is the coarsest mip level, whose side is 1 texel. If `whole`, images are stored with their sides
        rounded up to a power of two.
        """
        example = carpet_of(self.forms[0].growth.models[0])
        slopes, side = example.slope, example.texels.shape[-2]
        coarsest = (side - 1).bit_length() if whole else side.bit_length() - 1
        kinds, layer = len(self.before.height), 0
        first = [0.0] * (2 * kinds)
        for form in self.forms:
            first[form.number] = float(layer)
            layer += len(form.growth.models) * len(slopes) * HEADINGS
        return {
            "slopes": slopes.tolist(),
            "first": by_kind(first[:kinds]),
            "coming": by_kind(first[kinds:]),
            "stock": (len(self.forms[0].growth.models), seed, coarsest),
        }

    def _blended(self, name: str, came: Sequence[float]) -> Floats:
        before, after = getattr(self.before, name), getattr(self.after, name)
        if not came:
            return np.asarray(before)
        fraction = np.array(came, np.float32).reshape(-1, *[1] * (before.ndim - 1))
        return np.asarray(before + fraction * (after - before), np.float32)
