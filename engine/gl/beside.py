"""Programs that a driver makes beside the frames, in threads of its own."""

from collections.abc import Iterable, Iterator
from ctypes import addressof, c_char_p, c_int
from time import sleep

import moderngl

from .functions import NUMBERS, functions_of
from .limits import limits_of
from .rasteriser import draws_in_software
from .shaders import Texts


def makes_beside(ctx: moderngl.Context, /) -> bool:
    """Return whether the driver makes programs in threads of its own; without a card these would hold the frames up."""
    return bool(limits_of(functions_of(ctx)).beside) and not draws_in_software(ctx)


AS_MANY = -1
"""Threads that a driver may take, of its own choice. NVIDIA's takes none before it is told; others take some anyway."""

WAITS = 0.002
"""Time between two looks at whether a program is made [s]."""


class Beside:
    """Lets a driver make programs that will be wanted, while frames go on.

    What it makes is thrown away: drivers keep the outcome by its texts, to the letter, so that to make the same program
    soon after, or in another process, takes a moment. Where a driver keeps nothing, no harm is done.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx, self._gl = ctx, functions_of(ctx)
        self._underway: list[int] = []

    def making(self, texts: Iterable[Texts], /) -> Iterator[None]:
        """Let it make programs, one more at a time, and go on until it has; without such a driver it ends at once."""
        if not makes_beside(self._ctx):
            return
        for each in texts:
            self.ask(each)
            yield
        while self.left:
            yield

    def waiting(self, texts: Iterable[Texts], /) -> Iterator[None]:
        """Let it make programs, all at once, and wait for one after the other; else it ends at once."""
        if not makes_beside(self._ctx):
            return
        for each in texts:
            self.ask(each)
        for number in reversed(range(self.left)):
            while self.left > number:
                sleep(WAITS)
            yield

    def ask(self, texts: Texts, /) -> None:
        """Let it make one more; whether that can be made is not looked at here."""
        gl = self._gl
        getattr(gl, f"glMaxShaderCompilerThreads{limits_of(gl).beside}")(AS_MANY)
        made = gl.glCreateProgram()
        for stage, text in (("VERTEX_SHADER", texts.vertex), ("FRAGMENT_SHADER", texts.fragment)):
            shader = gl.glCreateShader(NUMBERS[stage])
            given = (c_char_p * 1)(text.strip().encode())  # as moderngl gives it
            gl.glShaderSource(shader, 1, addressof(given), None)
            gl.glCompileShader(shader)
            gl.glAttachShader(made, shader)
            gl.glDeleteShader(shader)  # it stays for as long as the program does
        gl.glLinkProgram(made)
        self._underway.append(made)

    @property
    def left(self) -> int:
        """How many of them are not made yet; asking does not wait."""
        made = [number for number in self._underway if self._is_made(number)]
        for number in made:
            self._gl.glDeleteProgram(number)
        self._underway = [number for number in self._underway if number not in made]
        return len(self._underway)

    def release(self) -> None:
        """Give back what is underway."""
        while self._underway:
            self._gl.glDeleteProgram(self._underway.pop())

    def _is_made(self, number: int) -> bool:
        found = (c_int * 1)()
        self._gl.glGetProgramiv(number, NUMBERS["COMPLETION_STATUS"], addressof(found))
        return bool(found[0])
