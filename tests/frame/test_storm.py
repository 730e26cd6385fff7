"""All winds at once replay bit for bit, for any time steps (N5)."""

import os
import pickle
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import moderngl
import pytest

from tallgrass.systems.prairie import Prairie

Key = tuple[Any, ...]
Instants = list[dict[Key, tuple[bytes, bytes]]]

PROGRAM = """
import pickle, sys
from hashlib import blake2b
import moderngl, numpy as np
from tallgrass.engine.camera import camera_at, projection_matrix, view_matrix
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import carpet_painter

path, rate, first, count = sys.argv[1], *map(int, sys.argv[2:])
ctx = moderngl.create_context(standalone=True, backend="egl", require=330)
size = (32, 18)
target = ctx.framebuffer([ctx.texture(size, 3, alignment=1)], ctx.depth_renderbuffer(size))
target.use()
prairie = Prairie.load("storm", ctx=ctx, preset="low", live=False)
for _ in range(rate * first):
    prairie.advance(1 / rate)


def digest(array):
    return blake2b(array.tobytes(), digest_size=8).digest()


def received():
    # By its places what each patch's receivers hold: what numpy says, and what the graphics card does.
    outlook, painter, told = prairie.viewers["main"], prairie.painter, {}
    counts = [count for each in painter.painters.values() for count in each.receivers(outlook)]
    first = iter(painter.received.allocate(counts))
    texels = np.frombuffer(painter.received.texture.read(), np.float32).reshape(-1, 4)
    for receiving in (*outlook.kept["blades"].receiving, *outlook.kept["strips"].receiving):
        slots, each = receiving.slots, int(np.prod(receiving.pool.shape))
        place = receiving.pool.places(slots).reshape(-1, each, 2)
        heard = receiving.messages.heard(slots).reshape(-1, each, 2)
        start = next(first)
        card = texels[start : start + len(slots) * each].reshape(-1, each, 4)
        for where, *what in zip(place, heard, card):
            told[each, *where[0].tolist(), digest(where)] = tuple(map(digest, what))
    (carpet,), patches = outlook.kept["carpet"].receiving, outlook.patches
    rows = (patches.alive & patches.visible).nonzero()[0]
    air = np.frombuffer(carpet_painter(painter).air.texture.read(), np.float32).reshape(-1, 2)
    for row, heard in zip(rows, carpet.messages.heard(rows)):
        told["carpet", *patches.cell[row].tolist()] = heard.tobytes(), air[row].tobytes()
    return told


story = []
for step in range(count * rate // 30):
    instant = step % (rate // 30) == 0
    if instant or step % 8 == 1:
        camera = camera_at(prairie.scene.camera, prairie.time, prairie.height_at)
        prairie.draw(view_matrix(camera), projection_matrix(camera.view, 16 / 9))
    if instant:
        story.append(received())
    prairie.advance(1 / rate)
assert not prairie.winds.quarantine.reasons
with open(path, "wb") as file:
    pickle.dump(story, file)
"""
FIRST, COUNT = 7, 24


def played(ctx: moderngl.Context, folder: Path) -> list[Instants]:
    """Messages of all receivers at some times of the storm, from two processes with steps of 1/60 and 1/30 s."""
    Prairie.load("storm", ctx=ctx, preset="low").release()  # grown once, for both
    told = []
    for rate in (60, 30):  # one after the other: the second takes its programs from the driver's cache
        path = folder / f"{rate}.pickle"
        command = [sys.executable, "-W", "error", "-c", PROGRAM, *map(str, (path, rate, FIRST, COUNT))]
        settings = os.environ | {"PYTHONHASHSEED": str(rate)}
        done = subprocess.run(command, env=settings, capture_output=True, text=True, check=False, timeout=300)
        assert done.returncode == 0, done.stderr
        told.append(pickle.loads(path.read_bytes()))  # noqa: S301 - written just now
    return told


@pytest.mark.slow
def test_n5_the_storm_goes_on_and_is_the_same_bit_for_bit_whatever_steps_led_to_an_instant(
    ctx: moderngl.Context, tmp_path: Path
) -> None:
    one, other = played(ctx, tmp_path)
    assert len(one) == len(other) == COUNT
    together = everything = 0
    for number, (ours, theirs) in enumerate(zip(one, other, strict=True)):
        common = ours.keys() & theirs.keys()
        together += len(common)
        everything += len(ours.keys() | theirs.keys())
        differing = [key for key in common if ours[key] != theirs[key]]
        assert not differing, f"at instant {number}: {sorted(differing, key=str)[:5]}"
    assert together > 0.97 * everything
    for before, after in pairwise(one):
        common = before.keys() & after.keys()
        for which in (0, 1):
            assert sum(before[key][which] != after[key][which] for key in common) > 0.99 * len(common)
