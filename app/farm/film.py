"""A film on many machines: cut into ranges of frames, which workers draw."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from ...engine.scene import LoadedScene, load_maps
from ..manifest import Span
from ..studio.errors import MachineError
from ..studio.shooting import Shot
from ..studio.take import Take
from .dask import versions
from .hands import Hands, LostError
from .hire import hired
from .parcel import Parcel, packed
from .worker import Footage, Order, codec, footage, let_go

LONGEST = 8
"""Most frames of a range, which is drawn again when its worker is lost."""

MOST_BYTES = 1 << 26
"""Most bytes of pixels in a range of more than one frame."""

RANGES = 8
"""Least number of ranges per worker, given enough frames, so that all workers finish at about the same time."""


@contextmanager
def shot_on(
    on: str, take: Take, loaded: LoadedScene, span: Span, files: Mapping[str, str] | None, /
) -> Iterator[Iterator[Shot]]:
    """Yield the shots of a film in their order, drawn by the workers of a place, as `hired` takes it.

    `files` is the film's metadata if its frames are wanted as PNG files, else None. Raises what `hired` raises,
    InputError where the scene names a file outside its folder, SceneError where a map is wrong.
    """
    parcel = packed(take, loaded)
    load_maps(loaded)  # reports their problems once, with this machine's file names
    with hired(on, most=span.end - span.first) as hands:
        try:
            yield _shots(hands, parcel, span, Order(span.fps, files, codec()))
        finally:
            hands.everywhere(let_go)


def ranges(span: Span, workers: int, size: tuple[int, int], /) -> Iterator[tuple[int, int]]:
    """Yield the ranges of frames that a film is cut into, each as its first frame and the one after its last."""
    count = span.end - span.first
    most = max(1, min(LONGEST, MOST_BYTES // (3 * size[0] * size[1])))
    step = min(most, -(-count // (RANGES * max(1, workers))))
    for first in range(span.first, span.end, step):
        yield first, min(first + step, span.end)


def _shots(hands: Hands, parcel: Parcel, span: Span, order: Order) -> Iterator[Shot]:
    sent = hands.keep(parcel)
    pieces = ((sent, order, first, end) for first, end in ranges(span, hands.count, parcel.take.size))
    given = span.first
    alike: Footage | None = None
    try:
        for done in hands.in_order(footage, pieces):
            alike = must_be_alike(done, alike)
            for shot in done.shots:
                yield shot
                given += 1
    except LostError as error:
        if order.files is None:
            raise
        raise MachineError(f"{error}; go on with --frames {given}:{span.end}") from error


def must_be_alike(done: Footage, other: Footage | None, /) -> Footage:
    """Return `done` for the next comparison; raises MachineError where versions or renderers differ."""
    if done.versions != versions():
        raise MachineError(f"--on: a worker has {done.versions}, and this machine {versions()}")
    if other is not None and done.shots[0].renderer != other.shots[0].renderer:
        both = f"{done.shots[0].renderer} and by {other.shots[0].renderer}"
        raise MachineError(f"--on: workers draw by {both}: those are never the same pictures")
    return done
