"""Films on several workers: the same bytes as from one process, even if workers are lost."""

import os
import signal
import sys
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.app.bench import pop, stroll
from tallgrass.app.bench.sent import Job, measured_here
from tallgrass.app.cli import run
from tallgrass.app.farm.dask import need_distributed
from tallgrass.app.farm.film import LONGEST, MOST_BYTES, ranges, shot_on
from tallgrass.app.farm.hands import Hands
from tallgrass.app.farm.hire import hired
from tallgrass.app.farm.parcel import Parcel, packed, unpack
from tallgrass.app.farm.worker import Order, codec, footage
from tallgrass.app.grow import grown
from tallgrass.app.manifest import Span
from tallgrass.app.studio.errors import InputError, MachineError
from tallgrass.app.studio.shooting import Shooting, Shot
from tallgrass.app.studio.take import Take
from tallgrass.engine.kept import DIGEST
from tallgrass.engine.scene import read_scene
from tallgrass.systems.stock.cache import growth_key

Both = Callable[..., tuple[str, str]]

COUNT, FPS = 12, 8
ABOUT = {"scene": "little"}


def take_of(scene: Path) -> Take:
    return Take(str(scene), (64, 36))


@pytest.fixture
def alone(scene: Path) -> Iterator[Shooting]:
    """Folder of the film that one process makes."""
    with Shooting(take_of(scene), FPS) as shooting:
        yield shooting


def told(shots: list[Shot]) -> list[str]:
    return [shot.sha256 for shot in shots]


@pytest.fixture(scope="module")
def two() -> Iterator[Hands]:
    """Two workers."""
    with hired("local:2", most=2) as hands:
        yield hands


@pytest.fixture
def address(two: Hands) -> str:
    """Address of the workers' scheduler."""
    assert two.count == 2
    return str(need_distributed().default_client().scheduler.address)


