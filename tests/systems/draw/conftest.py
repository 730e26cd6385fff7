"""What the tests of drawing share: small shaders of their own that say what the library's parts compute."""

from collections.abc import Callable, Iterator

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.gl import shaders
from tallgrass.engine.gl.shaders import program
from tallgrass.engine.gl.stream import release_all
from tallgrass.systems.frame.block import FrameBlock

Probe = Callable[..., NDArray[np.float32]]


@pytest.fixture
def probe(ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> Iterator[Probe]:
    """Ask GLSL: `probe(lines, told, rows, record, textures)` gives the floats of the varying `told`, row by row.

    `lines` is a vertex shader that may include the library's parts; `rows` is an array (n, k) that it reads as `row`,
    of k floats; `record` is the frame block.
    """
    read, block = shaders._read, FrameBlock(ctx)  # noqa: SLF001

    def ask(
        lines: str,
        rows: NDArray[np.float32],
        record: NDArray[np.void],
        textures: dict[str, moderngl.Texture | moderngl.TextureArray],
        width: int,
    ) -> NDArray[np.float32]:
        name = f"probe {hash(lines)}.vert"  # what a file of one name consists of is remembered
        told = {name: tuple(lines.splitlines())}
        monkeypatch.setattr(shaders, "_read", lambda name: told.get(name) or read(name))
        made = program(ctx, name, None, varyings=("told",))
        block.join(made)
        block.write(record)
        for unit, (name, texture) in enumerate(textures.items()):
            texture.use(unit)
            made[name] = unit
        source = ctx.buffer(np.ascontiguousarray(rows, np.float32))
        result = ctx.buffer(reserve=4 * width * len(rows))
        array = ctx.vertex_array(made, [(source, f"{rows.shape[1]}f", "row")])
        array.transform(result, moderngl.POINTS, vertices=len(rows))
        answer = np.frombuffer(result.read(), np.float32).reshape(len(rows), width)
        release_all(array, source, result, made)
        return answer

    yield ask
    block.release()
