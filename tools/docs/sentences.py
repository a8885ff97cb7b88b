"""Refuses pages that are hard to read: long sentences, and what only a diary has.

    sentences.py PAGE ...

Prose is what is left of a page of Markdown without code, tables, pictures and headings. A sentence
has at most MOST words, and those of a page at most MEAN in the mean. Of a source it is what
documents it: comments of the C header and of TypeScript, without what is set in like a table;
summaries of options; docstrings of Python without the heads of their items; comments for rustdoc.
"""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path

MOST, MEAN = 30, 16
# Words that tell how something came to be. That is in the commits, and in benchmarks/history.
DIARY = re.compile(r"\b(no longer|used to be|until now|as of late|meanwhile|this week)\b", re.I)


def paragraphs(text: str) -> list[tuple[int, str]]:
    """Return the prose of a page, a paragraph or an item of a list each, with its first line."""
    found: list[tuple[int, str]] = []
    fenced, number_of, lines = False, 0, []

    def end() -> None:
        if lines:
            found.append((number_of, " ".join(lines)))
            lines.clear()

    text = re.sub(r"<!--.*?-->", lambda m: re.sub(r"[^\n]", "", m[0]), text, flags=re.S)
    for number, line in enumerate(text.splitlines(), 1):
        stripped = line.strip()
        if re.match(r"(```|~~~|\$\$)", stripped):
            fenced = not fenced if not re.match(r"\$\$.+\$\$$", stripped) else fenced
            end()
            continue
        if (
            fenced
            or not stripped
            or re.match(r"(#|\||!!!|---|<)", stripped)
            or line.startswith("    ")
        ):
            end()
            continue
        if re.match(r"([-*+]|\d+[.)]) ", stripped):
            end()
            stripped = re.sub(r"^([-*+]|\d+[.)]) ", "", stripped)
        if not lines:
            number_of = number
        lines.append(stripped)
    end()
    return found


def comments(text: str) -> list[tuple[int, str]]:
    """Return the paragraphs of a header's comments and the summaries of options, with lines."""
    found = []
    for match in re.finditer(r"/\*(.*?)\*/|\.summary =\s*((?:\"[^\"]*\"\s*)+)", text, re.S):
        number = text.count("\n", 0, match.start()) + 1
        if match[2]:
            found.append((number, "".join(re.findall(r"\"([^\"]*)\"", match[2]))))
            continue
        lines = [re.sub(r"^\s*\* ?", "", line) for line in match[1].strip().split("\n")]
        lines = ["" if line.startswith("  ") else line for line in lines]
        for paragraph in re.split(r"\n\s*\n", "\n".join(lines)):
            found.append((number, " ".join(paragraph.split())))
    return found


def docstrings(text: str) -> list[tuple[int, str]]:
    """Return the paragraphs of docstrings, without headings, items' heads and examples."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)):
            continue
        words = ast.get_docstring(node) or ""
        words = re.sub(r"^Examples\n-+\n.*?(?=\n\w+\n-+$|\Z)", "", words, flags=re.S | re.M)
        words = re.sub(r"^\w[\w ]*\n-+$|^\*{0,2}\w[\w, *]* : .*$|^>>>.*$", "", words, flags=re.M)
        number = node.body[0].lineno if words else 0
        found += [(number, part) for part in parts_of(words)]
    return found


def doc_comments(text: str) -> list[tuple[int, str]]:
    """Return the paragraphs of comments that begin with three slashes, without code and tables."""
    found = []
    for match in re.finditer(r"(?:^[ \t]*//[/!].*\n)+", text, re.M):
        number = text.count("\n", 0, match.start()) + 1
        words = re.sub(r"^[ \t]*//[/!] ?", "", match[0], flags=re.M)
        words = re.sub(r"^```.*?^```|^[#|].*$", "", words, flags=re.S | re.M)
        found += [(number, part) for part in parts_of(words)]
    return found


def parts_of(words: str) -> list[str]:
    """Return paragraphs and items of lists."""
    return [" ".join(part.split()) for part in re.split(r"\n\s*\n|\n(?=\s*[-*] )", words)]


#: How what is read in a file is found, by its suffix.
FINDERS = {".md": paragraphs, ".py": docstrings, ".rs": doc_comments, ".hpp": doc_comments}


def sentences(paragraph: str) -> list[list[str]]:
    """Return the words of each sentence. Code counts as one word, a link as its text."""
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", paragraph)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"`[^`]*`", "CODE", text)
    text = re.sub(r"\$[^$]*\$", "FORMULA", text)
    text = re.sub(r"\b(e\.g|i\.e|cf|vs|et al|Fig|Sec|No)\.", r"\1", text)
    parts = re.split(r"(?<=[.!?])[\"')*_]*\s+|(?<=:)[\"')*_]*\s+(?=[\"'(*_]*[A-Z0-9])", text)
    return [words for part in parts if (words := re.findall(r"[^\s]*\w[^\s]*", part))]


def problems(page: Path) -> list[str]:
    """Return a line for each thing that is wrong with a page."""
    wrong, lengths = [], []
    is_page = page.suffix == ".md"
    for number, paragraph in FINDERS.get(page.suffix, comments)(page.read_text()):
        for words in sentences(paragraph):
            lengths.append(len(words))
            if len(words) > MOST:
                start = " ".join(words[:8])
                wrong.append(f"{page}:{number}: {len(words)} words, at most {MOST}: {start} ...")
        if is_page and (match := DIARY.search(paragraph)):
            wrong.append(f"{page}:{number}: '{match[0]}' is of a diary; say what is so today")
    mean = sum(lengths) / len(lengths) if lengths else 0
    if is_page and mean > MEAN:
        wrong.append(f"{page}: {mean:.1f} words a sentence in the mean, at most {MEAN}")
    return wrong


def main() -> int:
    """Look at the pages that the arguments name."""
    wrong = [line for name in sys.argv[1:] for line in problems(Path(name))]
    print("\n".join(wrong), file=sys.stderr, end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
