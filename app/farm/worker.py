"""The code of a worker: it keeps the prairie of one film, and draws the ranges of frames that are submitted.

It draws in one thread, however many Dask gives a worker: a GL context belongs to a thread, and a prairie's entities to
their world.
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
    """The form of a film's frames."""

    fps: int
    """Frames per second."""

    files: Mapping[str, str] | None
    """Metadata of the film if frames are wanted as PNG files, else None."""

    codec: str
    """PNG encoder of the machine that assembles the film: only the same one makes the same bytes."""


@dataclass(frozen=True, slots=True, eq=False)
class Footage:
    """Consecutive frames, drawn by a worker."""

    shots: list[Shot]

    versions: str
    """Versions on the worker, as `versions` returns them."""


class _Kept:
    """The film that this process draws, until it is asked for another one."""

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
    """Set up a worker on this machine, called by Dask: it ignores Ctrl C, which is for the command alone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def codec() -> str:
    """Return the PNG encoder of this machine, with versions."""
    return f"Pillow {PIL.__version__}, zlib {features.version('zlib')}, zlib-ng {features.version_feature('zlib_ng')}"


def footage(parcel: Parcel, order: Order, first: int, end: int, /) -> Footage:
    """Return the frames from `first` to the one before `end` of a film.

    Raises InputError for problems of the scene on this machine, MachineError where this worker cannot draw.
    """
    scratch = str(import_module("distributed").get_worker().local_directory)
    return in_drawing_thread(lambda: _footage(parcel, order, first, end, scratch))


def in_drawing_thread(work: Callable[[], Result], /) -> Result:
    """Call `work` in the thread that draws, and return its result."""
    return _THREAD.submit(work).result()


def let_go() -> None:
    """Release the film that this process keeps, after its current work."""
    _THREAD.submit(_let_go)


def _footage(parcel: Parcel, order: Order, first: int, end: int, scratch: str) -> Footage:
    with problems_as_lines():
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
def problems_as_lines() -> Iterator[None]:
    """Raise a scene's problems as an InputError of lines: a SceneError of many parts is not transported."""
    try:
        yield
    except SceneError as error:
        raise InputError("\n".join(str(problem).splitlines()[0] for problem in error.problems)) from None
