"""Mip-maps made here."""

import moderngl
import numpy as np
import pytest

from tallgrass.engine.gl.mipmaps import halved, levels, mipmapped

SHOW = """#version 330 core
uniform sampler2DArray images;
uniform float level, layer;
out vec4 pixel;
void main() {
    vec2 size = vec2(textureSize(images, int(level)).xy);
    pixel = textureLod(images, vec3(gl_FragCoord.xy / size, layer), level);
}
"""
COVER = """#version 330 core
void main() { gl_Position = vec4(vec2[](vec2(-1, -1), vec2(3, -1), vec2(-1, 3))[gl_VertexID], 0, 1); }
"""


def test_a_half_is_the_mean_of_two_by_two_rounded() -> None:
    texels = np.array([[[0, 1, 9], [2, 3, 9]], [[255, 255, 9], [255, 254, 9]]], np.uint8)
    np.testing.assert_array_equal(halved(texels), [[[2]], [[255]]])


def test_what_is_one_texel_wide_or_high_is_halved_along_the_other_axis() -> None:
    np.testing.assert_array_equal(halved(np.array([[[4, 8, 6, 7]]], np.uint8)), [[[6, 7]]])
    np.testing.assert_array_equal(halved(np.array([[[4], [8], [200]]], np.uint8)), [[[6]]])


@pytest.mark.parametrize("channels", [(), (4,)])
def test_every_level_of_a_texture_is_the_half_of_the_one_before(
    ctx: moderngl.Context, channels: tuple[int, ...]
) -> None:
    texels = np.random.default_rng(0).integers(0, 256, (3, 12, 37, *channels), np.uint8)
    texture = mipmapped(ctx, levels(texels))
    program = ctx.program(vertex_shader=COVER, fragment_shader=SHOW)
    array = ctx.vertex_array(program, [])
    texture.use(0)
    for level in range(6):
        rows, columns = texels.shape[1:3]
        target = ctx.framebuffer([ctx.texture((columns, rows), 4)])
        target.use()
        program["level"], program["layer"] = float(level), 2.0
        array.render(vertices=3)
        seen = np.frombuffer(target.read(components=4), np.uint8).reshape(rows, columns, 4)
        np.testing.assert_array_equal(seen if channels else seen[..., 0], texels[2])
        texels = halved(texels)
    assert texels.shape[1:3] == (1, 1)
    texture.release()
