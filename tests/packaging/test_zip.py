"""A program in a single zip file (`python -m zipapp`), without sources, finds scenes, shaders and winds in it (D6)."""

import subprocess
import sys
from pathlib import Path
from zipfile import PyZipFile

ROOT = Path(__file__).parents[2]
MAIN = """
import tallgrass
from tallgrass.engine.plugins import wind_kinds
from tallgrass.engine.scene import bundled_scenes
from tallgrass.systems.wind.twin import twin_of
from tallgrass.testing import headless_context, stage
with headless_context() as ctx, stage(ctx, (16, 9)) as made:
    prairie = tallgrass.Prairie.load("meadow", preset="low", ctx=ctx)
    made.shot(prairie)
folder = bundled_scenes()["meadow"].parent
print(".pyz" in tallgrass.__file__, len(prairie.site.scene.grass), len(twin_of(tallgrass.Gust).text) > 10)
print(*wind_kinds().names(), folder)
"""


def test_d6_in_a_zip_file_scenes_and_winds_are_found_and_nothing_is_left_behind(tmp_path: Path) -> None:
    packed = tmp_path / "game.pyz"
    with PyZipFile(str(packed), "w") as made:
        made.writestr("__main__.py", MAIN)
        made.writestr("tallgrass/__init__.py", (ROOT / "__init__.py").read_bytes())
        for part in ("components", "engine", "systems", "scenes", "testing"):
            made.writepy(str(ROOT / part), "tallgrass")
            for file in (ROOT / part).rglob("*.*"):
                if "__pycache__" not in file.parts and file.suffix != ".py":
                    made.write(file, Path("tallgrass", file.relative_to(ROOT)))
    done = subprocess.run([sys.executable, packed], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found, (*kinds, folder) = done.stdout.splitlines()[0], done.stdout.splitlines()[1].split()
    assert found == "True 2 True"
    assert {"blast", "breeze", "gust"} <= set(kinds)
    assert not Path(folder).exists()
