"""The features that there are, and the texture units that they and the representations read from."""

from collections.abc import Iterable
from typing import TypeVar

from .bodies.feature import Bodies
from .frame.feature import Feature, Start
from .frame.units import dealt
from .lamps.feature import Lamps
from .land.earth import Earth
from .land.part import Land
from .light.feature import Lighting
from .light.given import GivenHaze
from .mow.feature import Mowing
from .pressers import Pressers
from .shadows.feature import UNITS as BORROWED
from .shadows.feature import Shadows
from .show.registry import REPRESENTATIONS
from .trees.feature import Trees
from .trees.shade import UNIT as TREE_SHADE
from .winds import Winds

FEATURES: tuple[type[Feature], ...] = (
    Winds, Pressers, Land, Earth, Lighting, GivenHaze, Mowing, Lamps, Shadows, Bodies, Trees,
)  # fmt: skip
"""In the order in which they are made, told of a scene read again, and drawn."""

UNITS = (
    dealt(
        ["received", *(name for each in FEATURES for name in each.samplers)],
        [name for each in FEATURES for name in each.asked],
        {
            **{each.__name__: ((), each.own) for each in FEATURES},
            **{each.name: (each.asked, each.samplers) for each in REPRESENTATIONS},
        },
    )
    | BORROWED
    | {"tree_shade": TREE_SHADE}
)
"""The texture unit of each sampler."""

Sort = TypeVar("Sort", bound=Feature)


def begun(start: Start, /) -> list[Feature]:
    """Return all features of a prairie."""
    return [each.begin(start) for each in FEATURES]


def one(sort: type[Sort], features: Iterable[Feature], /) -> Sort:
    """Return the feature of a class."""
    return next(each for each in features if isinstance(each, sort))
