"""Maps that repeat over the terrain: the density of clouds, and litter and low leaves on the ground."""

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise, product

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...components.wind import WindPrimitive
from ...engine.gl.mipmaps import mipmapped_image
from ...engine.gl.rasteriser import anisotropy
from ...engine.kept import MEGABYTE, code_hash, keep, kept, key_of
from ..grow.raster import Fragments, along_ribbons, interpolate, rasterise, ribbon_triangles
from ..wind.blow import mean_wind

SIDE = 512
"""Texels along a side of each map."""

LITTER_SIDE = 1.8
"""Side of the square of ground that repeats [m]."""

CODE = "systems/light/repeating.py", "systems/grow/raster.py"
"""Sources that make the maps."""

STRAWS = 2600
"""Number of straws on that square."""

TUFTS, LEAVES = 16, 16
"""Low tufts along a side of that square, each jittered within its cell; leaves of each tuft."""

SUPERSAMPLED = 2
"""Supersampling factor of the ground maps: it smooths edges, and leaves thinner than a texel become faint."""

KEEL = 0.18
"""Brightness difference of each half of a low leaf from the mean of both: the leaf is folded along its middle."""

SHADE_WIDTH, SHADE_DEPTH = 0.012, 3.0
"""Blur width of the heights that cause self-shadowing [m]; and the optical depth per unit of height below the blurred
heights, in heights of the lowest leaves."""

LEAST_COVERAGE = 1e-6
"""Smallest coverage of a texel to divide by."""

EVENED_WIDTH = 0.12
"""Blur width of the brightness that is divided out [m]: larger spots would show the repetition from afar."""

MOST_EXPONENT = 600.0
"""Largest exponent of a blur's attenuation: a larger one would underflow, and numpy might raise."""

LITTER_ONE = 128
"""Texel value of ground of mean brightness."""

CACHED_SEEDS = 4
"""Number of seeds whose maps stay in memory, less than a megabyte each: a scene read again often has the same seed."""

SUFFIX, ROOM = ".ground", 24 * MEGABYTE
"""Suffix of cache files, one per seed, and room for them: each has less than a megabyte [bytes]."""

CLOUDS_SIDE = 2600.0
"""Side of the cloud map's square [m]."""

BROADEST_WAVE, FALL_OFF, BROAD_CUT = 5.0, 2.5, 8.0
"""Wave number of the broadest clouds [1 / side]; exponent by which amplitude falls with wave number; cut-off wave
number of broad clouds."""

HEAPS, HEAPS_AMPLITUDE, HEAPS_OCTAVES, HEAPS_CUT = 8, 0.9, 4, 2.5
"""Heaps along a side; their amplitude relative to the broad clouds; number of octaves; and their cut-off wave number
[1 / heap] (Worley, A Cellular Texture Basis Function, 1996).

In each octave heaps are half as wide and half as high as in the octave before: outlines of clouds are alike at all
sizes (Lovejoy, Area-Perimeter Relation for Rain and Cloud Areas, 1982). Finer detail comes from `billows`."""

GLSL = {"CLOUDS_SIDE": CLOUDS_SIDE, "LITTER_SIDE": LITTER_SIDE, "LITTER_ONE": LITTER_ONE}

_FINE_SHAPE = SUPERSAMPLED * SIDE, SUPERSAMPLED * SIDE

FASTER = 1.5
"""Speed of clouds relative to the waves of the breeze."""


def drifted(winds: Sequence[WindPrimitive], time: float, /) -> tuple[float, float]:
    """Return the drift of clouds in the mean wind at a time [s], along x and z, in sides of their square, modulo 1."""
    wind = mean_wind(winds)
    x, z = wind.velocity if wind else (0.0, 0.0)
    return FASTER * x * time / CLOUDS_SIDE % 1.0, FASTER * z * time / CLOUDS_SIDE % 1.0


