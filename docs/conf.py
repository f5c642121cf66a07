# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of Sphinx for the manual: Markdown by MyST, the look by Furo, the API from the
docstrings of `core/`.

`python -m sphinx docs FOLDER` builds it; the pages need no network and no server, and neither does
their search.
"""

import importlib.util
import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "body_moments"

project = "Body Moments"
author = "Body Moments contributors"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.autosummary", "sphinx.ext.napoleon"]
exclude_patterns = ["_templates", "listing.md"]  # the platform shows the listing
templates_path = ["_templates"]
myst_heading_anchors = 3
suppress_warnings = ["misc.highlighting_failure"]  # sketches of file formats with "…" in them

default_role = "py:obj"  # names in docstrings lead to their entries, other code stays code
autosummary_generate_overwrite = True
autodoc_member_order = "groupwise"
autodoc_typehints = "none"  # the sections of parameters describe the types
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
add_module_names = False

html_theme = "furo"
html_title = "Body Moments"
html_static_path = ["_static"]
html_css_files = ["manual.css"]
html_js_files = ["excerpts.js"]
html_search_scorer = str(Path(__file__).with_name("_static") / "scorer.js")
html_extra_path = ["../CITATION.cff"]
html_copy_source = False
html_show_copyright = False
html_show_search_summary = False  # a browser refuses to fetch the found pages from file://
html_use_index = False
html_domain_indices = False


def load_package() -> None:
    """Load the repository's root under the add-on's name, whatever its folder is called."""
    if PACKAGE not in sys.modules:
        spec = importlib.util.spec_from_file_location(
            PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
        )
        sys.modules[PACKAGE] = module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)


def keep_tables(_app, what: str, _name: str, _object, _options, lines: list[str]) -> None:
    """Show the indented tables in the docstrings of modules as they are typed."""
    if what == "module":
        text = re.sub(r"\n\n(?=    )", "\n\n::\n\n", "\n".join(lines))
        lines[:] = text.split("\n")


texts: dict[str, str] = {}  # by page, what the excerpts of the search are cut from


def keep_text(_app, doctree, page: str) -> None:
    """Remember the text of a page, except those of the API."""
    if not page.startswith("api"):
        texts[page] = " ".join(doctree.astext().split())


def write_texts(app, error) -> None:
    """Write the texts of all pages for `_static/excerpts.js`."""
    if error is not None:
        return
    code = "const PAGE_TEXTS = {};\n".format(json.dumps(texts, ensure_ascii=False))
    Path(app.outdir, "_static", "texts.js").write_text(code, encoding="utf-8")


def setup(app) -> None:
    """Connect the above with Sphinx."""
    load_package()
    app.connect("autodoc-process-docstring", keep_tables)
    app.connect("doctree-resolved", keep_text)
    app.connect("build-finished", write_texts)
