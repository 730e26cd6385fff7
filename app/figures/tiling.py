"""The tiling from above: which patches are drawn, and in which representation (figure 5)."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon

from ...engine.camera import ahead
from ...systems.around.outlook import Outlook
from ...systems.overlay.patches import patch_colors
from ...systems.site import Site
from ..studio.studio import Studio
from ..studio.take import Take
from .figure import Detail, PaperFigure
from .plot import INK, seen_from_above, sheet

SCENE = "meadow"
BEYOND = 5
"""Number of patches shown beyond the last strips."""

CULLED = (0.93, 0.935, 0.915)


def draw_tiling(detail: Detail, /) -> Figure:
    """Return figure 5: the patches around the viewer with the view cone, coloured by representation."""
    with Studio(Take(SCENE, detail.size, detail.preset)) as studio:
        studio.picture(studio.camera(None))
        figure = sheet(4.6, detail)
        _tiles(figure.subplots(), studio.prairie.viewers["main"], studio.prairie.site)
    return figure


def _tiles(axes: Axes, outlook: Outlook, site: Site) -> None:
    table, patch = outlook.patches, site.ground.patch
    x, _, z = outlook.viewer.eye
    far = min(site.reach[-2] + BEYOND, table.side // 2) * patch
    corner = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    square = (table.cell[:, None] + corner) * np.float32(patch)
    color = np.where(table.visible[:, None], patch_colors(outlook, site), np.array(CULLED))
    axes.add_collection(
        PolyCollection(
            [*square[table.alive]], facecolor=color[table.alive], edgecolor="white", linewidth=0.4, alpha=0.85
        )
    )
    middle, half = outlook.viewer.cone
    rays = [ahead((x, z), middle + side, 3.0 * far) for side in (-half, half)]
    axes.add_patch(Polygon([rays[0], (x, z), rays[1]], closed=False, fill=False, edgecolor=INK, linewidth=1.2))
    axes.plot(x, z, "o", color=INK, markersize=5)
    to_x, to_z = ahead((x, z), middle, 0.5 * far)
    seen_from_above(axes, (to_x - 0.7 * far, to_x + 0.7 * far), (to_z - 0.7 * far, to_z + 0.7 * far))
    key: list[Artist] = [
        Patch(color=each.color, alpha=0.85, label=f"{each.label}, to distance {reach}")
        for each, reach in zip(site.representations, site.reach, strict=True)
    ]
    key += [Patch(color=CULLED, label="culled"), Line2D([], [], color=INK, marker="o", label="viewer and view cone")]
    axes.legend(handles=key, loc="center left", bbox_to_anchor=(1.03, 0.5))


FIGURES = (
    PaperFigure(
        5,
        "The tiling",
        "The terrain in patches from above, with the viewer and the view cone: patches outside the cone are culled, "
        "the others have the representation of their discrete distance, paler where it is coarser.",
        "The patch table of the bundled scene meadow, as one frame left it.",
        draw_tiling,
    ),
)
