"""What the carpet's programs are told of kinds: of what has grown, and of what that is to become."""

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
"""Images from all around, at each slope."""


@dataclass(frozen=True, slots=True, eq=False)
class Images:
    """What is known of the images of all kinds, (kinds, ...) each."""

    height: Floats
    """How high they reach [m]."""

    crown: Floats
    """Height of the canopy [m]."""

    bents: Floats

    profile: Floats
    """Where leaf area is in the canopy; nothing where no kind bears heads."""

    @classmethod
    def of(cls, growths: Sequence[Growth], /, *, heads: bool) -> Self:
        """Return what is to be known of what has grown of kinds."""
        return cls(
            height=np.array([carpet_of(growth.models[0]).height for growth in growths], np.float32),
            crown=np.array([canopy_height(growth) for growth in growths], np.float32),
            bents=bents_of(growths),
            profile=np.array([profile_of(growth) for growth in growths] if heads else [], np.float32),
        )


@dataclass(frozen=True, slots=True, eq=False)
class CarpetStock:
    """The images of all kinds."""

    forms: tuple[Form, ...]
    """In the order of their layers."""

    before: Images
    after: Images
    """Of what kinds are to be; of the others what they are."""

    heads: bool
    """Whether any kind bears heads."""

    @classmethod
    def of(cls, growths: Sequence[Growth], coming: Mapping[int, Growth] = NOTHING, /) -> Self:
        """Return the stock of what has grown of kinds, and of what some are to become."""
        forms = forms_of(growths, coming)
        heads = any_heads([form.growth for form in forms])
        before = Images.of(growths, heads=heads)
        after = [coming.get(kind, growth) for kind, growth in enumerate(growths)]
        return cls(forms, before, Images.of(after, heads=heads) if coming else before, heads)

    @property
    def growths(self) -> list[Growth]:
        """What has grown of each form."""
        return [form.growth for form in self.forms]

    def told(self, came: Sequence[float], part: float, /) -> dict[str, object]:
        """Return what programs are told, by name, where `came` (kinds,) of each kind have become what they are to be.

        The carpet lies at a `part` of the height of the grass.
        """
        height = self._at("height", came)
        told: dict[str, object] = {
            "tops": by_kind((height / self._at("crown", came)).tolist()),
            "raised": by_kind((part * height).tolist()),
        }
        if self.heads:
            told["profile"] = self._at("profile", came).reshape(-1, 2).tolist()
        return told

    def bents(self, came: Sequence[float], /) -> NDArray[np.float16]:
        """Return the table of bends, likewise."""
        return self._at("bents", came).astype(np.float16)

    def layers(self, seed: int, /, *, whole: bool) -> dict[str, object]:
        """Return what programs are told of where images are; `seed` is the scene's.

        Their sides are halved until they are 1; if `whole`, from the next power of two on.
        """
        one = carpet_of(self.forms[0].growth.models[0])
        slopes, side = one.slope, one.texels.shape[-2]
        coarsest = (side - 1).bit_length() if whole else side.bit_length() - 1
        kinds, at = len(self.before.height), 0
        first = [0.0] * (2 * kinds)
        for form in self.forms:
            first[form.number] = float(at)
            at += len(form.growth.models) * len(slopes) * HEADINGS
        return {
            "slopes": slopes.tolist(),
            "first": by_kind(first[:kinds]),
            "coming": by_kind(first[kinds:]),
            "stock": (len(self.forms[0].growth.models), seed, coarsest),
        }

    def _at(self, name: str, came: Sequence[float]) -> Floats:
        before, after = getattr(self.before, name), getattr(self.after, name)
        if not came:
            return np.asarray(before)
        part = np.array(came, np.float32).reshape(-1, *[1] * (before.ndim - 1))
        return np.asarray(before + part * (after - before), np.float32)
