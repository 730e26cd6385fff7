"""The strips of all patch models, ready to be stood on the terrain."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats
from ...grow.record import NOTHING, Form, Growth, forms_of
from .grow import Strips, strips_of, targets_on


@dataclass(frozen=True, slots=True, eq=False)
class StripStock:
    """The strips of all kinds' patch models, and where their pictures are among each ring's."""

    forms: tuple[Form, ...]
    """What kinds have grown to, and after these what some are to become."""

    strips: list[list[Strips]]
    """By ring and form: strips whose planes hold for all the form's models."""

    first_picture: list[list[int]]
    """By ring and form: where the form's pictures begin among the ring's."""

    slices: NDArray[np.int32]
    """The plane that each blade is painted on, by ring, model and orientation, shape (rings, models, 2, n): the blades
    of all forms one after another."""

    targets: Floats
    """Where each blade's points are painted, (u, v), shape (models, 2, n, points, 2): the same in all rings."""

    @property
    def own(self) -> list[list[Strips]]:
        """By ring and kind, those that kinds have grown to."""
        kinds = sum(form.number == form.kind for form in self.forms)
        return [ring[:kinds] for ring in self.strips]

    @property
    def margin(self) -> float:
        """How far strips reach beyond their patch [m]."""
        return max(strips.margin for ring in self.strips for strips in ring)


def stock_strips(growths: Sequence[Growth], coming: Mapping[int, Growth] = NOTHING, /) -> StripStock:
    """Return the strips of all kinds' patch models; `coming` gives what some are to become."""
    forms = forms_of(growths, coming)
    models = range(len(growths[0].models))
    rings = range(len(strips_of(growths[0].models[0])))
    strips = [[strips_of(form.growth.models[0])[ring] for form in forms] for ring in rings]
    pictures = [[2 * len(models) * len(of_form.plane) for of_form in ring] for ring in strips]
    first = [[sum(counts[:form]) for form in range(len(counts))] for counts in pictures]
    each = [[strips_of(form.growth.models[model]) for form in forms] for model in models]
    slices = [
        np.stack([np.concatenate([own[ring].slice for own in of_model], 1) for of_model in each]) for ring in rings
    ]
    targets = [np.concatenate([_targets(form.growth, model) for form in forms], 1) for model in models]
    return StripStock(forms, strips, first_picture=first, slices=np.stack(slices), targets=np.stack(targets))


def _targets(growth: Growth, model: int, /) -> Floats:
    own = growth.models[model]
    return targets_on(strips_of(own)[0], own.blades, growth.postures)