def cloud_map(*, seed: int) -> NDArray[np.uint8]:
    """Return the tileable density of clouds, shape (SIDE, SIDE), equalised by rank: values are uniform.

    So exactly the fraction c of the map lies above 1 - c, where a scene asks for a cover of c.
    """
    random = np.random.default_rng([seed, 0x636C6F75])
    wave = np.fft.fftfreq(SIDE, 1.0 / SIDE)
    wave_number = np.hypot(wave[:, None], wave[None])
    amplitude = np.where(wave_number > 0.0, np.maximum(wave_number, BROADEST_WAVE) ** -FALL_OFF, 0.0)
    amplitude *= np.exp(-((wave_number / BROAD_CUT) ** 2))
    spectrum = amplitude * np.exp(2j * np.pi * random.random((SIDE, SIDE)))
    broad = np.fft.ifft2(spectrum).real
    field = broad / broad.std()
    for octave in range(HEAPS_OCTAVES):
        finer = 2**octave
        points = random.random((HEAPS * finer, HEAPS * finer, 2), np.float32).transpose(2, 0, 1)
        cut = np.exp(-((wave_number / (HEAPS_CUT * HEAPS * finer)) ** 2))
        heaped = np.fft.ifft2(np.fft.fft2(heaps(points, SIDE)) * cut).real
        field += HEAPS_AMPLITUDE / finer * heaped / heaped.std()
    rank = np.empty(field.size)
    rank[np.argsort(field, axis=None, kind="stable")] = np.arange(field.size) / field.size
    return np.asarray(np.floor(rank * 256.0), np.uint8).reshape(SIDE, SIDE)


