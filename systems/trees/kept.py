"""Pictures of trees, cached on disk under a hash of everything that they depend on."""

import io
import json
import zipfile
from contextlib import suppress
from hashlib import blake2b

import numpy as np

from ...components.arrays import Bytes
from ...engine.kept import code_hash, keep, kept
from .bake import CARD
from .far import COARSER, COLUMNS, LEVELS, ROWS
from .twig import PICTURES as OF_TWIGS

SUFFIX = ".trees"

CODE = "systems/trees", "engine/shaders/lib"
"""Sources that grow and draw trees."""

MOST = 24
"""Number of files that are kept, one a kind of tree, of some megabytes each."""

QUICKLY = 1
"""Compression level: a fifth of the usual time, for files a tenth larger."""

Picture = list[Bytes]
"""Layers (n, rows, columns, 4) at each mip level, the finest first."""


def kind_key(habit: str, seed: int, renderer: str, /) -> str:
    """Return the cache key of a kind's pictures on a graphics card, in hexadecimal; colours are not in it."""
    depends = {"code": code_hash(*CODE), "habit": habit, "seed": seed, "renderer": renderer}
    return blake2b(json.dumps(depends, sort_keys=True).encode(), digest_size=20).hexdigest()


def kept_pictures(key: str, sides: list[tuple[int, int]], /) -> list[Picture] | None:
    """Return a twig's pictures and those of its kind's models from the cache; None where missing or broken.

    A model has two, as `tree_levels` returns them; `sides` are the texels across and up of each model's.
    """
    data = kept(key, SUFFIX)
    if data is None:
        return None
    with suppress(ValueError, KeyError, zipfile.BadZipFile):
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            sizes = sizes_of(sides)
            found = [[archive[f"{one}.{level}"] for level in range(len(each))] for one, each in enumerate(sizes)]
        if all(
            texels.dtype == np.uint8 and texels.shape == size
            for picture, each in zip(found, sizes, strict=True) for texels, size in zip(picture, each, strict=True)
        ) and _are_drawn(found):  # fmt: skip
            return found
    return None


def keep_pictures(key: str, pictures: list[Picture], /) -> None:
    """Write what `kept_pictures` returns; a folder that cannot be written is reported once.

    Nothing is written where a driver has drawn nothing, as one without memory may: later runs would show no trees.
    """
    if not _are_drawn(pictures):
        return
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=QUICKLY) as archive:
        for one, levels in enumerate(pictures):
            for level, texels in enumerate(levels):
                with archive.open(f"{one}.{level}.npy", "w") as file:
                    np.lib.format.write_array(file, texels, allow_pickle=False)
    keep(key, SUFFIX, buffer.getvalue(), most=MOST)


def _are_drawn(pictures: list[Picture]) -> bool:
    """Return whether each picture covers something; optical depths, after each model's picture, are not asked."""
    shown = [*pictures[0][0][::2], *(levels[0] for levels in pictures[1::2])]
    return all(texels[..., 3].any() for texels in shown)


def sizes_of(sides: list[tuple[int, int]], /) -> list[list[tuple[int, int, int, int]]]:
    """Return the shapes of all pictures of a kind, at each mip level."""
    coarser = COARSER.bit_length() - 1
    each = [(2 * OF_TWIGS, CARD, CARD, range(LEVELS))]
    for wide, lines in sides:
        each += [(1, ROWS * lines, COLUMNS * wide, levels) for levels in (range(LEVELS), range(coarser, LEVELS))]
    return [
        [(layers, rows >> level, columns >> level, 4) for level in levels] for layers, rows, columns, levels in each
    ]
