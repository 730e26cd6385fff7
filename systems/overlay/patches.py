"""Patches' representations, and the progress of their transitions (paper, figure 5)."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Rows
from ..around.outlook import Outlook
from ..see import strips_kept
from ..show.registry import THREE
from ..site import Site
from ..transition import weights
from .marks import Marks, filled, on_ground, split, stroked, together
from .paint import ring_shades

FILL = 0.48
"""Opacity of a patch's square."""

INNER = 0.7
"""Opacity of the inner square for the finer representation."""

OUTLINED = 20.0
"""Distance up to which outlines of changing patches are bright [m]; farther away there are too many."""

GAP = 0.035
"""Width of the gap inside a patch's border, relative to the patch's side."""

SETTLED = 0.995
"""Weight from which on a patch counts as having only one representation."""


def shown_level(outlook: Outlook, site: Site, /) -> NDArray[np.int8]:
    """Return the representation that each patch is shown in, during a transition its own or next one, (rows,)."""
    weight = patch_weights(outlook, site)
    alone = weight.max(axis=0) >= SETTLED
    return np.where(alone, weight.argmax(axis=0), outlook.patches.representation).astype(np.int8)


def patch_colors(outlook: Outlook, site: Site, /) -> Floats:
    """Return the colour of each patch's representation, shape (rows, 3), in the shade of its ring.

    Shades are interpolated while the patch changes from one ring to another.
    """
    patches, shown = outlook.patches, shown_level(outlook, site)
    color = np.zeros((len(shown), 3), np.float32)
    for level, representation in enumerate(site.representations):
        shades = ring_shades(representation.color, representation.rings())
        rows = np.flatnonzero((shown == level) | (shown < 0))
        unseen, progress = ~patches.visible[rows], patches.sublevel_progress[level, rows, None]
        # An unseen patch keeps the sub-level in which it was last seen, if any; it is coloured by the one that is due.
        due = representation.sublevels(outlook, rows, np.full(len(rows), -1, np.int8), slack=0)
        now, before = (
            shades[np.maximum(representation.ring(np.where(unseen, due, sublevel[level, rows])), 0)]
            for sublevel in (patches.sublevel, patches.sublevel_before)
        )
        color[rows] = before + (now - before) * progress
    return color


def patch_weights(outlook: Outlook, site: Site, /) -> Floats:
    """Return the weights of representations on each patch, (representations, rows).

    They include the border where strips give way to the carpet.
    """
    weight, (_, strips, carpet) = weights(outlook.patches), THREE
    rows = np.arange(len(outlook.patches.progress))
    kept = strips_kept(outlook, rows, site.representations, patch=site.ground.patch)
    handed_over = weight[strips] * (1.0 - kept)
    weight[strips] -= handed_over
    weight[carpet] += handed_over
    return weight


def squares(cell: NDArray[np.int32], /, *, patch: float, scale: Floats | float = 1.0) -> Floats:
    """Return the corners (x, z) [m] of squares in the middle of cells (n, 2), in order around, shape (n, 4, 2).

    `scale` is their side relative to the patch's without its gap: one number, or (n,).
    """
    half = np.broadcast_to(np.asarray(scale, np.float32) * np.float32(0.5 - GAP), (len(cell),))
    corner = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], np.float32)
    middle = cell.astype(np.float32)[:, None] + np.float32(0.5)
    return np.asarray((middle + corner * half[:, None, None]) * np.float32(patch), np.float32)


def is_mixed(outlook: Outlook, site: Site, /) -> NDArray[np.bool_]:
    """Return whether each patch has two representations at once, shape (rows,)."""
    weight = patch_weights(outlook, site)
    return np.asarray((weight.max(axis=0) < SETTLED) & (weight.sum(axis=0) > 0.0))


def level_marks(outlook: Outlook, site: Site, /, *, settled: bool) -> Marks:
    """Return a square on each patch in view, in the colour of its representation.

    With `settled`, patches with two representations are left out.
    """
    shown = outlook.patches.shown
    rows = np.flatnonzero(shown & ~is_mixed(outlook, site) if settled else shown)
    return _filled_squares(outlook, site, rows, patch_colors(outlook, site)[rows], FILL)


def weight_marks(outlook: Outlook, site: Site, /) -> Marks:
    """Return squares on the patches in view with two representations, in the coarser one's colour.

    The area of an inner square is the finer one's weight. Changing patches are outlined; the others lie where strips
    give way to the carpet.
    """
    patches, weight = outlook.patches, patch_weights(outlook, site)
    rows = np.flatnonzero(patches.shown & is_mixed(outlook, site))
    is_present = weight[:, rows] > 1.0 - SETTLED
    finer, coarser = is_present.argmax(axis=0), len(is_present) - 1 - is_present[::-1].argmax(axis=0)
    scale = np.sqrt(weight[finer, rows] / weight[:, rows].sum(axis=0))
    shades = np.concatenate([ring_shades(each.color) for each in site.representations])
    changing = rows[patches.progress[rows] < 1.0]
    outlines = on_ground(site.ground.terrain, squares(patches.cell[changing], patch=site.ground.patch))
    distance = np.linalg.norm(outlines.mean(axis=1) - np.array(outlook.viewer.eye, np.float32), axis=1)
    bright = np.ones((len(changing), 4), np.float32)
    bright[:, 3] = 0.9 * np.minimum(1.0, OUTLINED / np.maximum(distance, 1e-3)) ** 2
    starts, ends = outlines.reshape(-1, 3), np.roll(outlines, -1, axis=1).reshape(-1, 3)
    return together(
        _filled_squares(outlook, site, rows, shades[coarser], FILL),
        _filled_squares(outlook, site, rows, shades[finer], INNER, scale=scale),
        stroked(starts, ends, np.repeat(bright, 4, axis=0), width=1.5),
    )


def _filled_squares(
    outlook: Outlook, site: Site, rows: Rows, color: Floats, opacity: float, *, scale: Floats | float = 1.0
) -> Marks:
    """Return filled squares on patches."""
    flat = squares(outlook.patches.cell[rows], patch=site.ground.patch, scale=scale)
    shown = np.column_stack([color, np.full(len(rows), opacity, np.float32)])
    return filled(split(on_ground(site.ground.terrain, flat)), np.repeat(shown, 2, axis=0)[:, None, :])