def heaps(points: Floats, side: int, /) -> Floats:
    """Return inverted Worley noise, tileable, shape (side,) * d: minus the squared distance to the nearest point.

    So heaps are round, with creases between them. The unit is a cell; `points` has one in each of n**d cells, at a part
    of the cell's sides, shape (d, n, ..., n).
    """
    axes, count = range(len(points)), points.shape[1]
    middles = (np.arange(side // count, dtype=np.float32) + 0.5) / (side // count)
    nearest = np.full((count, side // count) * len(axes), np.inf, np.float32)
    for cell in product((-1, 0, 1), repeat=len(axes)):
        moved = np.roll(points, tuple(-each for each in cell), tuple(axis + 1 for axis in axes))
        squared: Floats = np.zeros((), np.float32)
        for axis in axes:
            apart = ((moved[axis] + np.float32(cell[axis]))[..., None] - middles) ** 2
            others = tuple(2 * each + 1 for each in axes if each != axis)
            squared = squared + np.expand_dims(np.moveaxis(apart, -1, axis + 1), others)
        np.minimum(nearest, squared, out=nearest)
    return -nearest.reshape((side,) * len(axes))


def litter_map(*, seed: int) -> Doubles:
    """Return the tileable brightness of ground with straws lying across one another, shape (SIDE, SIDE)."""
    random = np.random.default_rng([seed, 0x6C697474])
    middle, turn = random.random((STRAWS, 2)) * SIDE, random.uniform(0.0, 2.0 * np.pi, STRAWS)
    along = np.stack([np.cos(turn), np.sin(turn)], axis=1) * random.uniform(10.0, 38.0, (STRAWS, 1))
    aside = np.stack([-np.sin(turn), np.cos(turn)], axis=1) * random.uniform(0.9, 2.2, (STRAWS, 1))
    bright = random.uniform(0.35, 1.0, STRAWS) ** 2 * (0.35 + 0.65 * random.random(STRAWS))
    left, right = (
        SUPERSAMPLED * np.stack([middle - along + side, middle + along + side], axis=1) for side in (-aside, aside)
    )
    corners, heights = ribbon_triangles(left, right), np.repeat(random.random(STRAWS), 2)[:, None].repeat(3, axis=1)
    fragments = rasterise(corners, heights, shape=_FINE_SHAPE, wrap=True)
    image = np.full(_FINE_SHAPE, 0.12)
    image.reshape(-1)[fragments.sample] = bright[fragments.triangle // 2]
    return _downsampled(image * _transmittance(_height_map(fragments, corners, heights)))


def _height_map(fragments: Fragments, corners: Doubles, heights: Doubles, /) -> Doubles:
    """Return a height map of rasterised triangles from the heights of their corners (n, 3); bare ground is 0."""
    height_map = np.zeros(_FINE_SHAPE)
    height_map.reshape(-1)[fragments.sample] = interpolate(corners, heights, fragments)
    return height_map


def _transmittance(heights: Doubles, /) -> Doubles:
    """Return the transmittance at each texel of a height map: the less, the deeper it lies below the blurred map."""
    return np.asarray(np.exp(-SHADE_DEPTH * np.maximum(_blurred(heights, SHADE_WIDTH / LITTER_SIDE) - heights, 0.0)))


def _blurred(image: Doubles, width: float, /) -> Doubles:
    """Return a tileable image, blurred by a Gaussian of a width, relative to its side."""
    side = len(image)
    down, right = (
        np.exp(-np.minimum(2.0 * (np.pi * width * wave) ** 2, 0.5 * MOST_EXPONENT))
        for wave in (np.fft.fftfreq(side, 1.0 / side), np.fft.rfftfreq(side, 1.0 / side))
    )
    return np.asarray(np.fft.irfft2(np.fft.rfft2(image) * down[:, None] * right, image.shape))


def _downsampled(image: Doubles, /) -> Doubles:
    """Return a supersampled image, averaged to shape (SIDE, SIDE)."""
    return np.asarray(image.reshape(SIDE, SUPERSAMPLED, SIDE, SUPERSAMPLED).mean(axis=(1, 3)))


def understorey_map(*, seed: int) -> tuple[Doubles, Doubles]:
    """Return brightness and coverage of low leaves on the litter's square, seen from above, each (SIDE, SIDE).

    They stand in tufts and arch over to all sides. Deeper leaves get less light and are shaded by those above. Where
    the coverage is 0, the brightness is 0.
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
    height = 0.5 * random.random((count, 1)) + 0.6 * along * (1.0 - 0.35 * along)
    lines = [SUPERSAMPLED * (spine + part * aside) for part in (-1.0, 0.0, 1.0)]
    corners = np.concatenate([ribbon_triangles(*pair) for pair in pairwise(lines)])
    heights = np.tile(along_ribbons(height), (2, 1))
    bright = random.uniform(0.75, 1.15, count) * (1.0 + KEEL * random.choice([-1.0, 1.0], count) * [[1.0], [-1.0]])
    fragments = rasterise(corners, heights, shape=_FINE_SHAPE, wrap=True)
    height_map, lit, mask = _height_map(fragments, corners, heights), np.zeros(_FINE_SHAPE), np.zeros(_FINE_SHAPE)
    lit.reshape(-1)[fragments.sample] = np.repeat(bright.reshape(-1), 2 * (len(along) - 1))[fragments.triangle]
    mask.reshape(-1)[fragments.sample] = 1.0
    lit *= (0.06 + 1.1 * height_map * height_map) * _transmittance(height_map)
    coverage = _downsampled(mask)
    return np.asarray(np.where(coverage > 0.0, _downsampled(lit) / np.maximum(coverage, LEAST_COVERAGE), 0.0)), coverage


def ground_maps(*, seed: int) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Return two tileable maps of the ground, each of shape (SIDE, SIDE).

    The first is the root of the radiance of low leaves and of the ground between them, each relative to its mean, where
    `LITTER_ONE` is 1. The second is the leaves' coverage; 255 is full.
    """
    litter, (leaves, coverage) = litter_map(seed=seed), understorey_map(seed=seed)
    litter /= (litter * (1.0 - coverage)).sum() / (1.0 - coverage).sum()
    leaves /= (leaves * coverage).sum() / coverage.sum()
    radiance = litter + (leaves - litter) * coverage
    radiance /= _blurred(radiance, EVENED_WIDTH / LITTER_SIDE)
    texels = np.clip(np.rint(np.sqrt(radiance) * LITTER_ONE), 0, 255)
    return np.asarray(texels, np.uint8), np.asarray(np.rint(coverage * 255.0), np.uint8)


def repeating_texture(ctx: moderngl.Context, *, seed: int) -> moderngl.Texture:
    """Return `repeating_levels` as a repeating texture, with anisotropic filtering where it is available."""
    texture = mipmapped_image(ctx, repeating_levels(seed=seed))
    if anisotropy(ctx) > 1.0:
        texture.anisotropy = anisotropy(ctx)
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    return texture


@lru_cache(maxsize=CACHED_SEEDS)
def repeating_levels(*, seed: int) -> tuple[NDArray[np.uint8], ...]:
    """Return the mip levels of `cloud_map` and `ground_maps` as three channels, shapes (SIDE, SIDE, 3) to (1, 1, 3).

    Coarser levels are means of the finest one: drivers that round up at each level would make distant ground brighter.
    The finest comes from the cache where possible: making it takes half a second.
    """
    key = key_of({"code": code_hash(*CODE), "seed": seed})
    cached = kept(key, SUFFIX)
    if cached is None:
        texels = np.stack([cloud_map(seed=seed), *ground_maps(seed=seed)], axis=-1)
        keep(key, SUFFIX, texels.tobytes(), room=ROOM)
    else:
        texels = np.frombuffer(cached, np.uint8).reshape(SIDE, SIDE, 3)
    levels, mean = [texels], texels.astype(np.float64)
    while len(mean) > 1:
        mean = 0.25 * (mean[::2, ::2] + mean[1::2, ::2] + mean[::2, 1::2] + mean[1::2, 1::2])
        levels.append(np.rint(mean).astype(np.uint8))
    return tuple(levels)
