"""Texture units: those that a guest uses, and what a host has on them."""

from ctypes import addressof, c_int

from .functions import NUMBERS, Functions

FIRST_UNIT = 32
"""The first texture unit that is used: OpenGL 3.3 has 48, and hosts use the first few, with textures and samplers."""

UNITS = range(FIRST_UNIT, 48)
"""All that are used."""

BORROWED = range(27, 31)
"""Those that a host's own textures are bound to for a frame, and given back after it. The one above them is where
moderngl loads textures on most cards: what it leaves there would be read, and drivers make a program anew for that."""

SCRATCH_UNIT = 15
"""Where textures are loaded that no host's own moderngl context loads: every OpenGL has it, and it is kept."""

LOADED = {
    "TEXTURE_2D": "TEXTURE_BINDING_2D", "TEXTURE_3D": "TEXTURE_BINDING_3D",
    "TEXTURE_2D_ARRAY": "TEXTURE_BINDING_2D_ARRAY",
}  # fmt: skip
"""The sorts of texture that are loaded, and what says which one is bound."""


_FOUND = (c_int * len(UNITS))()
_FOUND_AT = addressof(_FOUND)
"""Where answers are written; ctypes takes addresses faster than arrays."""


class Units:
    """A host's sampler objects on the units that are used, and its textures on `scratch`, where textures are loaded.

    `clear` takes the samplers off, `borrow` takes a unit that is not among them, and `restore` brings all of it back.
    Each leaves another unit active.
    """

    def __init__(self, gl: Functions, scratch: int) -> None:
        self._gl, self._scratch = gl, scratch
        self._activate(scratch)
        self._textures = {target: self._gl.number(name) for target, name in LOADED.items()}
        self._samplers = self._bound()
        self._borrowed: dict[int, tuple[int, int]] = {}

    def borrow(self, unit: int, texture: int) -> None:
        """Bind a 2D texture to a unit that the host has something else on, until all is brought back."""
        self._activate(unit)
        if unit not in self._borrowed:
            self._borrowed[unit] = self._gl.number("TEXTURE_BINDING_2D"), self._gl.number("SAMPLER_BINDING")
        self._gl.glBindTexture(NUMBERS["TEXTURE_2D"], texture)

    def clear(self) -> None:
        """Let textures be read as they say themselves."""
        for unit in self._samplers:
            self._gl.glBindSampler(unit, 0)

    def restore(self) -> None:
        """Bring the host's back."""
        for unit, sampler in self._samplers.items():
            self._gl.glBindSampler(unit, self._gl.living("Sampler", sampler))
        for unit, (texture, sampler) in self._borrowed.items():
            self._activate(unit)
            self._gl.glBindTexture(NUMBERS["TEXTURE_2D"], self._gl.living("Texture", texture))
            self._gl.glBindSampler(unit, self._gl.living("Sampler", sampler))
        self._activate(self._scratch)
        for target, texture in self._textures.items():
            self._gl.glBindTexture(NUMBERS[target], self._gl.living("Texture", texture))

    def _bound(self) -> dict[int, int]:
        """Return the sampler objects, by unit."""
        gl, first, question = self._gl, NUMBERS["TEXTURE0"] + FIRST_UNIT, NUMBERS["SAMPLER_BINDING"]
        for place in range(len(UNITS)):
            gl.glActiveTexture(first + place)
            gl.glGetIntegerv(question, _FOUND_AT + 4 * place)
        return {unit: sampler for unit, sampler in zip(UNITS, _FOUND, strict=True) if sampler}

    def _activate(self, unit: int) -> None:
        self._gl.glActiveTexture(NUMBERS["TEXTURE0"] + unit)
