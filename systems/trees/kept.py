"""Pictures of trees that were drawn once, kept on disk under a hash of everything that they depend on."""

import io
import json
import zipfile
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from hashlib import blake2b
from importlib.resources import files
from importlib.resources.abc import Traversable

import numpy as np

from ...components.arrays import Bytes
from ...engine.kept import keep, kept
from .bake import CARD
from .far import COARSER, COLUMNS, LEVELS, ROWS
from .twig import PICTURES as OF_TWIGS

SUFFIX = ".trees"

MOST = 24
"""Files that are kept: a kind of tree each, and some megabytes."""

QUICKLY = 1
"""How hard files are compressed: a fifth of the time of what is usual, for files a tenth larger."""

Picture = list[Bytes]
"""Layers (n, rows, columns, 4) at each of their sizes, the finest first."""


def kind_key(habit: str, seed: int, renderer: str, /) -> str:
    """Return a name for the pictures of a kind as a graphics card draws them, in hexadecimal; colours do not count."""
    depends = {"version": _version(), "habit": habit, "seed": seed, "renderer": renderer}
    return blake2b(json.dumps(depends, sort_keys=True).encode(), digest_size=20).hexdigest()


def kept_pictures(key: str, sides: list[tuple[int, int]], /) -> list[Picture] | None:
    """Return a twig's pictures and those of a kind's models, as they were kept; None where they are not, or broken.

    Of each model there are two, as `of_tree` has them; they have so many texels across and up.
    """
    told = kept(key + SUFFIX, key)
    if told is None:
        return None
    with suppress(ValueError, KeyError, zipfile.BadZipFile):
        with np.load(io.BytesIO(told), allow_pickle=False) as archive:
            sizes = sizes_of(sides)
            found = [[archive[f"{one}.{level}"] for level in range(len(each))] for one, each in enumerate(sizes)]
        if all(
            texels.dtype == np.uint8 and texels.shape == size
            for picture, each in zip(found, sizes, strict=True) for texels, size in zip(picture, each, strict=True)
        ):  # fmt: skip
            return found
    return None


def keep_pictures(key: str, pictures: list[Picture], /) -> None:
    """Keep what `kept_pictures` returns; where nothing can be written, that is said once."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=QUICKLY) as archive:
        for one, levels in enumerate(pictures):
            for level, texels in enumerate(levels):
                with archive.open(f"{one}.{level}.npy", "w") as file:
                    np.lib.format.write_array(file, texels, allow_pickle=False)
    keep(key + SUFFIX, key, buffer.getvalue(), most=MOST)


def sizes_of(sides: list[tuple[int, int]], /) -> list[list[tuple[int, int, int, int]]]:
    """Return the shapes of all pictures of a kind, at each of their sizes."""
    coarser = COARSER.bit_length() - 1
    each = [(2 * OF_TWIGS, CARD, CARD, range(LEVELS))]
    for wide, lines in sides:
        each += [(1, ROWS * lines, COLUMNS * wide, levels) for levels in (range(LEVELS), range(coarser, LEVELS))]
    return [
        [(layers, rows >> level, columns >> level, 4) for level in levels] for layers, rows, columns, levels in each
    ]


@cache
def _version() -> str:
    """Return a hash of the code that grows and draws trees, so that nothing drawn by other code counts as its own."""
    digest = blake2b(np.__version__.encode(), digest_size=16)
    root = files("tallgrass")
    for folder in (root / "systems" / "trees", root / "engine" / "shaders" / "lib"):
        for name, source in sorted(_sources(folder)):
            digest.update(name.encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()


def _sources(folder: Traversable) -> Iterator[tuple[str, Traversable]]:
    for entry in folder.iterdir():
        if entry.is_file() and entry.name.endswith((".py", ".glsl", ".vert", ".frag")):
            yield entry.name, entry
