# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual in the zip: links and search need no network, and every button and setting has its
page.
"""

import importlib
import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from tools import manual

bpy = pytest.importorskip("bpy")
from body_moments.panels import menus as shown

ROOT = Path(__file__).resolve().parent.parent.parent
MAKERS = (
    "https://www.sphinx-doc.org/",
    "https://github.com/pradyunsg/furo",
    "https://pradyunsg.me",
)


class Page(HTMLParser):
    """The anchors of a page, and what it refers to."""

    def __init__(self, path: Path):
        super().__init__()
        self.ids, self.links = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, _tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.ids.add(value)
            elif name in ("href", "src") and value is not None:
                self.links.append(value)


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("manual") / manual.FOLDER
    manual.build(path)
    return path


def test_links_lead_to_pages_or_to_the_makers_of_the_generator(folder):
    pages = {path: Page(path) for path in folder.rglob("*.html")}
    assert len(pages) > 60 and sum(len(page.links) for page in pages.values()) > 3000
    broken = []
    for path, page in pages.items():
        for link in page.links:
            file, _, place = link.partition("?")[0].partition("#")
            target = (path.parent / file).resolve() if file else path
            inside = target.is_relative_to(folder) and target.is_file()
            if not link.startswith(MAKERS) and (
                not inside or (place and place not in pages.get(target, page).ids)
            ):
                broken.append("{}: {}".format(path.relative_to(folder), link))
    assert not broken, "\n".join(broken)


def test_broken_link_fails_the_build(tmp_path):
    page = tmp_path / "index.md"
    page.write_text("# A page\n\n[nowhere](nothing.md)\n", encoding="utf-8")
    with pytest.raises(RuntimeError, match=re.escape("nothing.md")):
        manual.run_sphinx(tmp_path, tmp_path / "pages")


def test_search_index_is_a_script_that_knows_every_page(folder):
    """A browser refuses to fetch data from file://, but loads scripts."""
    index = (folder / "searchindex.js").read_text(encoding="utf-8")
    names = re.search(r'"?docnames"?:\[([^]]*)\]', index).group(1).replace('"', "").split(",")
    assert index.startswith("Search.setIndex(")
    assert {
        path.relative_to(folder).with_suffix("").as_posix() for path in folder.rglob("*.html")
    } - set(names) == {"search"}


def test_public_names_of_the_core_are_in_the_manual(folder):
    ids = set().union(*(Page(path).ids for path in folder.glob("api/*.html")))
    for face in (ROOT / "core").glob("*/__init__.py"):
        package = "body_moments.core." + face.parent.name
        module = importlib.import_module(package)
        names = {
            package + "." + name
            for name in module.__all__
            if not isinstance(getattr(module, name), (tuple, dict))
        }
        assert [name for name in names if not ids & {name, "module-" + name}] == []


def test_the_readme_of_the_zip_leads_into_the_manual(folder):
    links = re.findall(r"\]\(([^)]+)\)", manual.readme())
    assert len(links) > 20
    assert [
        link
        for link in links
        if link != "#install" and not (folder.parent / link.partition("#")[0]).is_file()
    ] == []


def test_every_page_of_buttons_and_settings_exists(folder):
    assert {page for _, page in shown.PAGES} <= {path.name for path in folder.glob("*.html")}


@pytest.mark.parametrize(
    ("control", "page"),
    [
        ("bpy.ops.object.body_moments_measure", "reading-the-numbers.html"),
        ("bpy.ops.object.body_moments_measure_section", "sections.html"),
        ("bpy.ops.object.body_moments_axes_to_principal", "actions.html"),
        ("bpy.ops.view3d.body_moments_cursor_to_center", "actions.html"),
        ("bpy.types.BodyMomentsObjectSettings.thickness", "walls.html"),
        ("bpy.types.BodyMomentsObjectSettings.density_from", "densities.html"),
        ("bpy.types.BodyMomentsObjectSettings.spline_order", "volumes-and-scans.html"),
        ("bpy.types.BodyMomentsSceneSettings.moments_order", "moments.html"),
    ],
)
def test_online_manual_finds_the_page_of_a_control(control, page, folder, monkeypatch):
    monkeypatch.setattr(shown, "manual_folder", lambda: folder)
    shown.register()
    try:
        from bl_operators.wm import WM_OT_doc_view_manual as Viewer

        assert Viewer._lookup_rna_url(control, verbose=False) == folder.as_uri() + "/" + page
    finally:
        shown.unregister()
    assert all(prefix != folder.as_uri() + "/" for prefix, _ in bpy.utils.manual_map())


def test_search_knows_the_texts_of_pages_for_users(folder):
    code = (folder / "_static" / "texts.js").read_text(encoding="utf-8")
    texts = json.loads(code.removeprefix("const PAGE_TEXTS = ").rstrip().removesuffix(";"))
    assert "center of mass" in texts["viewport"] and not any(
        page.startswith("api/") for page in texts
    )
    assert "FOR_DEVELOPERS" in (folder / "_static" / "language_data.js").read_text(encoding="utf-8")
