"""Drawing of marks and the legend over the framebuffer's contents, without depth test and depth writes."""

import moderngl
import numpy as np

from ...components.arrays import Bytes, Floats
from ...engine.gl.shaders import program
from ...engine.gl.smaller import OVER
from ...engine.gl.stream import Stream, attributes, release_all
from ...engine.gl.texture import by_texel
from ...engine.gl.units import FIRST_UNIT
from .marks import LINE, SHAPE, Marks

LINE_CORNERS = np.array([[0, -1], [1, -1], [0, 1], [1, 1]], np.float32)
IMAGE_CORNERS = np.array([[0, 0], [1, 0], [0, 1], [1, 1]], np.float32)


class MarkPainter:
    """Draws marks, in the world or on the picture, and images on the picture."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.programs = [
            program(ctx, "systems/overlay/overlay.vert", "systems/overlay/overlay.frag", defines=defines)
            for defines in ({"SHAPE": 1}, {"LINE": 1}, {"PAPER": 1})
        ]
        shape, line, paper = self.programs
        self.shapes, self.lines = Stream(ctx, SHAPE), Stream(ctx, LINE)
        self.corners = ctx.buffer(LINE_CORNERS), ctx.buffer(IMAGE_CORNERS)
        form, names = attributes(SHAPE)
        self.arrays = [
            ctx.vertex_array(shape, [(self.shapes.buffer, form, *names)]),
            ctx.vertex_array(line, [(self.corners[0], "2f", "corner"), self.lines.binding(line)]),
            ctx.vertex_array(paper, [(self.corners[1], "2f", "corner")]),
        ]
        self.sheet: moderngl.Texture | None = None
        self.image: Bytes | None = None

    def begin(self, size: tuple[int, int]) -> None:
        """Set the state for drawing over a picture of a size [pixels]."""
        self.ctx.enable_only(moderngl.BLEND)
        self.ctx.blend_func = OVER
        for made in self.programs[1:]:
            made["screen"] = size[0] / 2, size[1] / 2
        self.programs[1]["scale"] = scale_of(size)

    def draw(self, marks: Marks, onto: Floats) -> None:
        """Draw marks; `onto` (4, 4) is the matrix from their space to clip space, for column vectors."""
        matrix = tuple(onto.T.reshape(-1).tolist())
        self.shapes.write(marks.shapes)
        self.lines.write(marks.lines)
        if self.shapes.count:
            self.programs[0]["onto"] = matrix
            self.arrays[0].render(moderngl.TRIANGLES, vertices=self.shapes.count)
        if self.lines.count:
            self.programs[1]["onto"] = matrix
            self.arrays[1].render(moderngl.TRIANGLE_STRIP, vertices=4, instances=self.lines.count)

    def draw_image(self, image: Bytes, left: int, bottom: int) -> None:
        """Draw an image (h, w, 4) with its lower left corner at a pixel of the picture."""
        height, width = image.shape[:2]
        if image is not self.image or self.sheet is None:
            self._release_sheet()
            self.sheet = by_texel(self.ctx.texture((width, height), 4, np.ascontiguousarray(image), alignment=1))
            self.image = image
        self.sheet.use(FIRST_UNIT)
        self.programs[2]["sheet"] = FIRST_UNIT
        self.programs[2]["box"] = left, bottom, width, height
        self.arrays[2].render(moderngl.TRIANGLE_STRIP, vertices=4)

    def _release_sheet(self) -> None:
        release_all(self.sheet)
        self.sheet = None

    def release(self) -> None:
        """Release all GL objects."""
        self._release_sheet()
        release_all(*self.arrays, *self.programs, self.shapes, self.lines, *self.corners)


def scale_of(size: tuple[int, int], /) -> float:
    """Return the scale of line widths and letters for a picture of a size [pixels]: 1 at a height of 540."""
    return float(np.clip(size[1] / 540.0, 0.6, 4.0))


def pixels_onto_clip(size: tuple[int, int], /) -> Floats:
    """Return the matrix from pixels, counted from the lower left, to clip space, shape (4, 4)."""
    return np.array([[2 / size[0], 0, 0, -1], [0, 2 / size[1], 0, -1], [0, 0, 0, 0], [0, 0, 0, 1]], np.float32)
