"""Shooting a film: frame k of a scene shows the time k / fps, and is the same in every process."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256

import numpy as np

from .encode import Frame, Picture, at_frame, png
from .studio import Studio
from .take import Take


@dataclass(frozen=True, slots=True, eq=False)
class Shot:
    """One frame of a film, drawn."""

    frame: Frame

    sha256: str
    """Hash of its pixels: sRGB, three bytes each, top row first."""

    renderer: str
    """GL_RENDERER of the context that drew it."""


class Shooting(Studio):
    """A film that is drawn frame by frame, never backwards; a context manager.

    Skipped frames are followed without drawing, since a frame depends on those before. Raises what `Studio` does.
    """

    def __init__(self, take: Take, fps: int) -> None:
        super().__init__(take)
        self._fps, self.following = fps, 0
        """Index of the earliest frame that can still be drawn."""

    def shots(self, first: int, end: int, /, *, files: Mapping[str, str] | None = None) -> Iterator[Shot]:
        """Yield the frames from `first` to the one before `end`, drawn as they are asked for.

        With the film's metadata in `files`, each frame is a PNG file's bytes. Raises ValueError for a frame that
        has gone by.
        """
        if first < self.following:
            raise ValueError(f"the frame {first} has gone by: the next one is {self.following}")
        renderer = str(self.ctx.info["GL_RENDERER"])
        for number in range(first, end):
            picture = self._at(number)
            pixel_hash = sha256(np.ascontiguousarray(picture).data).hexdigest()
            frame = picture if files is None else png(picture, at_frame(files, number, self._fps))
            yield Shot(frame, pixel_hash, renderer)

    def _at(self, number: int) -> Picture:
        while self.following < number:
            self.follow(self.camera(self._advance()))
        return self.picture(self.camera(self._advance()))

    def _advance(self) -> float:
        """Advance the prairie to the next frame's instant, and return the instant [s]."""
        time = self.following / self._fps
        self.prairie.advance(time - self.prairie.time)
        self.following += 1
        return time
