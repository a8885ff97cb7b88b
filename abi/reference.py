#!/usr/bin/env python3
"""The reference page from the header's comments.

    abi/reference.py --check     fails if the committed page is not what the header says
"""
import argparse
import re
import sys

import header as public_header

PAGE = public_header.ROOT / "docs" / "reference.md"

_ERRORS = re.compile(r"\bErrors?:|\bfails?\b|\bCannot fail\b", re.IGNORECASE)


def marked_up(comment):
    """A comment as Markdown: names in code, nothing taken for emphasis."""
    parts = re.split(r"(`[^`]*`)", comment)
    for i in range(0, len(parts), 2):
        part = re.sub(r"([*<>\[\]])", r"\\\1", parts[i])
        parts[i] = re.sub(r"((?:beltrami|BELTRAMI)_\w+(?:->\w+|\.\w+)*|\w+(?:->|\\->)\w+)",
                          lambda m: "`" + m.group(1).replace("\\", "") + "`", part)
    return "".join(parts)


def thread_rule(function):
    if function.name == "beltrami_cancel":
        return "any, at any time before `beltrami_destroy`"
    if any("beltrami_context*" in parameter and "**" not in parameter
           for parameter in function.parameters):
        return "any, but one at a time for each context"
    return "any, several at a time"


def function_entry(function):
    if not _ERRORS.search(function.comment):
        raise SystemExit(f"include/beltrami/beltrami.h: the comment of {function.name} does not say "
                         "how it fails (Errors: ..., or Cannot fail.)")
    declaration = re.sub(r"BELTRAMI_API\s+", "", function.declaration)
    declaration = " ".join(declaration.split())
    if len(declaration) > 90:  # one parameter a line
        declaration = declaration.replace("(", "(\n    ", 1).replace(", ", ",\n    ")
    return (f"### {function.name}\n\n```c\n{declaration}\n```\n\n{marked_up(function.comment)}\n\n"
            f"Thread: {thread_rule(function)}.\n")


def item_entry(item):
    comment = f"{marked_up(item.comment)}\n\n" if item.comment else ""
    title = f"### {item.name}\n\n" if item.kind in ("struct", "typedef") else ""
    return f"{title}{comment}```c\n{item.declaration}\n```\n"


def page(header):
    parts = ["# Reference of the C interface\n\n"
             "Made from the comments of `include/beltrami/beltrami.h` by `./dev abi`; edit those.\n\n"
             f"{marked_up(header.introduction)}\n"]
    for title, introduction in header.sections:
        parts.append(f"\n## {title or 'Version'}\n")
        if introduction:
            parts.append(f"\n{marked_up(introduction)}\n")
        for item in header.items:
            if item.section == title:
                parts.append("\n" + item_entry(item))
                # Items of one kind without words between them share a block.
                if item.kind == "macro" and not item.comment:
                    parts[-2:] = ["".join(parts[-2:]).replace("```\n\n```c\n", "")]
        for function in header.functions:
            if function.section == title:
                parts.append("\n" + function_entry(function))
    return "".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", required=True)
    parser.parse_args()
    if PAGE.read_text(encoding="utf-8") != page(public_header.read()):
        sys.exit("docs/reference.md is not what the header's comments say: run ./dev abi")


if __name__ == "__main__":
    main()
