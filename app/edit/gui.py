"""Dear ImGui in a window of pyglet's, drawn with moderngl as a guest: the prairie's GL state stays as it is."""

import ctypes

import moderngl
import numpy as np
from imgui_bundle import imgui

from ...engine.gl.guest import guest
from ...engine.gl.shaders import program
from ...engine.gl.stream import release_all
from ...engine.gl.units import FIRST_UNIT

_ROOM = 1 << 16


class Gui:
    """The imgui context of one panel: it takes events, and draws what is built between `begin` and `end`."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self._context = imgui.create_context()
        self.use()
        io = imgui.get_io()
        io.set_ini_filename(None)
        io.backend_flags |= imgui.BackendFlags_.renderer_has_textures
        self._program = program(ctx, "app/edit/panel.vert", "app/edit/panel.frag")
        self._images: dict[int, moderngl.Texture] = {}
        self._corners = ctx.buffer(reserve=_ROOM, dynamic=True)
        self._numbers = ctx.buffer(reserve=_ROOM, dynamic=True)
        self._array = self._laid()

    def use(self) -> None:
        """Make this context the current one of `imgui`."""
        imgui.set_current_context(self._context)

    @property
    def wants_mouse(self) -> bool:
        """Whether the pointer is on the panel, or drags one of its items."""
        self.use()
        return imgui.get_io().want_capture_mouse

    @property
    def wants_keys(self) -> bool:
        """Whether a text field has the keyboard."""
        self.use()
        return imgui.get_io().want_text_input

    def begin(self, size: tuple[int, int], pixels: tuple[int, int], dt: float) -> None:
        """Begin a frame on a window of this size and number of pixels, `dt` [s] after the frame before."""
        self.use()
        io = imgui.get_io()
        io.display_size = imgui.ImVec2(*size)
        io.display_framebuffer_scale = imgui.ImVec2(
            *(max(1, count) / max(1, side) for count, side in zip(pixels, size, strict=True))
        )
        io.delta_time = max(dt, 1e-4)
        imgui.new_frame()

    def end(self) -> None:
        """Draw what was built since `begin` into the host's bound framebuffer."""
        imgui.render()
        data = imgui.get_draw_data()
        with guest(self.ctx) as target:
            for texture in imgui.get_platform_io().textures:
                self._bring(texture)
            if min(data.display_size.x, data.display_size.y) >= 1:
                self._draw(data, target)

    def release(self) -> None:
        """Give everything back."""
        self.use()
        for texture in imgui.get_platform_io().textures:
            texture.set_tex_id(0)
            texture.status = imgui.ImTextureStatus.destroyed
        imgui.get_io().backend_flags &= ~imgui.BackendFlags_.renderer_has_textures
        release_all(self._array, self._program, self._corners, self._numbers, *self._images.values())
        imgui.destroy_context(self._context)

    def _laid(self) -> moderngl.VertexArray:
        layout = [(self._corners, "2f 2f 4f1", "place", "at", "color")]
        return self.ctx.vertex_array(self._program, layout, self._numbers, index_element_size=imgui.INDEX_SIZE)

    def _bring(self, texture: imgui.ImTextureData) -> None:
        """Upload a whole image of glyphs; it changes only when new glyphs are shown."""
        status = imgui.ImTextureStatus
        if texture.status in (status.want_create, status.want_updates):
            size, pixels = (texture.width, texture.height), np.ascontiguousarray(texture.get_pixels_array())
            image = self._images.get(texture.tex_id) if texture.status == status.want_updates else None
            if image is None:
                image = self.ctx.texture(size, 4, alignment=1)
                self._images[image.glo] = image
                texture.set_tex_id(image.glo)
            image.write(pixels.tobytes(), alignment=1)
            texture.status = status.ok
        elif texture.status == status.want_destroy:
            self._images.pop(texture.tex_id).release()
            texture.set_tex_id(0)
            texture.status = status.destroyed

    def _draw(self, data: imgui.ImDrawData, target: moderngl.Framebuffer) -> None:
        scale, height = data.framebuffer_scale, target.viewport[3]
        self.ctx.enable_only(moderngl.BLEND)
        self.ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        self._program["screen"] = data.display_size.x, data.display_size.y
        self._program["image"] = FIRST_UNIT
        for commands in data.cmd_lists:
            self._write(commands)
            for command in commands.cmd_buffer:
                left, top, right, bottom = (
                    round(edge * each)
                    for edge, each in zip(command.clip_rect, (scale.x, scale.y, scale.x, scale.y), strict=True)
                )
                if right <= left or bottom <= top:
                    continue
                target.scissor = left, height - bottom, right - left, bottom - top
                self._images[command.tex_ref.get_tex_id()].use(FIRST_UNIT)
                self._array.render(moderngl.TRIANGLES, vertices=command.elem_count, first=command.idx_offset)

    def _write(self, commands: imgui.ImDrawList) -> None:
        corners = _bytes(commands.vtx_buffer.data_address(), commands.vtx_buffer.size() * imgui.VERTEX_SIZE)
        numbers = _bytes(commands.idx_buffer.data_address(), commands.idx_buffer.size() * imgui.INDEX_SIZE)
        grown = False
        for buffer, data in ((self._corners, corners), (self._numbers, numbers)):
            if len(data) > buffer.size:
                buffer.orphan(2 * len(data))
                grown = True
            buffer.write(data)
        if grown:
            self._array.release()
            self._array = self._laid()


def _bytes(address: int, count: int) -> bytes:
    return ctypes.string_at(address, count) if count else b""
