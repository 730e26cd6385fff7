"""Caches for each viewer, of what was computed or uploaded, so that viewers in turn do not undo each other's."""

from collections.abc import Callable, Iterator
from typing import Generic, TypeVar
from weakref import ref

import numpy as np

from .stream import Releasable, release_all

Made = TypeVar("Made")

MOST_VIEWERS = 4
"""Number of viewers with caches: those that looked last."""

Shelf = TypeVar("Shelf", bound=Releasable)


class Remembered(Generic[Made]):
    """Cache of the last result for each viewer, keyed by its inputs."""

    def __init__(self) -> None:
        self._made: dict[str, tuple[object, Made]] = {}

    def of(self, viewer: str, inputs: tuple[object, ...] | None, make: Callable[[], Made], /) -> Made:
        """Return the result of `make` for a viewer, from the cache if the viewer's `inputs` are the same as last time.

        Arrays are compared by their bytes, other inputs by equality. With None, `make` is always called.
        """
        key = inputs and [part.tobytes() if type(part) is np.ndarray else part for part in inputs]
        found = self._made.pop(viewer, None)
        if found is None or key is None or key != found[0]:
            found = key, make()
        self._made[viewer] = found
        if len(self._made) > MOST_VIEWERS:
            del self._made[next(iter(self._made))]
        return found[1]


class Shelves(Generic[Shelf]):
    """A shelf for each viewer: buffers and textures, and a record of what was uploaded to them last.

    There are `MOST_VIEWERS` at most: a further viewer gets the shelf of the one that has not looked for longest. A
    shelf is released when its viewer is gone.
    """

    def __init__(self, make: Callable[[], Shelf]) -> None:
        self._make = make
        self.now = make()
        """Shelf of the viewer that looks now; before any has looked, the shelf for the first."""
        self._looking: ref[object] | None = None
        self._spare = [self.now]
        self._all: dict[str, tuple[ref[object], Shelf]] = {}
        self._gone: list[str] = []

    def of(self, name: str, viewer: object, /) -> Shelf:
        """Make the named viewer the one that looks; return its shelf. The shelf is freed when `viewer` is collected."""
        if self._looking is not None and self._looking() is viewer and not self._gone:
            return self.now
        self._spare += [self._all.pop(gone)[1] for gone in self._gone if gone != name and gone in self._all]
        self._gone.clear()
        found = self._all.pop(name, None)
        if found is None and not self._spare and len(self._all) >= MOST_VIEWERS:
            found = self._all.pop(next(iter(self._all)))
        self.now = found[1] if found else self._spare.pop() if self._spare else self._make()
        gone = self._gone
        self._looking = ref(viewer, lambda _: gone.append(name))
        self._all[name] = self._looking, self.now
        release_all(*self._spare)
        self._spare.clear()
        return self.now

    def __iter__(self) -> Iterator[Shelf]:
        return iter([*self._spare, *(shelf for _, shelf in self._all.values())])

    def release(self) -> None:
        """Release all shelves."""
        release_all(*self)
