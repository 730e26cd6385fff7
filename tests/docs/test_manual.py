"""Generated parts of the manual are complete: every key of a scene, every public name, every picture."""

import importlib.util
import inspect
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any, get_args

import pytest
from pydantic import BaseModel

import tallgrass
import tallgrass.testing
from tallgrass.app.figures.register import FIGURES
from tallgrass.components.wind import WindPrimitive
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.engine.declared.scene import Scene
from tallgrass.engine.installed import OURS
from tallgrass.engine.plugins import wind_kinds

DOCS = Path(__file__).parents[2] / "docs"
FACES = [(tallgrass, name) for name in tallgrass.__all__] + [
    (tallgrass.testing, name) for name in tallgrass.testing.__all__
]
UNITS = re.compile(
    r"\[(m|s|1/s|ms|rad|degrees|m/s|turns/s|pixels|levels of 255|patch sides|bytes|ns)\]|posture ind|shape",
)


def making(name: str) -> ModuleType:
    """Return a module of `docs/making`."""
    spec = importlib.util.spec_from_file_location(f"making_{name}", DOCS / "making" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def models(annotation: Any) -> Iterator[type[BaseModel]]:
    """Yield the models in an annotation, and those in their fields."""
    if inspect.isclass(annotation) and issubclass(annotation, BaseModel) and annotation is not WindPrimitive:
        yield annotation
        for field in annotation.model_fields.values():
            yield from models(field.annotation)
    for inner in get_args(annotation):
        yield from models(inner)


def all_models() -> list[type[BaseModel]]:
    kinds = [wind_kinds().find(row.name) for row in wind_kinds().provided() if row.distribution == OURS]
    return list(dict.fromkeys([*models(Scene), *(inner for kind in kinds for inner in models(kind))]))


@pytest.fixture(scope="module")
def reference() -> str:
    return str(making("reference").scene_reference())


def test_d4_no_key_of_any_model_is_missing_from_the_scene_reference(reference: str) -> None:
    sections = reference.split("\n## ")
    tables = {frozenset(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE)): section for section in sections}
    found = all_models()
    assert len(found) >= 15
    for model in found:
        keys = set(model.model_fields)
        same = [table for table in tables if keys <= table and table - keys <= set(PRESETS)]
        assert same, f"no table has the keys of {model.__name__}"
        for name, field in model.model_fields.items():
            sentence = " ".join((field.description or "").split("\n\n")[0].split())
            told = re.sub(r"\s*\[[A-Za-z/]+\]", "", sentence)
            assert told in tables[same[0]], f"{model.__name__}.{name}"


def test_every_row_of_the_reference_has_what_a_key_takes_and_what_it_is(reference: str) -> None:
    rows = re.findall(r"^\| `\w+` \|.*$", reference, re.MULTILINE)
    assert len(rows) > 100
    for row in rows:
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        if len(cells) == 6:
            assert cells[1], row
            assert cells[5].endswith("."), row


def test_ranges_units_and_defaults_are_those_of_the_models(reference: str) -> None:
    assert "| `speed` | a number | m/s | above 0.1, at most 60 | 8 | Speed at which it travels. |" in reference
    assert "| `turning` | a number | turns/s | 0 to 10 | 0.35 | Speed at which its stronger sides turn. |" in reference
    assert "| `tip` | a colour, `#a8b65a` or `red` |  |  | #a8b65a | Colour at the tip. |" in reference


def test_a_key_is_required_on_the_page_where_a_scene_without_it_is_refused(reference: str) -> None:
    told = set(re.findall(r"^\| `(\w+)` \|(?:[^|]*\|){3} required \|", reference, re.MULTILINE))
    required = {key for model in all_models() for key, field in model.model_fields.items() if field.is_required()}
    assert told == required | {"kind"}, "a wind's kind has a default in Python alone"


def test_every_link_of_the_reference_leads_to_a_heading_of_it(reference: str) -> None:
    module = making("reference")
    headings = {module.anchor(title) for title in re.findall(r"^## (.+)$", reference, re.MULTILINE)}
    linked = set(re.findall(r"\]\(#([^)]+)\)", reference))
    assert linked
    assert linked <= headings


def test_every_preset_is_in_the_reference_and_on_the_page_of_performance(reference: str) -> None:
    page = (DOCS / "performance.md").read_text("utf-8")
    for name in PRESETS:
        assert f"| `{name}` |" in reference
        assert f"`{name}`" in page


def test_every_picture_of_the_pages_is_made_and_every_picture_that_is_made_is_shown() -> None:
    pictures = making("pictures")
    shown = {name for page in DOCS.glob("*.md") for name in re.findall(r"\]\(pictures/([^)]+)\)", page.read_text())}
    made = {picture.file for picture in pictures.PICTURES}
    assert made <= shown
    assert shown <= made | {figure.file for figure in FIGURES}
    assert len(pictures.figures_shown()) >= 11
    for picture in pictures.PICTURES:
        if picture.page is not None:
            assert picture.command[1] in pictures.named_blocks(DOCS / picture.page)


