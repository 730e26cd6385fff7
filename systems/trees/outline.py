"""The outline of a twig's card: less of it is drawn where it has no leaves (Persson, Graphics Gems for Games, 2009)."""

from itertools import combinations
from typing import NamedTuple

import numpy as np

from ...components.arrays import Bytes, Doubles, Mask
from .wood import SOLID

CORNERS = 4
"""Of an outline to either side, from its foot to its tip."""

ONE = 255.0
"""Coverage of a texel that is covered wholly."""

FAINTEST = 5
"""Coverage from which on a texel lies within it, of 255."""

AROUND = 5
"""Texels about what is covered that lie within it too: coarser pictures spread so far."""

TRIED = 14
"""Heights of corners that are tried, and how far out they may lie."""

ROWS = 80
"""Rows of texels that are looked at."""

CLOSE = 2
"""As many of a tree's pictures, as shaders add what coarser ones spread; and where those have been looked at."""

LEAST_WEIGHT = 1e-3
"""Weight of a corner in a row that it is moved for at least."""

ROUNDED = 0.06
"""What is drawn of a twig as solid hides at most so much more than it covers, of all that the twig covers: with leaves,
whose edges alone cover a texel in part, it is 0.02 to 0.055 from `SOLID` on."""

SWEEPS = 4
"""How often corners of a tree's pictures are moved in, one after another: more changes little."""

SIDES = 24
"""Directions that a side of a card's outline may face."""

BOX = np.array([(-1.0, 0.0), (1.0, 0.0), (-1.0, 1.0), (1.0, 1.0)])
"""The whole of a card."""

GLSL = {"OUTLINE": 2 * CORNERS, "CARD_CORNERS": len(BOX)}


class Around(NamedTuple):
    """Corners about what each of a tree's pictures shows, as shaders are told them: all lie at the same heights."""

    high: tuple[float, ...]
    """How high they are, -1 to 1, from foot to top."""

    reaches: list[tuple[float, ...]]
    """How far out they are [of half their height]: of each picture to the left, and then to the right."""


NOWHERE = Around((), [])
"""Those about nothing."""


def around(covers: Bytes, /) -> Around:
    """Return corners about what pictures (n, tall, wide) of a tree cover, with about as little area as they can have.

    Where several are mixed, the farthest of their corners lie about all of them, as the heights are the same.
    """
    count, tall, wide = covers.shape
    covered = covers > FAINTEST
    if not covered.any():
        return Around(tuple(np.linspace(-1.0, 1.0, CORNERS).tolist()), [(wide / tall,) * CORNERS] * (2 * count))
    rows, reach = _reaches(covered)
    least, best, found = np.inf, np.zeros(CORNERS), np.zeros((2 * count, CORNERS))
    for between in combinations(np.linspace(rows[0], rows[-1], TRIED)[1:-1].tolist(), CORNERS - 2):
        high = np.array([rows[0], *between, rows[-1]])
        lines = _drawn_in(rows, reach, high)
        area = float(((lines[:, 1:] + lines[:, :-1]) * np.diff(high)).sum())
        if area < least:
            least, best, found = area, high, lines
    return Around(tuple((2.0 * best / tall - 1.0).tolist()), _told(found, tall, wide))


def core(covers: Bytes, least: float, whole: Around, /) -> Around:
    """Return corners about what such pictures cover more than so much, as high as those about all that they show.

    The depth of what is drawn follows from the heights of corners.
    """
    _, tall, wide = covers.shape
    covered = covers > least
    if not covered.any():
        return NOWHERE
    lines = _drawn_in(*_reaches(covered), 0.5 * tall * (1.0 + np.array(whole.high)))
    return Around(whole.high, _told(lines, tall, wide))


def _told(lines: Doubles, tall: int, wide: int) -> list[tuple[float, ...]]:
    """Return lines [texels] of pictures as `reaches`."""
    return [tuple(each) for each in (np.minimum(lines, 0.5 * wide) / (0.5 * tall)).tolist()]


