"""The documentation site, built from the texts in the folders that they describe.

pip install -e ".[all,docs]" && sphinx-build -W -c .docs . build/site
"""

import re
from importlib.metadata import version as version_of
from typing import Any

HEADING_WITH_LINK = re.compile(r"^(#+ )\[(.+?)\]\((.+?)\)$", re.MULTILINE)
project = "quintet"
author = "The quintet maintainers"
project_copyright = author
release = version = version_of("quintet")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
source_suffix = {".md": "markdown"}
root_doc = ".docs/index"
include_patterns = [
    ".docs/*.md",
    ".github/*.md",
    "README.md",
    "*/README.md",
    "components/**/*.md",
    "scenarios/**/README.md",
]
exclude_patterns = [".venv", "build", "runs", ".pytest_cache", ".docs/templates"]

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
# Links to source files and folders are for readers of the repository.
suppress_warnings = ["myst.xref_missing", "myst.header"]
autodoc_typehints = "description"
napoleon_google_docstring = False

html_theme = "furo"
templates_path = ["templates"]
html_additional_pages = {"index": "start.html"}  # the first page lies in a folder of its own
html_title = f"quintet {version}"
html_copy_source = False
html_show_sphinx = False


def unlink_headings(_: Any, __: str, source: list[str]) -> None:
    """Put the link of a heading below it: a table of contents cannot hold one."""
    source[0] = HEADING_WITH_LINK.sub(r"\1\2\n\n[Read more](\3)", source[0])


def show_formulas(_: Any, what: str, name: str, *rest: Any) -> None:
    """Show indented blocks in the docstring of a kind, its equations, line by line."""
    lines = rest[-1]
    if what == "module" and name.startswith("quintet.components."):
        text = re.sub(r"(?<!`)`(?!`)", "``", "\n".join(lines))
        text = re.sub(r"\n\n(?= {4}\S)", "\n\n::\n\n", text)
        parts = re.split(r"(``.+?``|^ {4}[^\n]*)", text, flags=re.MULTILINE | re.DOTALL)
        parts[::2] = [part.replace("|", r"\|") for part in parts[::2]]
        lines[:] = "".join(parts).split("\n")


def setup(app: Any) -> None:
    """Register the changes of texts."""
    app.connect("source-read", unlink_headings)
    app.connect("autodoc-process-docstring", show_formulas)
