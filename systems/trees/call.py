"""Draw calls of trees, and what each must be told and must read that those before it do not."""

from collections.abc import Sequence
from typing import NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.gl.shaders import Due, due, due_all
from .card import ModelOnCard
from .kind import Read
from .outline import Around


class Call(NamedTuple):
    """One draw call of trees of a model."""

    turn: float
    """Those of which it is less are drawn before it: how far off its nearest tree is [m], or of soft edges, how much
    nearer than the eye its trees are in the mean."""

    array: moderngl.VertexArray
    first: int
    vertices: int
    instances: int
    form: int
    """How vertices make triangles."""

    due: Due
    """What its program is told of its kind, its model and of itself."""

    reads: Sequence[Read]
    """What it reads."""

    far: float = 0.0
    """How far off the farthest of its trees is, along the ground, where they stand among the grass [m]; infinite beyond
    it, and 0 before it. Soft edges come after grass farther off."""

    begins: bool = False
    """Whether it is the first one with its program."""


def in_turn(calls: Sequence[Call], /) -> list[Call]:
    """Return calls that are drawn one after another: each is told and binds only what is not so by those before it."""
    told, bound = dict[int, tuple[object]](), dict[int, Read]()
    programs, found = set[int](), list[Call]()
    for call in calls:
        due_now = [each for each in call.due if told.get(id(each[0])) != (each[1],)]
        told.update((id(each[0]), (each[1],)) for each in call.due)
        reads = [each for each in call.reads if bound.get(each.unit) != each]
        bound.update((each.unit, each) for each in reads)
        program = id(call.array.program)
        found.append(call._replace(due=due_now, reads=reads, begins=program not in programs))
        programs.add(program)
    return found


def told_of_call(
    program: moderngl.Program,
    corners: list[tuple[float, float]],
    around: Around | None,
    solid_from: float,
    *,
    casts: bool,
) -> Due:
    """Return what a program is told of a call: how much of a pixel is opaque, and the corners of an outline, if any.

    What `casts` a shadow is nowhere but where it is.
    """
    told = due(program, {"solid_from": (solid_from,)}) + (due(program, {"behind": (0.0,)}) if casts else [])
    if corners:
        told += due_all(program, "corners", corners)
    if around is not None:
        told += due(program, {"high": around.high}) + due_all(program, "reaches", around.reaches)
    return told


def part_of_wood(model: ModelOnCard, name: str, *, soft: bool, whole: bool) -> tuple[int, int]:
    """Return from which vertex on, and how many, are drawn of the wood of a stream's trees."""
    drawn, run = model.wood[name], model.run[name]
    end = len(model.model.wood[run].triangles) if whole else drawn.soft if soft else drawn.solid
    return 3 * model.first_of[run], 3 * end


def off_of(placed: NDArray[np.void], eye: Doubles, /) -> tuple[Doubles, Doubles]:
    """Return how far off crowns of trees are, records of `PLACED`, shape (n,) [m]; and how far along the ground."""
    to = placed["root"] + placed["crown_at"][:, None] * np.array([0.0, 1.0, 0.0], np.float32) - eye
    return np.linalg.norm(to, axis=1), np.hypot(to[:, 0], to[:, 2])


def bound_by(calls: Sequence[Call], /) -> list[Read]:
    """Return what is bound once calls have been drawn, one after another."""
    return list({read.unit: read for call in calls for read in call.reads}.values())
