"""Growing many kinds on many machines: each is grown by a worker, and kept where it was asked for."""

from collections.abc import Iterator, Sequence

from ...engine.declared.grass import GrassKind
from ...engine.declared.quality import Quality
from ...systems.stock.cache import growth_key, packed_growth
from ..studio.errors import MachineError
from .hire import hired


def grown_on(on: str, seeds: Sequence[tuple[GrassKind, Quality, int]], /) -> Iterator[bytes]:
    """Yield the packed growths of kinds at a quality from seeds, in their order, as the workers of a place grow them.

    `on` is a place as `hired` takes it, and what that raises is raised.
    """
    with hired(on, most=len(seeds)) as hands:
        keys = [growth_key(kind, quality, seed=seed) for kind, quality, seed in seeds]
        yield from hands.in_order(grown, ((*each, key) for each, key in zip(seeds, keys, strict=True)))


def grown(kind: GrassKind, quality: Quality, seed: int, key: str, /) -> bytes:
    """Grow a kind in a worker; raises MachineError where other code than that of who asks would grow it."""
    if growth_key(kind, quality, seed=seed) != key:
        raise MachineError("--on: a worker grows grass by other code than this machine; install the same there")
    return packed_growth(kind, quality, seed=seed)
