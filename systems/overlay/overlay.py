"""The overlay: layers that show how a prairie works, drawn over its picture."""

from collections.abc import Iterable
from functools import partial

import numpy as np

from ...engine.camera import View, view_of
from ...engine.gl.functions import functions_of
from ...engine.gl.guest import guest, guest_view
from ...engine.gl.homes import Homes
from ..around.outlook import Outlook
from ..prairie import Prairie
from ..site import Site
from .arrows import arrow_marks
from .chart import chart, sheet_for
from .layers import Layer
from .legend import entries, legend
from .marks import Marks, together, veiled
from .masks import Masked, mask_marks, masked
from .painter import MarkPainter, pixels_onto_clip, scale_of
from .patches import level_marks, weight_marks

EDGE = 10.0
"""Margin between map or legend and the picture's edges [pixels of a picture 540 high]."""

LETTERS = 13.0
"""Size of the legend's letters [pixels of a picture 540 high]."""

ROOM = 0.7
"""Largest part of the picture's width and height for the legend, which small pictures do without."""

MAP = 0.42
"""Side of the map, relative to the picture's shorter side."""


class Overlay:
    """Any of the layers masks, arrows, levels, weights and map, drawn over a prairie.

    It reads the prairie's tables and pools and changes nothing: the prairie looks the same without it.
    """

    def __init__(self, parts: Iterable[Layer] = ()) -> None:
        self.layers: frozenset[Layer] = frozenset(parts)
        self._painters: Homes[MarkPainter] = Homes()

    def draw(self, prairie: Prairie, view: object, projection: object, *, viewer: str = "main") -> None:
        """Draw over the frame that `prairie.draw` has just drawn with the same matrices; GL's state is restored.

        Raise RuntimeError for a prairie that has not been drawn.
        """
        if not self.layers:
            return
        if prairie.painter is None:
            raise RuntimeError("an overlay shows a frame that is drawn: draw the prairie first")
        ctx, outlook = prairie.painter.ctx, prairie.viewers[viewer]
        seen, masks = view_of(view, projection, prairie.origin), self._masks(prairie, outlook)
        with guest(ctx) as target:
            seen = guest_view(seen)
            size = target.viewport[2:]
            painter = self._painters.here(functions_of(ctx), partial(MarkPainter, ctx))
            painter.begin(size)
            painter.draw(self._on_ground(outlook, prairie.site, masks), _clip(seen))
            self._draw_flat(painter, outlook, prairie.site, masks, size)

    def release(self) -> None:
        """Release all GL objects."""
        self._painters.release()

    def _masks(self, prairie: Prairie, outlook: Outlook) -> list[Masked]:
        """Return the masks of all blowing winds, if a layer shows them."""
        if not self.layers & {"masks", "map"}:
            return []
        winds, time = prairie.winds, prairie.time
        x, _, z = outlook.viewer.eye
        far = prairie.site.reach[-1] * prairie.site.ground.patch
        return masked(winds.acting(time), winds.quarantine, time=time, around=(x, z), far=far)

    def _on_ground(self, outlook: Outlook, site: Site, masks: list[Masked]) -> Marks:
        """Return the marks of the layers that lie on the ground, fainter behind hills."""
        terrain = site.ground.terrain
        layers = []
        if "levels" in self.layers:
            layers.append(level_marks(outlook, site, settled="weights" in self.layers))
        if "weights" in self.layers:
            layers.append(weight_marks(outlook, site))
        if "masks" in self.layers:
            layers.append(mask_marks(masks, terrain))
        if "arrows" in self.layers:
            layers.append(arrow_marks(outlook, terrain))
        return veiled(together(*layers), terrain, outlook.viewer.eye)

    def _draw_flat(
        self, painter: MarkPainter, outlook: Outlook, site: Site, masks: list[Masked], size: tuple[int, int]
    ) -> None:
        """Draw map and legend in the picture's plane."""
        scale = scale_of(size)
        edge = EDGE * scale
        if "map" in self.layers:
            side = float(round(MAP * min(size)))
            sheet = sheet_for(outlook, site, left=size[0] - edge - side, bottom=size[1] - edge - side, side=side)
            painter.draw(chart(outlook, site, masks, sheet), pixels_onto_clip(size))
        lines = entries(self.layers, masks, site.representations)
        image = legend(tuple(lines), round(LETTERS * scale))
        if image.shape[1] < ROOM * size[0] and image.shape[0] < ROOM * size[1]:
            painter.draw_image(image, round(size[0] - edge) - image.shape[1], round(edge))


def _clip(seen: View) -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
    return seen.clip.astype(np.float32)
