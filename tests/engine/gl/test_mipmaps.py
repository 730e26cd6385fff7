"""Mip levels computed on the CPU."""

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.gl.mipmaps import halved, levels, mipmapped, mipmapped_image, stacked

SHOW = """#version 330 core
uniform sampler2DArray images;
uniform float level;
uniform float layer;
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
    made = levels(texels)
    texture = mipmapped(ctx, made)
    for level, now in enumerate(made):
        seen = shown(texture, SHOW, now.shape[1:3], level=float(level), layer=2.0)
        np.testing.assert_array_equal(seen if channels else seen[..., 0], texels[2])
        texels = halved(texels)
    assert len(made) == 6
    texture.release()


@pytest.mark.parametrize("channels", [(), (4,)])
def test_every_level_of_layers_that_lie_in_one_has_each_of_them_whole(channels: tuple[int, ...]) -> None:
    texels = np.random.default_rng(0).integers(0, 256, (5, 12, 16, *channels), np.uint8)
    high = np.zeros((5, 16, 16, *channels), np.uint8)
    high[:, :12] = texels
    made, alone = stacked(levels(texels), 3), levels(high)
    assert [len(level) for level in made] == [2] * 5
    assert made[-1].shape[1:3] == (3, 1)
    for level, each in zip(made, alone, strict=True):
        apart = level.reshape(6, -1, *level.shape[2:])
        np.testing.assert_array_equal(apart[:5], each)
        assert not apart[5].any()


def test_every_level_of_an_image_is_what_was_given(ctx: moderngl.Context) -> None:
    random = np.random.default_rng(0)
    made = [random.integers(0, 256, (side, side, 2), np.uint8) for side in (4, 2, 1)]
    texture = mipmapped_image(ctx, made)
    show = SHOW.replace("2DArray", "2D").replace("vec3(gl_FragCoord.xy / size, layer)", "gl_FragCoord.xy / size")
    for level, texels in enumerate(made):
        seen = shown(texture, show, texels.shape[:2], level=float(level))
        np.testing.assert_array_equal(seen[..., :2], texels)
    texture.release()


def shown(
    texture: moderngl.Texture | moderngl.TextureArray, show: str, shape: tuple[int, ...], **values: float
) -> NDArray[np.uint8]:
    """Return a level of a texture as a shader reads it, shape (rows, columns, 4)."""
    ctx, (rows, columns) = texture.ctx, shape
    program = ctx.program(vertex_shader=COVER, fragment_shader=show)
    target = ctx.framebuffer([ctx.texture((columns, rows), 4)])
    texture.use(0)
    target.use()
    for name, value in values.items():
        program[name] = value
    ctx.vertex_array(program, []).render(vertices=3)
    return np.frombuffer(target.read(components=4), np.uint8).reshape(rows, columns, 4)
