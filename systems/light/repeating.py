"""What repeats over the terrain: a thin layer of clouds that drifts with the wind, and what lies on the ground."""

from collections.abc import Sequence
from functools import cache, lru_cache
from hashlib import blake2b
from importlib.resources import files
from itertools import pairwise

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...components.wind import WindPrimitive
from ...engine.gl.mipmaps import mipmapped_image
from ...engine.gl.rasteriser import anisotropy
from ...engine.kept import DIGEST, keep, kept
from ..grow.raster import Fragments, interpolate, rasterise, ribbon_triangles
from ..wind.blow import mean_wind

SIDE = 512
"""Texels along a side."""

LITTER_SIDE = 1.8
"""Side of the square of ground that repeats [m]."""

STRAWS = 2600
"""How many straws lie on it."""

TUFTS, LEAVES = 16, 16
"""Low tufts that stand on it, in rows of so many, each somewhere in its own small square; and leaves of each tuft."""

FINER_DRAWN = 2
"""How many times finer it is drawn: so edges are even, and what is thinner than a texel is faint."""

KEEL = 0.18
"""How much brighter one half of a low leaf is than the mean of both, which are folded along its middle."""

SHADED_BY, DARKER = 0.012, 3.0
"""Over which width what lies higher shades what is below [m]; and how fast light falls with how much higher it is, of
the height of the lowest leaves."""

LEAST_COVERED = 1e-6
"""Part of a texel that counts as covered at least."""

SEEN_FAR = 0.12
"""What is evened out of the ground's brightness [m]: seen from afar, larger spots would show that squares repeat."""

LEAST_SEEN = 600.0
"""What is evened out stays more than the exponential of minus this: less would be no number, and numpy might raise."""

LITTER_ONE = 128
"""The texel of ground that is as bright as the mean."""

_REMEMBERED = 4
"""Seeds whose maps are remembered, less than a megabyte each: a scene read again has the seed that it had."""

SUFFIX, MOST = ".ground", 24
"""What files are called that these maps are kept in, and of how many seeds."""

CLOUDS_SIDE = 2600.0
"""Side of the square that repeats [m]."""

BROADEST, FALLS, BROAD, FINEST = 5.0, 2.5, 8.0, 14.0
"""Waves of the broadest part of clouds on that; power of the waves by which finer parts are weaker; the waves from
which on there are none; and the same of heaps: what is finer, `billows` has."""

HEAPS, WEAKER = 8, 0.9
"""Heaps in a row; how high they are, of what they stand out from (Worley, A Cellular Texture Basis Function, 1996)."""

GLSL = {"CLOUDS_SIDE": CLOUDS_SIDE, "LITTER_SIDE": LITTER_SIDE, "LITTER_ONE": LITTER_ONE}

_DRAWN = FINER_DRAWN * SIDE, FINER_DRAWN * SIDE

FASTER = 1.5
"""How much faster clouds go than the waves of the breeze."""


def drifted(winds: Sequence[WindPrimitive], time: float, /) -> tuple[float, float]:
    """Return how far clouds have drifted with the mean wind at a time [s], along x and z, in sides from 0 to 1."""
    wind = mean_wind(winds)
    x, z = wind.velocity if wind else (0.0, 0.0)
    return FASTER * x * time / CLOUDS_SIDE % 1.0, FASTER * z * time / CLOUDS_SIDE % 1.0


def cloud_map(*, seed: int) -> NDArray[np.uint8]:
    """Return how dense clouds are over a square that repeats, shape (SIDE, SIDE): even from none to all, by rank.

    So of a map with values of [0, 1] just the part is above 1 - c that a scene wants to be in cloud.
    """
    random = np.random.default_rng([seed, 0x636C6F75])
    wave = np.fft.fftfreq(SIDE, 1.0 / SIDE)
    size = np.hypot(wave[:, None], wave[None])
    amplitude = np.where(size > 0.0, np.maximum(size, BROADEST) ** -FALLS, 0.0) * np.exp(-((size / BROAD) ** 2))
    spectrum = amplitude * np.exp(2j * np.pi * random.random((SIDE, SIDE)))
    broad = np.fft.ifft2(spectrum).real
    heaps = np.fft.ifft2(np.fft.fft2(_heaps(random)) * np.exp(-((size / FINEST) ** 2))).real
    field = broad / broad.std() + WEAKER * heaps / heaps.std()
    rank = np.empty(field.size)
    rank[np.argsort(field, axis=None, kind="stable")] = np.arange(field.size) / field.size
    return np.asarray(np.floor(rank * 256.0), np.uint8).reshape(SIDE, SIDE)


