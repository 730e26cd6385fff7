"""Every program of every bundled scene is OpenGL 3.3's own GLSL, by the reference compiler (D6)."""

import shutil
import subprocess
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import esper
import moderngl
import pytest

from tallgrass import Footprint, Pose, Prairie, Presser
from tallgrass.components.body import Body
from tallgrass.engine.plugins import wind_kinds
from tallgrass.engine.scene import bundled_scenes
from tallgrass.testing import stage

pytestmark = pytest.mark.hosts

Sources = tuple[str, str | None]


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> set[Sources]:
    """Sources of all programs that are compiled during the test."""
    found: set[Sources] = set()
    make = moderngl.Context.program

    def program(ctx: moderngl.Context, **sources: object) -> object:
        found.add((str(sources["vertex_shader"]), sources.get("fragment_shader")))  # type: ignore[arg-type]
        return make(ctx, **sources)  # type: ignore[arg-type]

    monkeypatch.setattr(moderngl.Context, "program", program)
    return found


def draw_all(prairie: Prairie, shot: Callable[[], object]) -> None:
    """Make a prairie compile all programs that it ever needs."""
    shot()
    for kind in wind_kinds().names():
        prairie.add(wind_kinds().find(kind)())  # type: ignore[call-arg]
    added = [esper.create_entity(Body((0.0, 6.0, 0.0)))]
    shot()
    added.append(esper.create_entity(Presser(radius=0.5), Pose(0.0, 0.0)))
    shot()
    prairie.advance(0.5)
    shot()
    prairie.cut(Footprint(radius=4.0), 0.05)
    shot()
    for entity in added:
        esper.delete_entity(entity, immediate=True)


def test_every_program_links_without_a_warning(ctx: moderngl.Context, made: set[Sources], tmp_path: Path) -> None:
    program = shutil.which("glslangValidator")
    if program is None:
        pytest.skip("there is no glslangValidator (apt-get install --no-install-recommends glslang-tools)")
    with stage(ctx, (96, 54)) as small:
        for name in bundled_scenes():
            prairie = Prairie.load(name, preset="low", ctx=ctx)
            draw_all(prairie, lambda: small.shot(prairie))  # noqa: B023
            prairie.release()

    def complaint(number: int, sources: Sources) -> str:
        files = []
        for stage_of, text in zip(("vert", "frag"), sources, strict=True):
            if text is not None:
                files.append(tmp_path / f"{number}.{stage_of}")
                files[-1].write_text(text, "utf-8")
        done = subprocess.run([program, "-l", *files], capture_output=True, text=True, check=False)
        lines = [line for line in done.stdout.splitlines() if line.strip() and line not in map(str, files)]
        return "\n".join(lines)

    with ThreadPoolExecutor(2) as pool:
        said = [text for text in pool.map(complaint, range(len(made)), sorted(made, key=str)) if text]
    assert len(made) > 100
    assert said == []