def test_every_link_leads_to_a_heading_that_is_there() -> None:
    pages = [*DOCS.glob("*.md"), *(DOCS.parent / name for name in ("README.md", "CONVENTIONS.md"))]
    texts = {page.resolve(): re.sub(r"(?ms)^```.*?^```$", "", page.read_text("utf-8")) for page in pages}
    anchor = making("reference").anchor
    headings = {page: {*map(anchor, re.findall(r"^#+ (.+)$", text, re.MULTILINE))} for page, text in texts.items()}
    for page, text in texts.items():
        for name, heading in re.findall(r"\]\(([\w./-]*)#([^)]+)\)", text):
            at = (page.parent / name).resolve() if name else page
            assert heading in headings[at], f"{page.name}: {name}#{heading}"


def test_every_example_is_on_the_page_of_examples() -> None:
    examples = making("examples")
    page = examples.with_sources((DOCS / "examples.md").read_text("utf-8"))
    for name, files in examples.examples().items():
        assert f"## {name}\n" in page
        for file in files:
            assert file.read_text("utf-8").strip() in page


def test_every_public_name_is_on_the_page_of_the_api_with_its_text_and_its_members() -> None:
    page = (DOCS / "api.md").read_text("utf-8")
    entries = re.findall(r"^### (\w+)$", page, re.MULTILINE)
    assert sorted([*entries, "scenes"]) == sorted({*tallgrass.__all__, *tallgrass.testing.__all__})
    for name, thing in PUBLIC:
        owner, _, member = name.partition(".")
        if inspect.ismodule(thing):
            continue
        assert f"\n### {owner}\n" in page
        if member == "model_post_init":
            continue  # pydantic gives it to models with private attributes
        if member and member in told_of_bases(owner):
            continue
        first = (inspect.getdoc(thing) or "").split("\n\n")[0].splitlines()[0]
        assert first in page, name
        if inspect.isfunction(thing) and member:
            assert f"\n#### {name}\n\n```python\n{member}(" in page
    for name, told in FIELDS:
        assert f"\n- `{name.partition('.')[2]}" in page, name
        assert " ".join(told.split()) in " ".join(page.split()), name


def told_of_bases(name: str) -> set[str]:
    """Return the members of a public class that its bases' entries document."""
    bases = inspect.getmro(getattr(tallgrass, name, object))[1:]
    return {member for base in bases if base.__name__ in tallgrass.__all__ for member in vars(base)}


def parts(owner: ModuleType, name: str) -> Iterator[tuple[str, Any]]:
    """Yield a public name, and for a class its public methods and properties."""
    thing = getattr(owner, name)
    yield name, thing
    if inspect.isclass(thing):
        for inner, value in vars(thing).items():
            if inner.startswith("_") or inner == "model_config":
                continue
            plain = value.__func__ if isinstance(value, classmethod | staticmethod) else value
            if inspect.isfunction(plain) or isinstance(plain, property):
                yield f"{name}.{inner}", plain


PUBLIC = [part for owner, name in FACES for part in parts(owner, name) if not isinstance(part[1], str)]


@pytest.mark.parametrize(("name", "thing"), PUBLIC, ids=[name for name, _ in PUBLIC])
def test_every_public_name_says_what_it_is_in_a_sentence(name: str, thing: Any) -> None:
    text = inspect.getdoc(thing) if thing.__doc__ else None
    assert text, f"{name} has no docstring"
    first = text.split("\n\n")[0]
    assert first[0].isupper(), f"{name}: {first}"
    assert first.rstrip().endswith((".", ":")), f"{name}: {first}"


def fields(owner: ModuleType, name: str) -> Iterator[tuple[str, str]]:
    """Yield the annotated names in a public class's own body, with the docstring below each."""
    thing = getattr(owner, name)
    if not inspect.isclass(thing):
        return
    source = inspect.getsource(thing)
    for inner in [inner for inner in getattr(thing, "__annotations__", {}) if not inner.startswith("_")]:
        below = re.search(rf'^    {inner}:.*?\n    """(.*?)"""', source, re.MULTILINE | re.DOTALL)
        yield f"{name}.{inner}", below[1] if below else ""


FIELDS = [row for owner, name in FACES for row in fields(owner, name)]


@pytest.mark.parametrize(("name", "told"), FIELDS, ids=[name for name, _ in FIELDS])
def test_every_public_field_says_what_it_is(name: str, told: str) -> None:
    assert told.strip(), f"{name} has no docstring"


FUNCTIONS = [(name, thing) for name, thing in PUBLIC if inspect.isfunction(thing)]


@pytest.mark.parametrize(("name", "thing"), FUNCTIONS, ids=[name for name, _ in FUNCTIONS])
def test_every_number_and_array_of_a_public_function_has_its_unit_or_shape_said(name: str, thing: Any) -> None:
    kinds = [str(annotation) for annotation in thing.__annotations__.values()]
    measured = [kind for kind in kinds if re.search(r"\bfloat\b|NDArray|ndarray|ArrayLike", kind)]
    if measured:
        assert UNITS.search(told_of(name, thing)), f"{name} takes or returns {measured}"


def told_of(name: str, thing: Any) -> str:
    """Return the text on a public function; for a method also those of its class and of methods it overrides."""
    first, _, method = name.partition(".")
    owner = getattr(tallgrass, first, None) or getattr(tallgrass.testing, first)
    said = [thing.__doc__, owner.__doc__]
    said += [getattr(base, method).__doc__ for base in inspect.getmro(owner) if hasattr(base, method)] if method else []
    return "\n".join(filter(None, said))
