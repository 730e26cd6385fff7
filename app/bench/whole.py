"""`tallgrass bench all`: every benchmark of a scene in one file, and on a page that compares it with an earlier one."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from time import perf_counter

from ... import __version__
from ...engine.gl.smaller import Size
from ...engine.scene import read_scene
from ..figures.make import need_matplotlib
from ..studio.encode import make_folder, write_whole
from ..studio.errors import InputError
from ..studio.progress import course
from ..studio.take import Take
from .flip import evaluator
from .frame import frame_measured
from .machine import tell
from .picture import measured
from .pop import LIMITS, pop_measured
from .scale import scale_measured
from .sent import Result
from .walk import walk_measured

LARGE, SMALL = (1280, 720), (640, 360)
"""Picture sizes of the benchmarks [pixels]; the small one is for `bench pop`."""

SHARES = {"frame": 60.0, "walk": 120.0, "scale": 60.0, "picture": 20.0, "pop": 70.0}
"""Names of the benchmarks, with their approximate relative durations."""


def bench_all(
    scene: str, output: str, *, preset: str | None, size: Size | None, against: str | None, json: bool
) -> None:
    """Run every benchmark of a scene, and write `bench.json` and `bench.html` into a folder.

    Without `size` each benchmark uses its own. `against` is an earlier `bench.json` to compare with. Before anything is
    drawn it raises InputError where that file is no such file or the folder cannot be written, `SceneError` where the
    scene is wrong, MachineError where pictures cannot be compared or plots cannot be drawn.
    """
    need_matplotlib()
    evaluator()
    before = None if against is None else read_result(against)
    folder = Path(output)
    make_folder(folder)
    result = all_measured(scene, preset=preset, size=size)
    from .page import page

    write_whole(as_text(result), folder / "bench.json")
    write_whole(page(result, before), folder / "bench.html")
    if json:
        tell(result, as_json=True)
    else:
        print(f"{folder / 'bench.json'}\n{folder / 'bench.html'}")


def all_measured(scene: str, *, preset: str | None, size: Size | None) -> Result:
    """Return the results of all benchmarks of a scene; `scale` is None where its terrain comes from a file."""
    large, small = Take(scene, size or LARGE, preset), Take(scene, size or SMALL, preset)
    noise = read_scene(scene).scene.terrain.heights is None
    work: dict[str, Callable[[], Mapping[str, object] | None]] = {
        "frame": lambda: frame_measured(large),
        "walk": lambda: walk_measured(large),
        "scale": lambda: scale_measured(large) if noise else None,
        "picture": lambda: measured(large),
        "pop": lambda: pop_measured(small),
    }
    found: Result = {}
    took: dict[str, float] = {}
    with course("every benchmark", SHARES) as way:
        for name, measure in work.items():
            with way.part(name):
                start = perf_counter()
                found[name] = measure()
                took[name] = round(perf_counter() - start, 1)
    head = {"version": __version__, "machine": found["frame"]["machine"], "scene": scene}
    return head | {"preset": found["frame"]["preset"], "took_s": took, "limits": LIMITS} | found


def as_text(result: Result, /) -> str:
    """Return a result as the text of its file."""
    return json.dumps(result, indent=1) + "\n"


def read_result(file: str, /) -> Result:
    """Return the result in a file of `bench all`; raises InputError where the file is another one."""
    try:
        result = json.loads(Path(file).read_text("utf-8"))
    except OSError as error:
        raise InputError(f"--against: {file}: {error.strerror}") from None
    except ValueError:
        result = None
    if not isinstance(result, dict) or not {"version", "machine", *SHARES} <= result.keys():
        raise InputError(f"--against: {file}: this is no bench.json of `tallgrass bench all`")
    return result
