"""The chart: the patches around the viewer from above, with the view cone and the winds' masks (paper, figure 5)."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ..around.outlook import Outlook
from ..site import Site
from .marks import Marks, filled, split, stroked, together
from .masks import Masked
from .paint import BRIGHT, DARK, ring_shades
from .patches import GAP, SETTLED, patch_colors, patch_weights, squares

BEYOND = 6
"""Number of patches that the chart shows beyond the last strips."""

CULLED = 0.3
"""Opacity of patches outside the view cone."""

WHOLE = 1.0 / (1.0 - 2.0 * GAP)
"""Relative side of a patch's square without a gap."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """A square of the picture that shows the ground from above, with -z up."""

    left: float
    """Left edge [pixels]."""

    bottom: float
    """Lower edge, from the picture's lower edge [pixels]."""

    side: float
    """Side [pixels]."""

    middle: tuple[float, float]
    """Ground position (x, z) at its middle [m]."""

    reach: float
    """Distance on the ground from the middle to the edges [m]."""

    def place(self, ground: Floats, /) -> Floats:
        """Convert ground positions (..., 2) [m] to points (..., 3) in pixels from the picture's lower left."""
        part = (ground - np.array(self.middle, np.float32)) * np.float32(0.5 / self.reach)
        x, y = self.left + (part[..., 0] + 0.5) * self.side, self.bottom + (0.5 - part[..., 1]) * self.side
        return np.stack([x, y, np.zeros_like(x)], axis=-1).astype(np.float32)

    @property
    def limits(self) -> tuple[Floats, Floats]:
        """Smallest and largest ground position (x, z) on it [m]."""
        middle = np.array(self.middle, np.float32)
        return middle - np.float32(self.reach), middle + np.float32(self.reach)

    def holds(self, ground: Floats, /) -> NDArray[np.bool_]:
        """Return whether all points of polygons (n, k, 2) lie on it, shape (n,)."""
        low, high = self.limits
        return np.asarray(((ground >= low) & (ground <= high)).all(axis=(1, 2)))


def sheet_for(outlook: Outlook, site: Site, /, *, left: float, bottom: float, side: float) -> Sheet:
    """Return the sheet around the viewer that shows all strips and some carpet."""
    x, _, z = outlook.viewer.eye
    patches = min(outlook.patches.side // 2, site.reach[-2] + BEYOND)
    return Sheet(left, bottom, side, (x, z), patches * site.ground.patch)


def chart(outlook: Outlook, site: Site, masks: Sequence[Masked], sheet: Sheet, /) -> Marks:
    """Return the chart: patches by representation, dimmed where culled; masks, view cone and viewer."""
    x, z = sheet.middle
    frame = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], np.float32) * np.float32(sheet.reach) + np.array([x, z])
    border = sheet.place(frame.astype(np.float32))
    return together(
        filled(split(border[None]), (*DARK, 0.85)),
        _patches(outlook, site, sheet),
        *(_outline(mask, sheet) for mask in masks),
        stroked(border, np.roll(border, -1, axis=0), (*BRIGHT, 0.7), width=1.2),
        _viewer(outlook.viewer.cone, sheet),
    )


def _patches(outlook: Outlook, site: Site, sheet: Sheet) -> Marks:
    """Return the squares of patches, clipped to the sheet; colours of patches in a transition are mixed by weight."""
    patches = outlook.patches
    corners, low, high = squares(patches.cell, patch=site.ground.patch, scale=WHOLE), *sheet.limits
    rows = np.flatnonzero(patches.alive & (corners[:, 2] > low).all(axis=1) & (corners[:, 0] < high).all(axis=1))
    shades = np.concatenate([ring_shades(each.color) for each in site.representations])
    weight = patch_weights(outlook, site)[:, rows]
    changing = weight.max(axis=0) < SETTLED
    color = np.ones((len(rows), 4), np.float32)
    color[:, :3] = np.where(changing[:, None], weight.T @ shades, patch_colors(outlook, site)[rows])
    color[:, 3] = np.where(patches.visible[rows], 0.9, CULLED)
    return filled(split(sheet.place(np.clip(corners[rows], low, high))), np.repeat(color, 2, axis=0)[:, None, :])


def _outline(mask: Masked, sheet: Sheet) -> Marks:
    """Return the part of a mask's outline that lies on the sheet."""
    inside = sheet.holds(mask.edge)
    a, b = sheet.place(mask.edge[inside, 0]), sheet.place(mask.edge[inside, 1])
    return together(
        stroked(a, b, (*DARK, 0.6 * mask.strength), width=3.6), stroked(a, b, (*mask.color, mask.strength), width=1.8)
    )


def _viewer(cone: tuple[float, float], sheet: Sheet) -> Marks:
    """Return the view cone from the middle to the edges, and the viewer as an arrowhead."""
    middle, half = cone
    centre = np.array([sheet.left + sheet.side / 2, sheet.bottom + sheet.side / 2, 0.0], np.float32)

    def ray(azimuth: float) -> Floats:
        return np.array([sin(azimuth), cos(azimuth), 0.0], np.float32)

    size = np.float32(0.035 * sheet.side)
    tip = centre + size * np.stack([ray(middle), ray(middle + 2.5), ray(middle - 2.5)])
    marks = [filled(tip[None], (*BRIGHT, 1.0)), stroked(tip, np.roll(tip, 1, axis=0), (*DARK, 1.0), width=1.2)]
    if half < pi:
        sides = [ray(middle - half), ray(middle + half)]
        ends = np.stack([centre + side * (0.5 * sheet.side / np.abs(side).max()) for side in sides])
        starts = np.stack([centre, centre])
        marks.insert(0, stroked(starts, ends.astype(np.float32), (*BRIGHT, 0.95), width=1.6))
    return together(*marks)
