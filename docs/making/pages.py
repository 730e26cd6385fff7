"""`python -m docs.making.pages`: writes what is generated into the manual's pages; with `--check`, names stale ones."""

import re
import sys
from pathlib import Path

from .api import api, testing
from .examples import example_pages
from .reference import scene_reference

DOCS = Path(__file__).parents[1]
END = "<!-- end of what is generated -->"
PART = re.compile(rf"^<!-- generated: (?P<what>\w+) -->$.*?^{END}$", re.MULTILINE | re.DOTALL)
GENERATED = {
    "api": api,
    "testing": testing,
    "scene": scene_reference,
    "examples": example_pages,
}


def main() -> None:
    """Write the pages, or leave Python with status 1 where some would change."""
    stale = write(check="--check" in sys.argv[1:])
    sys.exit(f"to be written again by python -m docs.making.pages: {', '.join(stale)}" if stale else 0)


def write(*, check: bool = False) -> list[str]:
    """Write the generated parts of the pages; with `check`, only return the names of pages that would change."""
    stale = []
    for page in sorted(DOCS.glob("*.md")):
        before = page.read_text("utf-8")
        after = complete(before)
        if after != before and check:
            stale.append(page.name)
        elif after != before:
            page.write_text(after, "utf-8")
    return stale


def complete(text: str, /) -> str:
    """Return a page with what is generated in its places."""
    return PART.sub(lambda part: f"<!-- generated: {part['what']} -->\n\n{GENERATED[part['what']]()}\n{END}", text)


if __name__ == "__main__":
    main()