def _heaps(random: np.random.Generator) -> Floats:
    """Return how near each texel is to the next of points, one in each of the squares in a row: rounded heaps.

    It is 0 in a point, and falls by 1 for a square's side, shape (SIDE, SIDE); it repeats.
    """
    own, side = random.random((HEAPS, HEAPS, 2), np.float32), SIDE // HEAPS
    at = (np.arange(side, dtype=np.float32) + 0.5) / side
    nearest = np.full((HEAPS, side, HEAPS, side), np.inf, np.float32)
    for down in (-1, 0, 1):
        for right in (-1, 0, 1):
            off = np.roll(own, (-down, -right), (0, 1)) + np.array([down, right], np.float32)
            square = (off[..., None] - at) ** 2  # down, and to the right: squares, with the texels along a side of each
            np.minimum(nearest, square[:, :, 0].transpose(0, 2, 1)[..., None] + square[:, None, :, 1], out=nearest)
    return -np.sqrt(nearest.reshape(SIDE, SIDE))


def litter_map(*, seed: int) -> Doubles:
    """Return how bright the ground is over a square that repeats: straws lie across one another, shape (SIDE, SIDE)."""
    random = np.random.default_rng([seed, 0x6C697474])
    middle, turn = random.random((STRAWS, 2)) * SIDE, random.uniform(0.0, 2.0 * np.pi, STRAWS)
    along = np.stack([np.cos(turn), np.sin(turn)], axis=1) * random.uniform(10.0, 38.0, (STRAWS, 1))
    aside = np.stack([-np.sin(turn), np.cos(turn)], axis=1) * random.uniform(0.9, 2.2, (STRAWS, 1))
    bright = random.uniform(0.35, 1.0, STRAWS) ** 2 * (0.35 + 0.65 * random.random(STRAWS))
    left, right = (
        FINER_DRAWN * np.stack([middle - along + side, middle + along + side], axis=1) for side in (-aside, aside)
    )
    corners, front = ribbon_triangles(left, right), np.repeat(random.random(STRAWS), 2)[:, None].repeat(3, axis=1)
    seen = rasterise(corners, front, shape=_DRAWN, wrap=True)
    lit = np.full(_DRAWN, 0.12)
    lit.reshape(-1)[seen.sample] = bright[seen.triangle // 2]
    return _mean(lit * _open(_heights(seen, corners, front)))


def _heights(seen: Fragments, corners: Doubles, high: Doubles, /) -> Doubles:
    """Return how high what is seen lies, by the heights of triangles' corners (n, 3), 0 on the ground."""
    up = np.zeros(_DRAWN)
    up.reshape(-1)[seen.sample] = interpolate(corners, high, seen)
    return up


def _open(up: Doubles, /) -> Doubles:
    """Return how much light comes between what lies about to heights: the less, the deeper they lie below its mean."""
    return np.asarray(np.exp(-DARKER * np.maximum(_blurred(up, SHADED_BY / LITTER_SIDE) - up, 0.0)))


def _blurred(image: Doubles, width: float, /) -> Doubles:
    """Return a square that repeats evened out over a width, of its side."""
    side = len(image)
    down, right = (
        np.exp(-np.minimum(2.0 * (np.pi * width * wave) ** 2, 0.5 * LEAST_SEEN))
        for wave in (np.fft.fftfreq(side, 1.0 / side), np.fft.rfftfreq(side, 1.0 / side))
    )
    return np.asarray(np.fft.irfft2(np.fft.rfft2(image) * down[:, None] * right, image.shape))


def _mean(image: Doubles, /) -> Doubles:
    """Return the means of texels that are drawn finer, shape (SIDE, SIDE)."""
    return np.asarray(image.reshape(SIDE, FINER_DRAWN, SIDE, FINER_DRAWN).mean(axis=(1, 3)))


def understorey_map(*, seed: int) -> tuple[Doubles, Doubles]:
    """Return how bright low leaves are over the same square, and how much of it they cover, each of shape (SIDE, SIDE).

    They stand in tufts and arch over to all sides, seen from above; the deeper they are, the less light they have, and
    those above them shade them. Where there are none, they are as bright as in the mean.
    """
    random = np.random.default_rng([seed, 0x756E6472])
    count, along = TUFTS * TUFTS * LEAVES, np.linspace(0.0, 1.0, 7)
    texels = SIDE / LITTER_SIDE
    middle = (np.indices((TUFTS, TUFTS)).reshape(2, -1).T + random.random((TUFTS * TUFTS, 2))) * (SIDE / TUFTS)
    root = np.repeat(middle, LEAVES, axis=0) + random.normal(0.0, 0.006 * texels, (count, 2))
    size = np.repeat(random.uniform(0.6, 1.25, TUFTS * TUFTS), LEAVES) * texels
    length, width = size * random.uniform(0.07, 0.19, count), size * random.uniform(0.0035, 0.0085, count)
    heading = random.uniform(0.0, 2.0 * np.pi, (count, 1)) + random.normal(0.0, 0.7, (count, 1)) * along
    ahead = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    steps = ahead[:, 1:] * (length / (len(along) - 1))[:, None, None]
    spine = root[:, None] + np.pad(np.cumsum(steps, axis=1), ((0, 0), (1, 0), (0, 0)))
    half = width[:, None] * np.maximum(np.sin(np.pi * (0.18 + 0.82 * along)), 0.0) ** 0.8
    aside = np.stack([-ahead[..., 1], ahead[..., 0]], axis=-1) * half[..., None]
    own = (0.5 * random.random((count, 1)) + 0.6 * along * (1.0 - 0.35 * along))[..., None]
    edges = [FINER_DRAWN * (spine + part * aside) for part in (-1.0, 0.0, 1.0)]
    corners = np.concatenate([ribbon_triangles(*pair) for pair in pairwise(edges)])
    high = np.tile(ribbon_triangles(own, own)[..., 0], (2, 1))
    bright = random.uniform(0.75, 1.15, count) * (1.0 + KEEL * random.choice([-1.0, 1.0], count) * [[1.0], [-1.0]])
    seen = rasterise(corners, high, shape=_DRAWN, wrap=True)
    up, lit, covered = _heights(seen, corners, high), np.zeros(_DRAWN), np.zeros(_DRAWN)
    lit.reshape(-1)[seen.sample] = np.repeat(bright.reshape(-1), 2 * (len(along) - 1))[seen.triangle]
    covered.reshape(-1)[seen.sample] = 1.0
    lit *= (0.06 + 1.1 * up * up) * _open(up)
    part = _mean(covered)
    return np.asarray(np.where(part > 0.0, _mean(lit) / np.maximum(part, LEAST_COVERED), 0.0)), part


def ground_maps(*, seed: int) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Return what is seen of the ground over a square that repeats, each of shape (SIDE, SIDE).

    First the root of the radiance there, in units of 1 / `LITTER_ONE` of that of the mean: that of leaves where there
    are low ones, and that of the ground between. Then how much of it leaves cover, up to 255.
    """
    lit, (low, part) = litter_map(seed=seed), understorey_map(seed=seed)
    lit /= (lit * (1.0 - part)).sum() / (1.0 - part).sum()
    low /= (low * part).sum() / part.sum()
    bright = lit + (low - lit) * part
    bright /= _blurred(bright, SEEN_FAR / LITTER_SIDE)
    root = np.clip(np.rint(np.sqrt(bright) * LITTER_ONE), 0, 255)
    return np.asarray(root, np.uint8), np.asarray(np.rint(part * 255.0), np.uint8)


def repeating_texture(ctx: moderngl.Context, *, seed: int) -> moderngl.Texture:
    """Return `repeating_levels` as a texture that repeats; it is read anisotropically where that is at hand."""
    texture = mipmapped_image(ctx, repeating_levels(seed=seed))
    if anisotropy(ctx) > 1.0:
        texture.anisotropy = anisotropy(ctx)
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    return texture


@lru_cache(maxsize=_REMEMBERED)
def repeating_levels(*, seed: int) -> tuple[NDArray[np.uint8], ...]:
    """Return `cloud_map` and `ground_maps` as three channels, shapes (SIDE, SIDE, 3) and its halves down to one texel.

    The coarser are means of the finest: drivers that round up at each level would make ground brighter far off.
    """
    texels = _texels(seed)
    made, mean = [texels], texels.astype(np.float64)
    while len(mean) > 1:
        mean = 0.25 * (mean[::2, ::2] + mean[1::2, ::2] + mean[::2, 1::2] + mean[1::2, 1::2])
        made.append(np.rint(mean).astype(np.uint8))
    return tuple(made)


def _texels(seed: int) -> NDArray[np.uint8]:
    """Return the finest of the levels, from the disk where it was made before: it takes half a second."""
    shape = SIDE, SIDE, 3
    key = blake2b(f"{_version()} {seed}".encode(), digest_size=DIGEST // 2).hexdigest()
    told = kept(key + SUFFIX, key)
    if told is not None and len(told) == np.prod(shape):
        return np.frombuffer(told, np.uint8).reshape(shape)
    texels = np.stack([cloud_map(seed=seed), *ground_maps(seed=seed)], axis=-1)
    keep(key + SUFFIX, key, texels.tobytes(), most=MOST)
    return texels


@cache
def _version() -> str:
    """Return a hash of the code that makes them, so that nothing made by other code counts as its own."""
    digest = blake2b(np.__version__.encode(), digest_size=DIGEST // 2)
    for name in ("light/repeating.py", "grow/raster.py"):
        digest.update((files("tallgrass.systems") / name).read_bytes())
    return digest.hexdigest()
