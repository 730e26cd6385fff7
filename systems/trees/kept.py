"""Pictures of trees, cached on disk under a hash of everything that they depend on."""

from io import BytesIO
from itertools import groupby
from zlib import compress, decompress

import numpy as np

from ...components.arrays import Bytes
from ...engine.kept import MEGABYTE, code_hash, keep, kept, key_of
from ...engine.zipped import zipped

SUFFIX = ".trees"

CODE = "systems/trees", "engine/shaders/lib"
"""Sources that grow and draw trees."""

ROOM = 512 * MEGABYTE
"""Room for files in a folder [bytes], one a kind of tree, of 4 to 10 MB each."""

QUICKLY = 1
"""Compression level: a fifth of the usual time, for files a tenth larger."""

Picture = list[Bytes]
"""Layers (n, rows, columns, 4) at each mip level, the finest first."""


def kind_key(habit: str, seed: int, renderer: str, /) -> str:
    """Return the cache key of a kind's pictures on a graphics card; colours are not in it."""
    return key_of({"code": code_hash(*CODE), "habit": habit, "seed": seed, "renderer": renderer})


def kept_pictures(key: str, /) -> list[Picture] | None:
    """Return a twig's pictures and those of its kind's models from the cache; None where there are none.

    A model has two, as `tree_levels` returns them.
    """
    data = kept(key, SUFFIX)
    if data is None:
        return None
    with np.load(BytesIO(decompress(data)), allow_pickle=False) as file:
        pictures = groupby(file.files, lambda name: name.partition(".")[0])
        return [[file[name] for name in levels] for _, levels in pictures]


def keep_pictures(key: str, pictures: list[Picture], /) -> None:
    """Write what `kept_pictures` returns; a folder that cannot be written is reported once.

    Nothing is written where a driver has drawn nothing, as one without memory may: later runs would show no trees.
    Optical depths, after each model's picture, may be nothing.
    """
    shown = [*pictures[0][0][::2], *(levels[0] for levels in pictures[1::2])]
    if not all(texels[..., 3].any() for texels in shown):
        return
    levels = {f"{one}.{level}": texels for one, each in enumerate(pictures) for level, texels in enumerate(each)}
    keep(key, SUFFIX, compress(zipped(levels), QUICKLY), room=ROOM)
