"""Outlines of cards and pictures: less is drawn where they are empty (Persson, Graphics Gems for Games, 2009)."""

from itertools import combinations
from typing import NamedTuple

import numpy as np

from ...components.arrays import Bytes, Doubles, Mask
from .wood import SOLID

CORNERS = 4
"""Number of corners of an outline on either side, from foot to tip."""

FULL = 255.0
"""Value of a texel with a coverage of 1."""

FAINTEST = 5
"""Least coverage within an outline, of 255."""

MARGIN = 5
"""Margin of an outline [texels]: coarser mip levels spread so far."""

TRIED_HEIGHTS = 14
"""Number of heights that are tried for an outline's corners."""

ROWS = 80
"""Number of rows of texels that are sampled."""

CLOSE_MARGIN = 2
"""Margin of an outline that shaders widen themselves, as of a tree's pictures; margin of a sampled row [texels]."""

LEAST_WEIGHT = 1e-3
"""Least weight of a corner in a row for the row to move it."""

ROUNDED_UP = 0.06
"""Greatest coverage gained by drawing a twig's texels as opaque, of all that it covers: with leaves, whose edges alone
cover a texel in part, it is 0.02 to 0.055 from `SOLID` on."""

SWEEPS = 4
"""Number of passes that tighten corners one after another: more change little."""

SIDES = 24
"""Number of directions that a side of a card's outline may face."""

TRIANGLE = 3
"""Number of corners of a small card's outline: its triangles cost more than their area."""

BOX = np.array([(-1.0, 0.0), (1.0, 0.0), (-1.0, 1.0), (1.0, 1.0)])
"""The outline of a whole card."""

GLSL = {"OUTLINE": 2 * CORNERS, "CARD_CORNERS": len(BOX)}


class Outline(NamedTuple):
    """Corners of the outlines of a tree's pictures, all at the same heights."""

    high: tuple[float, ...]
    """Heights of the corners, -1 to 1, from foot to top."""

    reaches: list[tuple[float, ...]]
    """Distance of the corners from the middle [half the height]: of each picture to the left, then to the right."""


NOWHERE = Outline((), [])
"""The outline of nothing."""


def picture_outline(covers: Bytes, /) -> Outline:
    """Return outlines of a tree's pictures (n, tall, wide), of about the least area.

    Where several are mixed, the farthest of their corners enclose all, as the heights are the same.
    """
    count, tall, wide = covers.shape
    covered = covers > FAINTEST
    if not covered.any():
        return Outline(tuple(np.linspace(-1.0, 1.0, CORNERS).tolist()), [(wide / tall,) * CORNERS] * (2 * count))
    rows, reach = _reaches(covered)
    least, best, found = np.inf, np.zeros(CORNERS), np.zeros((2 * count, CORNERS))
    for between in combinations(np.linspace(rows[0], rows[-1], TRIED_HEIGHTS)[1:-1].tolist(), CORNERS - 2):
        high = np.array([rows[0], *between, rows[-1]])
        lines = _tightened(rows, reach, high)
        area = float(((lines[:, 1:] + lines[:, :-1]) * np.diff(high)).sum())
        if area < least:
            least, best, found = area, high, lines
    return Outline(tuple((2.0 * best / tall - 1.0).tolist()), _reach_list(found, tall, wide))


def solid_outline(covers: Bytes, least: float, full: Outline, /) -> Outline:
    """Return outlines of texels above a coverage, with corners at the heights of the `full` outlines.

    The drawn depth is interpolated between corners, so both outlines need the same heights.
    """
    _, tall, wide = covers.shape
    covered = covers > least
    if not covered.any():
        return NOWHERE
    lines = _tightened(*_reaches(covered), 0.5 * tall * (1.0 + np.array(full.high)))
    return Outline(full.high, _reach_list(lines, tall, wide))


def _reach_list(lines: Doubles, tall: int, wide: int) -> list[tuple[float, ...]]:
    """Return lines (2 n, CORNERS) [texels] as `Outline.reaches`."""
    return [tuple(each) for each in (np.minimum(lines, 0.5 * wide) / (0.5 * tall)).tolist()]


def _reaches(covered: Mask) -> tuple[Doubles, Doubles]:
    """Return edges of rows (m,) and the reach of what is covered there, (2 n, m) [texels].

    Reaches are to the left and to the right of the middle, at least 0.
    """
    (_, tall, wide), filled = covered.shape, np.flatnonzero(covered.any(axis=(0, 2)))
    edges = np.unique(
        np.linspace(max(filled[0] - CLOSE_MARGIN, 0), min(filled[-1] + 1 + CLOSE_MARGIN, tall), ROWS).astype(np.intp)
    )
    each = np.stack([covered[..., ::-1], covered], axis=1).reshape(-1, tall, wide)
    last = np.where(each.any(axis=2), wide - each[..., ::-1].argmax(axis=2) + CLOSE_MARGIN, 0)
    near = [slice(max(edge - 2 * CLOSE_MARGIN, 0), min(edge + 2 * CLOSE_MARGIN, tall)) for edge in edges]
    reach = np.stack([last[:, part].max(axis=1) for part in near], axis=1) - 0.5 * wide
    return edges.astype(np.float64), np.maximum(reach, 0.0)


