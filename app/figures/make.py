"""`tallgrass figures`: the paper's figures and a page that shows them."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..studio.encode import make_folder
from ..studio.errors import InputError, needed
from ..studio.progress import counted

if TYPE_CHECKING:
    from .figure import PaperFigure


def make_figures(output: str, *, only: str | None, size: tuple[int, int], preset: str | None) -> None:
    """Draw the paper's figures into a folder, and the page `index.html` that shows all that lie there.

    `only` is the numbers of some, as `6,8`; `size` is that of each rendered picture [pixels], `preset` its quality
    in place of the scenes' own. Raises InputError where the folder cannot be written or a number is no figure's,
    MachineError without Matplotlib or without OpenGL.
    """
    need_matplotlib()
    from .figure import Detail
    from .page import index_page
    from .plot import look, put_on_paper
    from .register import FIGURES

    chosen = FIGURES if only is None else choose(FIGURES, only)
    folder = Path(output)
    make_folder(folder)
    detail = Detail(size=size, preset=preset)
    for each in counted(chosen, total=len(chosen), doing="drawing figures"):
        with look():
            put_on_paper(each.draw(detail), folder / each.file, title=f"Figure {each.number}: {each.title}")
    there = [each for each in FIGURES if (folder / each.file).is_file()]
    (folder / "index.html").write_text(index_page(there), "utf-8")


def choose(figures: Sequence["PaperFigure"], only: str, /) -> list["PaperFigure"]:
    """Return the figures of these numbers, written as `6,8`; raises InputError for any other text."""
    numbers = [each.number for each in figures]
    words = [word.strip() for word in only.split(",")]
    for word in words:
        if not re.fullmatch("[0-9]{1,4}", word) or int(word) not in numbers:
            raise InputError(f"--only: {word!r} is no figure; there are {', '.join(map(str, numbers))}")
    wanted = {int(word) for word in words}
    return [each for each in figures if each.number in wanted]


def need_matplotlib() -> None:
    """Raise MachineError where Matplotlib is not installed."""
    needed("matplotlib", "figures are drawn by Matplotlib", extra="figures")
