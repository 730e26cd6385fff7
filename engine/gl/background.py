"""Compiling programs in the driver's own threads, while frames go on."""

from collections.abc import Iterable, Iterator
from ctypes import addressof, c_char_p, c_int
from time import sleep

import moderngl

from .functions import ENUMS, functions_of
from .limits import limits_of
from .rasteriser import draws_in_software
from .shaders import Texts


def compiles_in_background(ctx: moderngl.Context, /) -> bool:
    """Return whether the driver compiles in its own threads; without a card, these threads would hold frames up."""
    return bool(limits_of(functions_of(ctx)).parallel_compile) and not draws_in_software(ctx)


AS_MANY = -1
"""Number of compiler threads: the driver's own choice. NVIDIA's starts none unless asked, other drivers do anyway."""

WAITS = 0.002
"""Time between two polls of a program's completion [s]."""


class BackgroundCompiler:
    """Fills the driver's shader cache with programs that will be needed, while frames go on.

    The programs themselves are thrown away. Drivers cache by exact source text, so that compiling the same program
    soon after, or in another process, takes a moment. Where a driver has no cache, no harm is done.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx, self._gl = ctx, functions_of(ctx)
        self._underway: list[int] = []

    def compile_in_turn(self, texts: Iterable[Texts], /) -> Iterator[None]:
        """Start one program a step, then go on until all are done; ends at once where the driver has no threads."""
        if not compiles_in_background(self._ctx):
            return
        for each in texts:
            self.start(each)
            yield
        while self.pending:
            yield

    def compile_together(self, texts: Iterable[Texts], /) -> Iterator[None]:
        """Start all programs, then wait for one a step; ends at once where the driver has no threads."""
        if not compiles_in_background(self._ctx):
            return
        for each in texts:
            self.start(each)
        for number in reversed(range(self.pending)):
            while self.pending > number:
                sleep(WAITS)
            yield

    def start(self, texts: Texts, /) -> None:
        """Start one program; errors in it are not reported."""
        gl = self._gl
        getattr(gl, f"glMaxShaderCompilerThreads{limits_of(gl).parallel_compile}")(AS_MANY)
        made = gl.glCreateProgram()
        for stage, text in (("VERTEX_SHADER", texts.vertex), ("FRAGMENT_SHADER", texts.fragment)):
            shader = gl.glCreateShader(ENUMS[stage])
            given = (c_char_p * 1)(text.strip().encode())  # as moderngl gives it
            gl.glShaderSource(shader, 1, addressof(given), None)
            gl.glCompileShader(shader)
            gl.glAttachShader(made, shader)
            gl.glDeleteShader(shader)  # it stays for as long as the program does
        gl.glLinkProgram(made)
        self._underway.append(made)

    @property
    def pending(self) -> int:
        """Number of programs that are not done yet; reading it does not wait."""
        made = [number for number in self._underway if self._is_made(number)]
        for number in made:
            self._gl.glDeleteProgram(number)
        self._underway = [number for number in self._underway if number not in made]
        return len(self._underway)

    def release(self) -> None:
        """Delete the programs that are not done yet."""
        while self._underway:
            self._gl.glDeleteProgram(self._underway.pop())

    def _is_made(self, number: int) -> bool:
        found = (c_int * 1)()
        self._gl.glGetProgramiv(number, ENUMS["COMPLETION_STATUS"], addressof(found))
        return bool(found[0])