def _tightened(rows: Doubles, reach: Doubles, high: Doubles) -> Doubles:
    """Return lines (n, CORNERS) that stay outside `reach` (n, m), by moving corners in one after another."""
    part = np.clip(np.searchsorted(high, rows, side="right") - 1, 0, CORNERS - 2)
    share = (rows - high[part]) / np.diff(high)[part]
    lines = np.repeat(reach.max(axis=1, keepdims=True), CORNERS, axis=1)
    for corner in SWEEPS * (*range(CORNERS),):
        needed = np.zeros(len(reach))
        for piece, weight, other in (corner, 1.0 - share, corner + 1), (corner - 1, share, corner - 1):
            own = (part == piece) & (weight > LEAST_WEIGHT)
            if own.any():
                beside = lines[:, other, None] * (1.0 - weight[own])
                needed = np.maximum(needed, ((reach[:, own] - beside) / weight[own]).max(axis=1))
        lines[:, corner] = np.minimum(lines[:, corner], needed)
    return lines


def covered_at(covers: list[Bytes], least: float, /) -> Mask:
    """Return where a picture (n, n) is above a coverage at any of its mip levels, interpolated, (n, n)."""
    side = len(covers[0])
    found = np.zeros((side, side), np.bool_)
    for cover in covers:
        position = ((np.arange(side) + 0.5) * len(cover) / side - 0.5).clip(0.0, len(cover) - 1.0)
        first = position.astype(np.intp)
        part, second = position - first, np.minimum(first + 1, len(cover) - 1)
        rows = cover[first] * (1.0 - part[:, None]) + cover[second] * part[:, None]
        found |= rows[:, first] * (1.0 - part) + rows[:, second] * part > least
    return found


def solid_above(cover: Bytes, /) -> float:
    """Return the coverage above which texels of a twig's picture (n, n) are drawn as opaque.

    Needles are thinner than a texel, so their coverage is a mean: from `SOLID` on, much would be rounded up.
    """
    each = np.sort(cover, axis=None)[::-1] / FULL
    solid = int(np.searchsorted(np.cumsum(1.0 - each), ROUNDED_UP * each.sum(), side="right"))
    return SOLID if solid == each.size else max(SOLID, float(each[solid]))


def card_outline(covered: Mask, margin: int, /, *, corners: int) -> Doubles:
    """Return three or four corners about what a picture (n, n) covers, as a strip of triangles, shape (corners, 2).

    They are across from -1 to 1 and up from 0 to 1, of about the least area, with a margin [texels]. They may lie
    beyond the card.
    """
    side = len(covered)
    if not covered.any():
        return BOX[:corners]
    found = _polygons(*_support(covered, margin), corners)
    after = np.roll(found, -1, axis=1)
    area = (found[..., 0] * after[..., 1] - found[..., 1] * after[..., 0]).sum(axis=1)
    least = found[area.argmin()][[0, 1, -1, 2][:corners]] / side
    return np.asarray(least * (2.0, 1.0) - (1.0, 0.0))


def corner_list(corners: Doubles, /) -> list[tuple[float, float]]:
    """Return corners as uniforms."""
    return [(x, y) for x, y in corners.tolist()]


def _support(covered: Mask, margin: int) -> tuple[Doubles, Doubles]:
    """Return directions (n, 2), and the farthest extent of what is covered in each (n,) [texels]."""
    angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
    to = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rows = np.flatnonzero(covered.any(axis=1))
    filled = covered[rows]
    left, right = filled.argmax(axis=1), filled.shape[1] - filled[:, ::-1].argmax(axis=1)
    ends = [np.stack([across, rows + up], axis=1) for across in (left, right) for up in (0, 1)]
    return to, (np.concatenate(ends) @ to.T).max(axis=0) + margin


def _polygons(to: Doubles, reach: Doubles, corners: int) -> Doubles:
    """Return the corners (n, corners, 2) of all polygons whose sides face these directions at these extents."""
    sides = np.array(list(combinations(range(SIDES), corners)))
    turn = np.diff(sides, axis=1, append=sides[:, :1] + SIDES)
    sides = sides[(2 * turn < SIDES).all(axis=1)]  # other sides do not meet
    (side, next_side), (a, b) = (
        [each[chosen] for chosen in (sides, np.roll(sides, -1, axis=1))] for each in (to, reach)
    )
    (ax, ay), (bx, by) = np.moveaxis(side, -1, 0), np.moveaxis(next_side, -1, 0)
    return np.asarray(np.stack([a * by - b * ay, b * ax - a * bx], axis=-1) / (ax * by - ay * bx)[..., None])
