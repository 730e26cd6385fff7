"""What was made for a viewer, or sent to GL, need not be made or sent again, whoever has looked meanwhile."""

from collections.abc import Callable, Iterator
from typing import Generic, TypeVar
from weakref import ref

import numpy as np

from .stream import Releasable, release_all

Made = TypeVar("Made")

MOST_VIEWERS = 4
"""Viewers for whom anything is remembered: those that looked last."""

Shelf = TypeVar("Shelf", bound=Releasable)


class Remembered(Generic[Made]):
    """What was last made for each viewer, and what it was made of."""

    def __init__(self) -> None:
        self._made: dict[str, tuple[object, Made]] = {}

    def of(self, viewer: str, made_of: tuple[object, ...] | None, make: Callable[[], Made], /) -> Made:
        """Return what `make` makes for a viewer.

        It is not made again if it was made of the same: of arrays of the same bytes, and of other things that are
        equal. With None it is always made.
        """
        now = made_of and [part.tobytes() if type(part) is np.ndarray else part for part in made_of]
        found = self._made.pop(viewer, None)
        if found is None or now is None or now != found[0]:
            found = now, make()
        self._made[viewer] = found
        if len(self._made) > MOST_VIEWERS:
            del self._made[next(iter(self._made))]
        return found[1]


class Shelves(Generic[Shelf]):
    """A shelf for each viewer: buffers and textures, and what was last sent there.

    There are `MOST_VIEWERS` at most: one more viewer gets that of who has not looked for longest. A shelf is given back
    when what it is for is gone.
    """

    def __init__(self, make: Callable[[], Shelf]) -> None:
        self._make = make
        self.now = make()
        """The shelf of the viewer that looks; before any has looked, that of the first."""
        self._looking: ref[object] | None = None
        self._spare = [self.now]
        self._all: dict[str, tuple[ref[object], Shelf]] = {}
        self._gone: list[str] = []

    def of(self, name: str, viewer: object, /) -> Shelf:
        """Return the shelf of the viewer of a name, which looks from now on; `viewer` lives as long as it is there."""
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
        """Give all shelves back."""
        release_all(*self)
