# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual in the extension's zip: README, `docs/` and the docstrings of `core/` as HTML that needs no network.

    python manual.py COPY      adds it to a copy of the add-on, whose README then leads into it

It needs markdown-it-py, pdoc and numpy; Blender is not started.
"""

from __future__ import annotations

import html
import importlib.util
import re
import shutil
import sys
from pathlib import Path

import pdoc
import pdoc.render
from markdown_it import MarkdownIt

ROOT = Path(__file__).resolve().parent.parent.parent
PICTURES = ROOT / "tests" / "window" / "pictures"
PACKAGE = "body_moments"
NAME = "Body Moments"
FOLDER = "manual"  # in the zip; `panels/menus.py` opens its pages

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
{style}
</style>
</head>
<body>
<nav>{navigation}</nav>
<main>
{body}
</main>
</body>
</html>
"""
STYLE = """\
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; margin: 0; display: flex; flex-wrap: wrap; }
nav { flex: 0 0 13rem; padding: 1.5rem; font-size: 0.9rem; }
nav a { display: block; padding: 0.15rem 0; text-decoration: none; }
main { flex: 1 1 30rem; max-width: 52rem; padding: 1rem 1.5rem 4rem; overflow-wrap: break-word; }
img { max-width: 100%; }
table { border-collapse: collapse; display: block; overflow-x: auto; }
td, th { border: 1px solid #8886; padding: 0.3rem 0.6rem; text-align: left; vertical-align: top; }
pre { background: #8882; padding: 0.8rem; overflow-x: auto; }
code { font-family: ui-monospace, monospace; font-size: 0.9em; }"""


def page_name(path: Path) -> str:
    """The name of the page that a document becomes."""
    if path == ROOT / "README.md":
        return "index.html"
    return path.stem.lower() + ".html"


def documents() -> list[Path]:
    """README, the pages in the order in which README names them, and the list of changes."""
    readme = ROOT / "README.md"
    linked = re.findall(r"\]\(((?:docs/)?[\w.-]+\.md)[)#]", readme.read_text(encoding="utf-8"))
    named = [ROOT / name for name in dict.fromkeys(linked)]
    return [readme, *named, *(path for path in sorted((ROOT / "docs").glob("*.md")) if path not in named)]


def title(text: str) -> str:
    return re.search(r"^# (.+)$", text, re.M).group(1)


def anchor(heading: str) -> str:
    """A heading's anchor, as the sites make it that show Markdown."""
    return re.sub(r"[^\w\- ]", "", re.sub(r"[`*]", "", heading).lower()).replace(" ", "-")


def target(link: str, document: Path, prefix: str = "") -> str:
    """Return the target of a document's link in the manual. prefix: from the page to the manual's folder."""
    path, _, place = link.partition("#")
    if not path:
        return link
    if re.match(r"\w+:", path):
        raise ValueError("{}: {} is no link within the manual".format(document.name, link))
    file = (document.parent / path).resolve()
    if not file.is_file():
        raise ValueError("{}: there is no {}".format(document.name, link))
    if file.suffix == ".md":
        return prefix + page_name(file) + ("#" + place if place else "")
    if file.parent == PICTURES:
        return prefix + "pictures/" + file.name
    return prefix + file.name


def to_html(document: Path, navigation: str) -> str:
    text = document.read_text(encoding="utf-8")
    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = markdown.parse(text)
    for number, token in enumerate(tokens):
        if token.type == "heading_open":
            token.attrSet("id", anchor(tokens[number + 1].content))
        for child in token.children or ():
            for attribute in ("href", "src"):
                if link := child.attrGet(attribute):
                    child.attrSet(attribute, target(link, document))
    body = markdown.renderer.render(tokens, markdown.options, {})
    return PAGE.format(title=html.escape(title(text)), style=STYLE, navigation=navigation, body=body)


def readme() -> str:
    """README as it stands in the zip, beside the manual's folder: its links lead into it."""
    path = ROOT / "README.md"
    text = path.read_text(encoding="utf-8")
    return re.sub(r"\]\(([^)]+)\)", lambda match: "]({})".format(target(match[1], path, FOLDER + "/")), text)


def import_package() -> None:
    """Load the repository's root under the add-on's name, whatever its folder is called."""
    if PACKAGE not in sys.modules:
        spec = importlib.util.spec_from_file_location(
            PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
        )
        sys.modules[PACKAGE] = module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)


def build(folder: Path) -> None:
    """Write the manual into a folder that is new or empty."""
    shutil.copytree(PICTURES, folder / "pictures")
    pages = documents()
    entries = [("index.html", NAME)]
    entries += [(page_name(path), title(path.read_text(encoding="utf-8"))) for path in pages[1:]]
    entries.append(("python/body_moments/core.html", "Python: core"))
    navigation = "".join('<a href="{}">{}</a>'.format(page, html.escape(name)) for page, name in entries)
    for path in pages:
        (folder / page_name(path)).write_text(to_html(path, navigation), encoding="utf-8")
        for link in re.findall(r"\]\(([^)#]+)", path.read_text(encoding="utf-8")):
            file = (path.parent / link).resolve()
            if file.suffix != ".md" and file.parent != PICTURES:
                shutil.copy(file, folder / file.name)
    import_package()
    faces = sorted(path.parent.name for path in (ROOT / "core").glob("*/__init__.py"))
    pdoc.render.configure(
        docformat="numpy", show_source=False, search=False, template_directory=Path(__file__).with_name("manual_theme")
    )
    names = [PACKAGE + ".core", *(PACKAGE + ".core." + face for face in faces)]
    hidden = [
        r"!{}\.core\.{}\..+".format(PACKAGE, face) for face in faces if face != "papers"
    ]  # modules: faces offer what they define
    pdoc.pdoc(*names, *hidden, output_directory=folder / "python")
    for name in ("index.html", "search.js"):  # a list of one package, and what is not searched
        (folder / "python" / name).unlink(missing_ok=True)


if __name__ == "__main__":
    copy = Path(sys.argv[1])
    build(copy / FOLDER)
    (copy / "README.md").write_text(readme(), encoding="utf-8")
