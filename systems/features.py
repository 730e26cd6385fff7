"""The features that there are, and the texture units that they and the representations read from."""

from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar

from ..engine.gl.units import UNITS as FREE
from .bodies.feature import Bodies
from .frame.feature import Feature, Start
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

STAGE = len(FREE)
"""Units that a shader stage has at least, in OpenGL 3.3: all programs make do with so many, in all stages."""


def dealt(
    throughout: Sequence[str], asked: Sequence[str], own: Mapping[str, tuple[Iterable[str], Iterable[str]]], /
) -> dict[str, int]:
    """Return the texture unit of each sampler, one of `FREE`.

    What is bound `throughout` a frame comes first. After it comes what each of `own` has, by its name, what its passes
    over receivers read and then all else: each binds them itself when it draws, so all share these units. What any pass
    over receivers reads, `asked`, comes last. Raises RuntimeError where a program would need more than `STAGE`.
    """
    units = dict(zip(throughout, FREE, strict=False))
    units |= dict(zip(asked, reversed(FREE), strict=False))
    for who, (passed, drawn) in own.items():
        first, rest = list(dict.fromkeys(passed)), list(drawn)
        names = [*first, *(name for name in rest if name not in first)]
        for needed in ([*throughout, *first, *asked], [*throughout, *names]):
            if len(needed) > STAGE:
                raise RuntimeError(
                    f"{who} reads {len(needed)} textures at once where OpenGL 3.3 has {STAGE}: {', '.join(needed)}"
                )
        units |= dict(zip(names, FREE[len(throughout) :], strict=False))
    return units


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
