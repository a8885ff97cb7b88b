"""What MkDocs does with a page of this project beside its own work.

Formulas between dollars become MathML, which browsers draw without a script. Links out of docs/, to
sources and to the pages beside it, keep their text alone: the site has none of these files.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert

FENCED = re.compile(r"(^```.*?^```)", re.M | re.S)
CODE = re.compile(r"(`[^`\n]*`)")
DISPLAY = re.compile(r"\$\$(.+?)\$\$", re.S)
INLINE = re.compile(r"(?<![\\$])\$([^$\n]+?)\$(?!\d)")
LINK = re.compile(r"\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")


def on_page_markdown(markdown: str, page: Any, config: Any, **_: Any) -> str:
    """Change the source of a page before it becomes HTML."""
    root = Path(config["docs_dir"]).resolve()
    folder = Path(page.file.abs_src_path).parent

    def link(match: re.Match[str]) -> str:
        if re.match(r"[a-z]+:|#", match[2]):
            return match[0]
        there = (folder / match[2].partition("#")[0]).resolve()
        return match[0] if there.is_relative_to(root) else match[1]

    def formulas(text: str) -> str:
        text = DISPLAY.sub(lambda m: convert(m[1].strip(), display="block"), text)
        return INLINE.sub(lambda m: convert(m[1]), text)

    def prose(text: str) -> str:
        text = LINK.sub(link, text)
        return "".join(part if i % 2 else formulas(part) for i, part in enumerate(CODE.split(text)))

    return "".join(part if i % 2 else prose(part) for i, part in enumerate(FENCED.split(markdown)))