@pytest.fixture
def both(address: str, scene: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Both:
    """Run a command in this process and by two workers, into two folders; return both outputs."""
    monkeypatch.chdir(scene.parent)

    def told(*words: object) -> tuple[str, str]:
        printed = []
        for folder, place in (("alone", []), ("together", ["--on", address])):
            assert run([*(str(word).replace("FOLDER", folder) for word in words), *place]) == 0
            out, err = capsys.readouterr()
            assert err == ""
            printed.append(out)
        return printed[0], printed[1]

    return told


@pytest.mark.gl
@pytest.mark.usefixtures("ctx")
@pytest.mark.parametrize("output", ["film/", pytest.param("film.webp", marks=pytest.mark.slow)])
def test_a_film_by_two_workers_is_that_of_one_process_byte_for_byte(both: Both, scene: Path, output: str) -> None:
    films = []
    assert both("film", scene, "-o", f"FOLDER/{output}", "--fps", FPS, "--size", "64x36") == ("", "")
    for folder in ("alone", "together"):
        files = (path for path in (scene.parent / folder).rglob("*") if path.is_file())
        films.append({path.relative_to(scene.parent / folder): path.read_bytes() for path in files})
    assert films[0] == films[1]
    assert len(films[0]) == (COUNT + 1 if output == "film/" else 2), "the manifest too"


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.usefixtures("ctx")
def test_pictures_that_workers_compare_have_the_figures_of_one_process(both: Both, scene: Path) -> None:
    pytest.importorskip("flip_evaluator")
    (scene.parent / "scenes").mkdir()
    for name in ("one", "other"):
        (scene.parent / "scenes" / f"{name}.yaml").write_bytes(scene.read_bytes())
    alone, together = both("bench", "picture", "scenes", "-o", "FOLDER", "--size", "64x36", "--json")
    assert alone == together
    pictures = [
        {path.name: path.read_bytes() for path in (scene.parent / folder).iterdir()} for folder in ("alone", "together")
    ]
    assert pictures[0] == pictures[1]
    assert set(pictures[0]) == {"one.png", "other.png"}


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.usefixtures("ctx")
def test_a_walk_by_a_worker_has_the_figures_of_one_process(
    two: Hands, scene: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("flip_evaluator")

    def on_one_leg(take: Take, output: str | None) -> dict[str, Any]:
        every = stroll.legs
        for module, name, value in (
            (stroll, "RATE", 10), (stroll, "SECONDS", 0.5), (pop, "legs", lambda prairie: every(prairie)[:1])
        ):  # fmt: skip
            monkeypatch.setattr(module, name, value)
        told = pop.pop_measured(take, output, crew=False)
        monkeypatch.undo()
        return told

    folder = scene.parent / "pictures"
    folder.mkdir()
    take = Take(str(scene), (64, 64))
    alone = on_one_leg(take, str(folder))
    ((there),) = two.in_order(measured_here, [(packed(take, read_scene(take.scene)), Job(on_one_leg), True)])
    assert {**there.result, "scene": take.scene} == alone
    assert there.pictures == {path.name: path.read_bytes() for path in folder.iterdir()}
    assert there.pictures


def test_what_is_timed_is_alone_on_its_machine(two: Hands, scene: Path) -> None:
    def timed(*_: object) -> dict[str, Any]:
        begun = perf_counter()
        sleep(0.3)
        return {"from": begun, "to": perf_counter()}

    parcel = packed(take_of(scene), read_scene(scene))
    one, other = sorted(
        (each.result["from"], each.result["to"])
        for each in two.in_order(measured_here, [(parcel, Job(timed, timed=True), False)] * 2)
    )
    assert one[1] <= other[0]


def test_what_workers_grow_is_kept_byte_for_byte_as_one_process_grows_it(
    two: Hands, scene: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    scene.write_text(scene.read_text().replace("grass:\n", "grass:\n  soft: { stiffness: 0.5 }\n"))
    folder = scene.parent / "cache"
    monkeypatch.setenv("TALLGRASS_CACHE", str(folder))
    assert run(["grow", str(scene)]) == 0
    assert capsys.readouterr().out == f"{scene}: kinds 2, grown now 2\n"
    read = read_scene(scene).scene
    seeds = [(kind, read.numbers(None), read.seed + number) for number, kind in enumerate(read.grass.values())]
    keys = [growth_key(kind, quality, seed=seed) for kind, quality, seed in seeds]
    there = two.in_order(grown, [(*seed, key) for seed, key in zip(seeds, keys, strict=True)])
    assert dict(zip(keys, there, strict=True)) == {path.stem: path.read_bytes()[DIGEST:] for path in folder.iterdir()}
    assert run(["grow", str(scene)]) == 0
    assert capsys.readouterr().out == f"{scene}: kinds 2, grown now 0\n"
    with pytest.raises(MachineError, match="other code"):
        list(two.in_order(grown, [(*seeds[0], "of other code")]))


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.usefixtures("ctx")
@pytest.mark.skipif(sys.platform == "win32", reason="a process is ended there in another way")
def test_what_a_lost_worker_had_is_drawn_by_another(address: str, alone: Shooting, scene: Path) -> None:
    span = Span(0, COUNT, COUNT, FPS)
    with shot_on(address, take_of(scene), read_scene(scene), span, ABOUT) as shots:
        drawn = [next(shots) for _ in range(3)]
        processes = need_distributed().default_client().run(os.getpid)
        assert len(set(processes.values())) == 2
        os.kill(next(iter(processes.values())), signal.SIGKILL)
        drawn += shots
    whole = list(alone.shots(0, COUNT, files=ABOUT))
    assert [shot.frame for shot in drawn] == [shot.frame for shot in whole]
    assert told(drawn) == told(whole)
    assert len(set(told(whole))) == COUNT


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.usefixtures("ctx")
def test_a_worker_draws_ranges_in_any_order_and_leaves_files_to_the_codec_that_is_asked_for(
    alone: Shooting, scene: Path
) -> None:
    parcel = packed(take_of(scene), read_scene(scene))
    mine, other = Order(FPS, ABOUT, codec()), Order(FPS, ABOUT, "another")
    with hired("local:1", most=1) as hands:
        sent = hands.keep(parcel)
        pieces = [(sent, mine, 8, 10), (sent, other, 1, 3), (sent, mine, 3, 4)]
        late, early, after = (done.shots for done in hands.in_order(footage, pieces))
    whole = list(alone.shots(0, 10))
    assert told(late) == told(whole[8:10])
    assert told(early + after) == told(whole[1:4])
    assert isinstance(late[0].frame, bytes)
    for shot, true in zip(early, whole[1:3], strict=True):
        np.testing.assert_array_equal(shot.frame, true.frame)


@given(
    first=st.integers(0, 5000),
    count=st.integers(1, 3000),
    workers=st.integers(0, 500),
    size=st.tuples(st.integers(1, 16384), st.integers(1, 16384)),
)
def test_ranges_are_the_film_from_its_first_frame_to_its_last(
    first: int, count: int, workers: int, size: tuple[int, int]
) -> None:
    span = Span(first, first + count, first + count, 24)
    found = list(ranges(span, workers, size))
    assert (found[0][0], found[-1][1]) == (first, first + count)
    assert all(one[1] == other[0] for one, other in pairwise(found))
    assert all(0 < end - begin <= LONGEST for begin, end in found)
    assert all(end - begin == 1 or 3 * size[0] * size[1] * (end - begin) <= MOST_BYTES for begin, end in found)


DENSITY = "  green: { height: [0.3, 0.5], place: { map: MAP } }"


def with_map(scene: Path, name: str) -> Path:
    """Path of the scene with a density map."""
    scene.write_text(scene.read_text().replace("  green: { height: [0.3, 0.5] }", DENSITY.replace("MAP", name)))
    return scene


def test_a_parcel_brings_the_maps_of_a_scene_under_their_names(scene: Path, tmp_path: Path) -> None:
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps" / "here.png").write_bytes(b"bytes of a map")
    (tmp_path / "private.png").write_bytes(b"what no scene names")
    parcel = packed(take_of(with_map(scene, "maps/here.png")), read_scene(scene))
    assert parcel.files.keys() == {"little.yaml", "maps/here.png"}
    there = tmp_path / "there"
    take = unpack(parcel, there)
    assert take.scene == str(there / "little.yaml")
    assert (there / "maps" / "here.png").read_bytes() == b"bytes of a map"
    assert str(tmp_path) not in repr(parcel)


@pytest.mark.parametrize("name", ["../map.png", "sub/../../map.png", "/ROOT/map.png", "link.png"])
def test_what_lies_outside_of_the_scenes_folder_is_not_sent(tmp_path: Path, scene: Path, name: str) -> None:
    folder = tmp_path / "folder"
    (folder / "sub").mkdir(parents=True)
    (tmp_path / "map.png").write_bytes(b"a secret")
    (folder / "link.png").symlink_to(tmp_path / "map.png")
    inner = folder / scene.name
    inner.write_text(scene.read_text())
    name = name.replace("/ROOT", str(tmp_path))
    with pytest.raises(InputError, match=f"--on: .*little.yaml: '{name}' lies outside the scene's folder"):
        packed(take_of(inner), read_scene(with_map(inner, name)))


def test_a_scene_takes_nothing_of_the_workers_own_files(scene: Path, tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "own.png").write_bytes(b"the worker's")
    parcel = Parcel(Take("little.yaml", (64, 36)), {"little.yaml": with_map(scene, "own.png").read_bytes()}, "mark")
    with pytest.raises(InputError, match=r"--on: little.yaml: 'own.png' was not sent to the worker"):
        unpack(parcel, tmp_path / "there")
