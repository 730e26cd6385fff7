"""A prairie so small that every test can grow one."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import moderngl

from ..components.wind import WindPrimitive
from ..engine.declared.quality import LodName
from ..engine.scene.compose import read_document
from ..engine.scene.read import LoadedScene
from ..engine.scene.validate import validate
from ..systems.around.transitions import SEAMLESS, Transitions
from ..systems.prairie import Prairie

LITTLE = """\
tallgrass: 2
seed: 5
terrain: { noise: rolling, seed: 2, size: [60, 60], feature: 30, scale: 4 }
grass:
  tall: { height: [0.5, 0.9], width: 0.02, root: "#5a5a2c", tip: "#dcc98f" }
  short: { height: [0.2, 0.4], width: 0.02, root: "#27401a", tip: "#8fae4a", stiffness: 2 }
camera: { position: [0, 20], eye: 1.7, pitch: -12, view: 45 }
quality:
  blades: 60
  models: 2
  blade_rings: [{ to: 1, segments: 3 }, { to: 2, segments: 2 }]
  strip_rings:
    - { to: 5, strips: 4, columns: 2, sections: 2, texel: 0.02 }
    - { to: 8, strips: 2, columns: 1, sections: 1, texel: 0.03 }
  carpet_to: 12
  carpet: 32
"""
"""A scene of two kinds of grass on 60 by 60 m of rolling ground, without wind; all three representations show."""

SPARSE = """\
tallgrass: 2
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.03 }]
  carpet_to: 12
  carpet: 32
"""
"""How scenes begin in which grass matters little: in a quality that is soon grown."""


@contextmanager
def little_prairie(
    *winds: WindPrimitive,
    scene: str = LITTLE,
    ctx: moderngl.Context | None = None,
    lod: LodName = "auto",
    transitions: Transitions = SEAMLESS,
) -> Iterator[Prairie]:
    """Grow a small prairie in the current esper world, and release it in the end.

    `winds` blow on it, besides those that `scene` declares, the text of a scene file; the one it has unless told
    otherwise is `LITTLE`, without wind. `ctx` is the context to draw in; without it the one that is current at the
    first draw, and none where nothing is drawn. `lod` and `transitions` are those of `Prairie.load`. Raises SceneError
    with every problem of the text.
    """
    document = read_document(scene, file="<scene>")
    declared = validate(document)
    loaded = LoadedScene(declared, Path("scene.yaml"), Path(), document)
    prairie = Prairie(loaded, ctx=ctx, lod=lod, transitions=transitions)
    try:
        for wind in winds:
            prairie.add(wind)
        yield prairie
    finally:
        prairie.release()
