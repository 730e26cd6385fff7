"""The manifest of a film: its sources, and a hash of each picture, by which parts of films can be compared."""

import json
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

import numpy as np

from .. import __version__
from ..engine.scene import LoadedScene
from .studio.encode import Frame, write_whole
from .studio.shooting import Shot
from .studio.take import Take


@dataclass(frozen=True, slots=True)
class Span:
    """The range of frames that is made of a whole film."""

    first: int
    """Index of the first frame."""

    end: int
    """Index after the last frame."""

    of: int
    """Number of frames of the whole film."""

    fps: int
    """Frames per second."""

    @property
    def whole(self) -> bool:
        """Whether the range is the whole film."""
        return (self.first, self.end) == (0, self.of)


@dataclass(slots=True)
class Manifest:
    """Collects the hashes of a film's pictures."""

    span: Span
    hashes: list[str] = field(default_factory=list)
    """SHA-256 of each picture's bytes: sRGB, top row first."""

    renderer: str = ""
    """GL renderer that drew the pictures."""

    def noted(self, shots: Iterable[Shot], /) -> Iterator[Frame]:
        """Yield the frames, and note the hash of each."""
        for shot in shots:
            self.hashes.append(shot.sha256)
            self.renderer = shot.renderer
            yield shot.frame

    def place(self, output: str, /) -> Path:
        """Return the file's path beside a film: `walk.webp.json`, or for frames 100 to 129 `walk.webp.100-130.json`."""
        path = Path(output.rstrip("/" + os.sep))
        part = "" if self.span.whole else f".{self.span.first}-{self.span.end}"
        return path.with_name(f"{path.name}{part}.json")

    def write(self, output: str, loaded: LoadedScene, take: Take) -> None:
        """Write the manifest beside a film, as JSON."""
        content = {**_made_from(loaded, take), "renderer": self.renderer, **self._pictures()}
        write_whole(json.dumps(content, indent=1) + "\n", self.place(output))

    def _pictures(self) -> dict[str, object]:
        span = self.span
        rows = [
            {"frame": number, "time": round(number / span.fps, 6), "sha256": pixel_hash}
            for number, pixel_hash in enumerate(self.hashes, span.first)
        ]
        return {"fps": span.fps, "frames": {"first": span.first, "end": span.end, "of": span.of}, "pictures": rows}


def _made_from(loaded: LoadedScene, take: Take) -> dict[str, object]:
    return {
        "tallgrass": __version__,
        "numpy": np.__version__,
        "scene": loaded.file.name,
        "seed": loaded.scene.seed,
        "files": {name: sha256(path.read_bytes()).hexdigest() for name, path in loaded.paths.items()},
        "size": list(take.size),
        "quality": loaded.scene.numbers(take.preset).model_dump(mode="json"),
        "lod": take.lod,
        "reference": take.reference,
        "overlay": sorted(take.overlay),
    }
