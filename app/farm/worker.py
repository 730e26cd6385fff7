"""What a worker does: it keeps the prairie of one film, and draws the frames that it is asked for.

All of it happens in one thread, however many Dask gives a worker: a GL context belongs to a thread, and a prairie's
entities to their world.
"""

import signal
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypeVar

import PIL
from PIL import features

from ...engine.scene import SceneError
from ..studio.errors import InputError
from ..studio.shooting import Shooting, Shot
from .dask import versions
from .parcel import Parcel, unpack

Result = TypeVar("Result")

_THREAD = ThreadPoolExecutor(1, thread_name_prefix="tallgrass")


@dataclass(frozen=True, slots=True)
class Order:
    """How the frames of a film are wanted."""

    fps: int
    """Frames per second."""

    files: Mapping[str, str] | None
    """Where they are wanted as PNG files, what the film says of itself."""

    codec: str
    """What makes PNG files where the film is put together: only the same one makes the same bytes."""


@dataclass(frozen=True, slots=True, eq=False)
class Footage:
    """Some frames in a row, drawn by a worker."""

    shots: list[Shot]

    versions: str
    """What the worker has of what pictures depend on."""


class _Kept:
    """A film that this process draws; it stays until another one is wanted."""

    def __init__(self, parcel: Parcel, fps: int, scratch: str) -> None:
        self.mark = (parcel.mark, fps)
        self._held = ExitStack()
        with ExitStack() as held:
            folder = held.enter_context(TemporaryDirectory(prefix="scene-", dir=scratch))
            self.shooting = held.enter_context(Shooting(unpack(parcel, Path(folder)), fps))
            self._held = held.pop_all()

    def let_go(self) -> None:
        """Give everything back."""
        self._held.close()


_kept: list[_Kept] = []


def dask_setup(_: object) -> None:
    """Get a worker of this machine ready, as Dask calls it: the key that stops a command is for the command alone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def codec() -> str:
    """Return what makes PNG files here."""
    return f"Pillow {PIL.__version__}, zlib {features.version('zlib')}, zlib-ng {features.version_feature('zlib_ng')}"


def footage(parcel: Parcel, order: Order, first: int, end: int, /) -> Footage:
    """Return the frames from `first` to the one before `end` of a film.

    Raises InputError for what is wrong with the scene here, MachineError where this worker cannot draw.
    """
    scratch = str(import_module("distributed").get_worker().local_directory)
    return in_drawing_thread(lambda: _footage(parcel, order, first, end, scratch))


def in_drawing_thread(work: Callable[[], Result], /) -> Result:
    """Do something in the thread that draws, and return what comes of it."""
    return _THREAD.submit(work).result()


def let_go() -> None:
    """Give back what this process keeps of a film, once it has done what it is doing."""
    _THREAD.submit(_let_go)


def _footage(parcel: Parcel, order: Order, first: int, end: int, scratch: str) -> Footage:
    with told_in_lines():
        held = _kept_for(parcel, order.fps, first, scratch)
    files = order.files if order.codec == codec() else None
    return Footage(list(held.shooting.shots(first, end, files=files)), versions())


def _kept_for(parcel: Parcel, fps: int, first: int, scratch: str) -> _Kept:
    if _kept and _kept[0].mark == (parcel.mark, fps) and _kept[0].shooting.following <= first:
        return _kept[0]
    _let_go()
    _kept.append(_Kept(parcel, fps, scratch))
    return _kept[0]


def _let_go() -> None:
    while _kept:
        _kept.pop().let_go()


@contextmanager
def told_in_lines() -> Iterator[None]:
    """Send the problems of a scene on their way as lines: an error of many parts does not come through."""
    try:
        yield
    except SceneError as error:
        raise InputError("\n".join(str(problem).splitlines()[0] for problem in error.problems)) from None
