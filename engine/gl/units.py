"""Texture units that a guest uses, and saving what a host has bound to them."""

from ctypes import addressof, c_int

from .functions import ENUMS, Functions

FIRST_UNIT = 32
"""First texture unit that a guest uses. OpenGL 3.3 has 48 units, and hosts use the first few."""

UNITS = range(FIRST_UNIT, 48)
"""Texture units that a guest uses."""

BORROWED = range(27, 31)
"""Units that textures of the host are bound to for a frame, and restored after it.

Unit 31 is not among them: on most cards moderngl loads textures there. Programs would read what it leaves bound, and
drivers recompile a program for that.
"""

SCRATCH_UNIT = 15
"""Unit on which our own moderngl context loads textures: every OpenGL has it, and its bindings are restored."""

LOADED = {
    "TEXTURE_2D": "TEXTURE_BINDING_2D", "TEXTURE_3D": "TEXTURE_BINDING_3D",
    "TEXTURE_2D_ARRAY": "TEXTURE_BINDING_2D_ARRAY",
}  # fmt: skip
"""Targets of textures that are loaded, and the state that has the texture bound to each."""


_FOUND = (c_int * len(UNITS))()
_FOUND_AT = addressof(_FOUND)
"""Address for results of queries; ctypes passes integers faster than arrays."""


class Units:
    """Snapshot of a host's sampler objects on `UNITS`, and of its textures on the unit `scratch` for loading textures.

    `clear` unbinds the samplers, `borrow` takes a further unit, and `restore` brings all back. Each of them changes the
    active unit.
    """

    def __init__(self, gl: Functions, scratch: int) -> None:
        self._gl, self._scratch = gl, scratch
        self._activate(scratch)
        self._textures = {target: self._gl.number(name) for target, name in LOADED.items()}
        self._samplers = self._bound()
        self._borrowed: dict[int, tuple[int, int]] = {}

    def borrow(self, unit: int, texture: int) -> None:
        """Bind a 2D texture to a unit of the host, until `restore`."""
        self._activate(unit)
        if unit not in self._borrowed:
            self._borrowed[unit] = self._gl.number("TEXTURE_BINDING_2D"), self._gl.number("SAMPLER_BINDING")
        self._gl.glBindTexture(ENUMS["TEXTURE_2D"], texture)

    def clear(self) -> None:
        """Unbind the host's samplers, so that textures are read with their own parameters."""
        for unit in self._samplers:
            self._gl.glBindSampler(unit, 0)

    def restore(self) -> None:
        """Bind the host's samplers and textures again."""
        for unit, sampler in self._samplers.items():
            self._gl.glBindSampler(unit, self._gl.living("Sampler", sampler))
        for unit, (texture, sampler) in self._borrowed.items():
            self._activate(unit)
            self._gl.glBindTexture(ENUMS["TEXTURE_2D"], self._gl.living("Texture", texture))
            self._gl.glBindSampler(unit, self._gl.living("Sampler", sampler))
        self._activate(self._scratch)
        for target, texture in self._textures.items():
            self._gl.glBindTexture(ENUMS[target], self._gl.living("Texture", texture))

    def _bound(self) -> dict[int, int]:
        """Return the host's sampler objects by unit, those that are bound."""
        gl, first, question = self._gl, ENUMS["TEXTURE0"] + FIRST_UNIT, ENUMS["SAMPLER_BINDING"]
        for place in range(len(UNITS)):
            gl.glActiveTexture(first + place)
            gl.glGetIntegerv(question, _FOUND_AT + 4 * place)
        return {unit: sampler for unit, sampler in zip(UNITS, _FOUND, strict=True) if sampler}

    def _activate(self, unit: int) -> None:
        self._gl.glActiveTexture(ENUMS["TEXTURE0"] + unit)
