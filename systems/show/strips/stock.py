"""The strips of all patch models, ready to be planted."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats
from ...grow.record import NOTHING, Form, Growth, forms_of
from .grow import Strips, strips_of, targets_on


@dataclass(frozen=True, eq=False)
class StripStock:
    """The strips of all kinds' patch models, and the place of their pictures among those of each ring."""

    forms: tuple[Form, ...]
    """The present form of each kind, then the forms that kinds are changing into."""

    strips: list[list[Strips]]
    """Strips by ring and form, of the form's first model; the planes are the same in all its models."""

    slices: NDArray[np.int32]
    """Index of the plane that each blade is painted on, by ring, model and orientation, shape (rings, models, 2, n);
    the blades of all forms follow one another."""

    targets: Floats
    """Texture coordinates (u, v) at which each blade's control points are painted, shape (models, 2, n, points, 2); the
    same in all rings."""

    @cached_property
    def kinds(self) -> int:
        """Number of kinds."""
        return sum(form.number == form.kind for form in self.forms)

    @cached_property
    def present(self) -> list[list[Strips]]:
        """Strips of the present forms, by ring and kind."""
        return [ring[: self.kinds] for ring in self.strips]

    @cached_property
    def strips_per_plane(self) -> int:
        """Largest number of strips in one plane: one of each kind, or two while any kind may change its form."""
        return self.kinds if len(self.forms) == self.kinds else 2 * self.kinds

    @property
    def pictures(self) -> list[int]:
        """Index of the first picture by ring and form, with room for two forms of each kind."""
        room, first = 2 * self.kinds, 0
        pictures = [0] * (room * len(self.strips))
        for ring, strips in enumerate(self.strips):
            for form, of_form in zip(self.forms, strips, strict=True):
                pictures[ring * room + form.number] = first
                first += 2 * len(of_form.plane) * len(form.growth.models)
        return pictures

    @property
    def margin(self) -> float:
        """Largest distance that strips reach beyond their patch [m]."""
        return max(strips.margin for ring in self.strips for strips in ring)


def stock_strips(growths: Sequence[Growth], coming: Mapping[int, Growth] = NOTHING, /) -> StripStock:
    """Return the strips of all kinds' patch models; `coming` gives the growths that some kinds are changing into."""
    forms = forms_of(growths, coming)
    models = range(len(growths[0].models))
    rings = range(len(strips_of(growths[0].models[0])))
    strips = [[strips_of(form.growth.models[0])[ring] for form in forms] for ring in rings]
    by_model = [[strips_of(form.growth.models[model]) for form in forms] for model in models]
    slices = [
        np.stack([np.concatenate([of_form[ring].slice for of_form in of_model], 1) for of_model in by_model])
        for ring in rings
    ]
    targets = [np.concatenate([_targets(form.growth, model) for form in forms], 1) for model in models]
    return StripStock(forms, strips, slices=np.stack(slices), targets=np.stack(targets))


def _targets(growth: Growth, number: int, /) -> Floats:
    model = growth.models[number]
    return targets_on(strips_of(model)[0], model.blades, growth.postures)