def _reaches(covered: Mask) -> tuple[Doubles, Doubles]:
    """Return edges of rows (m,) about what any picture covers, and how far out each goes there, (2 n, m) [texels].

    It goes to the left and the right of the middle, at least not at all.
    """
    (_, tall, wide), there = covered.shape, np.flatnonzero(covered.any(axis=(0, 2)))
    edges = np.unique(np.linspace(max(there[0] - CLOSE, 0), min(there[-1] + 1 + CLOSE, tall), ROWS).astype(np.intp))
    each = np.stack([covered[..., ::-1], covered], axis=1).reshape(-1, tall, wide)
    last = np.where(each.any(axis=2), wide - each[..., ::-1].argmax(axis=2) + CLOSE, 0)
    near = [slice(max(edge - 2 * CLOSE, 0), min(edge + 2 * CLOSE, tall)) for edge in edges]
    reach = np.stack([last[:, part].max(axis=1) for part in near], axis=1) - 0.5 * wide
    return edges.astype(np.float64), np.maximum(reach, 0.0)


def _drawn_in(rows: Doubles, reach: Doubles, high: Doubles) -> Doubles:
    """Return lines (n, CORNERS) over heights, nowhere within `reach` (n, m) of rows: corners are moved in in turn."""
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
    """Return where a picture (n, n) is covered more than so much at any of its sizes, read between texels, (n, n)."""
    side = len(covers[0])
    found = np.zeros((side, side), np.bool_)
    for cover in covers:
        at = ((np.arange(side) + 0.5) * len(cover) / side - 0.5).clip(0.0, len(cover) - 1.0)
        first = at.astype(np.intp)
        part, second = at - first, np.minimum(first + 1, len(cover) - 1)
        rows = cover[first] * (1.0 - part[:, None]) + cover[second] * part[:, None]
        found |= rows[:, first] * (1.0 - part) + rows[:, second] * part > least
    return found


def solid_above(cover: Bytes, /) -> float:
    """Return the coverage above which what a picture (n, n) of a twig shows is drawn as solid.

    Of needles, all of which are thinner than a texel, coverage is a mean: much would be rounded up from `SOLID` on.
    """
    each = np.sort(cover, axis=None)[::-1] / ONE
    solid = int(np.searchsorted(np.cumsum(1.0 - each), ROUNDED * each.sum(), side="right"))
    return SOLID if solid == each.size else max(SOLID, float(each[solid]))


def outline(covered: Mask, beyond: int = AROUND, /) -> Doubles:
    """Return four corners about what a picture (n, n) covers, as a strip of two triangles has them, shape (4, 2).

    They are across from -1 to 1, and up from 0 to 1, with about as little area as they can have, and so many texels
    beyond it. They may lie beyond the card.
    """
    side = len(covered)
    if not covered.any():
        return BOX
    corners = _quads(*_facing(covered, beyond))
    after = np.roll(corners, -1, axis=1)
    area = (corners[..., 0] * after[..., 1] - corners[..., 1] * after[..., 0]).sum(axis=1)
    least = corners[area.argmin()][[0, 1, 3, 2]] / side
    return np.asarray(least * (2.0, 1.0) - (1.0, 0.0))


def pairs(corners: Doubles, /) -> list[tuple[float, float]]:
    """Return corners as shaders are told them."""
    return [(x, y) for x, y in corners.tolist()]


def _facing(covered: Mask, beyond: int) -> tuple[Doubles, Doubles]:
    """Return directions (n, 2), and how far on in each what is covered goes (n,) [texels]."""
    angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
    to = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rows = np.flatnonzero(covered.any(axis=1))
    there = covered[rows]
    left, right = there.argmax(axis=1), there.shape[1] - there[:, ::-1].argmax(axis=1)
    ends = [np.stack([across, rows + up], axis=1) for across in (left, right) for up in (0, 1)]
    return to, (np.concatenate(ends) @ to.T).max(axis=0) + beyond


def _quads(to: Doubles, reach: Doubles) -> Doubles:
    """Return the corners (n, 4, 2) of all quads whose sides face four of such directions, each as far on."""
    sides = np.array(list(combinations(range(SIDES), len(BOX))))
    turn = np.diff(sides, axis=1, append=sides[:, :1] + SIDES)
    sides = sides[(2 * turn < SIDES).all(axis=1)]  # others do not meet
    (one, other), (a, b) = ([each[some] for some in (sides, np.roll(sides, -1, axis=1))] for each in (to, reach))
    (ax, ay), (bx, by) = np.moveaxis(one, -1, 0), np.moveaxis(other, -1, 0)
    return np.asarray(np.stack([a * by - b * ay, b * ax - a * bx], axis=-1) / (ax * by - ay * bx)[..., None])
