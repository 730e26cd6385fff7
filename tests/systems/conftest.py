"""Fixtures of tests of systems: a small scene on uneven ground that is grown once, and GLSL probes."""

from collections.abc import Callable, Iterator
from math import pi

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.viewer import Viewer
from tallgrass.components.wind import WindPrimitive, WindSource
from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.quality import BladeRing, Quality, StripRing
from tallgrass.engine.declared.scene import Scene
from tallgrass.engine.gl import shaders
from tallgrass.engine.gl.shaders import program
from tallgrass.engine.gl.stream import release_all
from tallgrass.engine.schedule import Phase, Schedule
from tallgrass.engine.terrain.record import Density, Terrain
from tallgrass.engine.terrain.sample import height_at
from tallgrass.engine.world import World
from tallgrass.systems.around.asked import Asked
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.around.transitions import SEAMLESS
from tallgrass.systems.blow import Hear
from tallgrass.systems.frame.block import FRAME, FrameBlock, confine
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.land.record import write_land
from tallgrass.systems.light.daylight import daylight
from tallgrass.systems.light.draw import write_light
from tallgrass.systems.site import Site, lay_out, outlook_on
from tallgrass.systems.space.ground import Ground
from tallgrass.systems.space.grown import Grown
from tallgrass.systems.stock.models import grow
from tallgrass.systems.wind.blow import blowing, hear
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.testing import systems_on

Probe = Callable[..., NDArray[np.float32]]

KINDS = {
    "tall": GrassKind(height=[0.6, 1.0], width=0.01, stiffness=0.6, lean=0.4),
    "short": GrassKind(height=[0.2, 0.4], width=0.014, stiffness=2.0, lean=0.2, blades=12),
}
QUALITY = Quality(
    blades=30,
    models=2,
    blade_rings=[BladeRing(to=1, segments=3), BladeRing(to=2, segments=2)],
    strip_rings=[
        StripRing(to=4, strips=3, columns=2, sections=1, texel=0.05),
        StripRing(to=6, strips=2, columns=1, sections=1, texel=0.08),
    ],
    carpet_to=9,
    carpet=8,
)
SCENE = Scene(tallgrass=2, seed=3, grass=KINDS, quality=QUALITY)

Laid = Callable[..., Site]
Look = Callable[..., Outlook]
RecordOf = Callable[[Grown], NDArray[np.void]]


@pytest.fixture(scope="session")
def growths() -> list[Growth]:
    """Growths of a tall soft kind and of a short stiff one."""
    return [grow(kind, QUALITY, seed=number) for number, kind in enumerate(KINDS.values())]


@pytest.fixture(scope="session")
def hills() -> Terrain:
    """Terrain that is steep nearly everywhere, 90 m wide and 70 m deep."""
    x, z = np.meshgrid(np.arange(91) * 0.4, np.arange(71) * 0.3)
    rough = np.random.default_rng(1).normal(0.0, 0.3, x.shape)
    return Terrain((3.0 * np.sin(x) + 2.0 * np.cos(z + 0.1 * x) + rough).astype(np.float32), 1.0)


@pytest.fixture
def laid(growths: list[Growth], hills: Terrain) -> Laid:
    """Return the function that lays out a site; `dense` has densities (kinds, rows, columns) over the terrain."""

    def make(*, lod: str = "auto", dense: NDArray[np.float32] | None = None, terrain: Terrain = hills) -> Site:
        maps = np.ones((2, 2, 2), np.float32) if dense is None else dense
        ground = Ground(terrain, Density(maps, terrain.size), QUALITY.patch)
        return lay_out(SCENE, QUALITY, ground, growths, lod=lod, transitions=SEAMLESS)

    return make


@pytest.fixture
def look(world: World) -> Look:
    """Return the function that lets a site's viewer look for one frame, up to planting; it returns the outlook.

    `dt` is the time since its last look [s], `yaw` its heading [rad] (None looks all round), `up` the height of its eye
    above the ground [m]. `hear` computes the messages to receivers; without it the air is calm.
    """
    outlooks: dict[Site, tuple[Outlook, Schedule]] = {}

    def at(
        site: Site,
        x: float,
        z: float,
        *,
        yaw: float | None = None,
        dt: float = 1e9,
        jumped: bool = False,
        hear: Hear | None = None,
        up: float = 0.8,
    ) -> Outlook:
        if site not in outlooks:
            viewer = Viewer()
            outlook = outlook_on(site, viewer, world.create(viewer))
            outlooks[site] = outlook, systems_on(site, [outlook], world, hear=hear)
        outlook, systems = outlooks[site]
        viewer = outlook.viewer
        ground = float(height_at(site.ground.terrain, np.array([[x, z]], np.float32))[0])
        viewer.eye, viewer.cone = (x, ground + up, z), (0.0, pi) if yaw is None else (yaw, 0.6)
        viewer.dt, viewer.way, viewer.jumped = dt, 0.0, jumped
        systems.run(last=Phase.SEE)
        systems.step("plant")
        if hear is not None:
            systems.step("wind")
        return outlook

    return at


@pytest.fixture
def wind() -> Callable[..., Hear]:
    """Return the function that makes a `Hear` of winds at a time, with the seed 3: `wind(Breeze(), time=2.0)`."""

    def at(*primitives: WindPrimitive, time: float) -> Hear:
        sources = [WindSource(primitive, f"wind[{number}]") for number, primitive in enumerate(primitives)]
        quarantine = Quarantine()
        return lambda heard, *_, **__: hear(
            blowing(sources, quarantine, time=time, seed=3), heard, quarantine, time=time, seed=3
        )

    return at


@pytest.fixture
def probe(ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> Iterator[Probe]:
    """Return the function that runs GLSL: `probe(lines, rows, record, textures, width)`.

    `lines` is a vertex shader, which may include files of the library. It reads `row`, a vector of k floats from `rows`
    (n, k), the frame block `record`, and `textures` by their samplers' names. It writes the varying `told` of `width`
    floats. The result is `told` for each row, shape (n, width).
    """
    read, block = shaders._read, FrameBlock(ctx)  # noqa: SLF001

    def ask(
        lines: str,
        rows: NDArray[np.float32],
        record: NDArray[np.void],
        textures: dict[str, moderngl.Texture | moderngl.TextureArray],
        width: int,
    ) -> NDArray[np.float32]:
        name = f"probe {hash(lines)}.vert"  # a file's text is cached by its name
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


@pytest.fixture
def record_of() -> RecordOf:
    """Return the function that fills a frame record with a scene's ground and light: `record_of(site)`."""

    def make(grown: Grown) -> NDArray[np.void]:
        record, light = np.zeros(1, FRAME), grown.scene.light
        write_land(record, grown)
        confine(record, Asked())
        write_light(record, light, daylight(light), list(grown.scene.grass.values()))
        return record

    return make
