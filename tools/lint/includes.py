"""Include cleanliness: a file includes the project's headers that it uses, and no others.

A file uses a header if it names, or defines, something that the header declares; what comes with a
type, its members, asks for no include. A source may leave to the header of its own name what that
header includes. Headers of the system are not looked at.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from clang.cindex import (
    Cursor,
    CursorKind,
    Diagnostic,
    Index,
    TranslationUnit,
    conf,
)

# Where the names in #include directives are looked up, besides the folder of the file.
FOLDERS = ("include", "src", "program", "tests", "")
# A header, and the folder of its parts, which are had by including it.
PARTS = {Path("include/beltrami/beltrami.hpp"): Path("include/beltrami/cpp")}
# Not extern "C": what leads to the C ABI may be included instead.
SCOPES = {CursorKind.NAMESPACE, CursorKind.TRANSLATION_UNIT}


class Project:
    """The files of the project, with what is read of their text."""

    def __init__(self, root: Path) -> None:
        self.root = root
        # Files with headers that they include under a condition, which may not hold here.
        self.conditional: set[tuple[Path, Path]] = set()
        self._includes: dict[Path, dict[Path, int]] = {}
        self._macros: dict[Path, set[str]] = {}
        self._inside: dict[str, Path | None] = {}

    def file(self, name: str) -> Path | None:
        """Return the path of a file of the project below the root, None for others."""
        if name not in self._inside:
            path = Path(name).resolve()
            build = self.root / "build"
            inside = path.is_relative_to(self.root) and not path.is_relative_to(build)
            self._inside[name] = path.relative_to(self.root) if inside else None
        return self._inside[name]

    def includes(self, path: Path) -> dict[Path, int]:
        """Return the project's headers that a file includes itself, with the lines."""
        if path not in self._includes:
            found = self._includes[path] = {}
            lines = (self.root / path).read_text().splitlines()
            depth = 0
            for number, line in enumerate(lines, 1):
                depth += bool(re.match(r"\s*#\s*if", line)) - bool(re.match(r"\s*#\s*endif", line))
                match = re.match(r'\s*#\s*include\s*["<]([^">]+)', line)
                if match and (header := self._look_up(path.parent, match[1])):
                    found[header] = number
                    if depth > 0:
                        self.conditional.add((path, header))
        return self._includes[path]

    def macros(self, header: Path) -> set[str]:
        """Return the names of the macros that a header defines."""
        if header not in self._macros:
            text = (self.root / header).read_text()
            self._macros[header] = set(re.findall(r"^\s*#\s*define\s+(\w+)", text, re.M))
        return self._macros[header]

    def _look_up(self, folder: Path, name: str) -> Path | None:
        for place in (folder, *map(Path, FOLDERS)):
            if (self.root / place / name).is_file():
                return self.file(str(self.root / place / name))
        return None


class Uses:
    """What one file takes from other files of the project."""

    def __init__(self) -> None:
        self.named: dict[str, tuple[int, str, set[Path]]] = {}  # line, name, where declared
        self.touched: set[Path] = set()  # where anything is declared that is used, members included

    def add(self, project: Project, cursor: Cursor, target: Cursor) -> None:
        """Note that the code at a cursor refers to a declaration."""
        declared = set()
        for declaration in (target, target.canonical, target.get_definition()):
            file = declaration.location.file if declaration else None
            if file and (path := project.file(file.name)):
                declared.add(path)
        self.touched |= declared
        parent = target.semantic_parent
        if declared and parent and parent.kind in SCOPES and target.kind != CursorKind.NAMESPACE:
            if target.spelling.startswith("operator"):
                return
            self.named.setdefault(
                target.get_usr(), (cursor.location.line, target.spelling, declared)
            )


def targets_of(cursor: Cursor) -> Iterator[Cursor]:
    """Yield the declarations that one node of the syntax tree refers to."""
    if cursor.kind == CursorKind.OVERLOADED_DECL_REF:  # a call inside a template
        for i in range(conf.lib.clang_getNumOverloadedDecls(cursor)):
            yield conf.lib.clang_getOverloadedDecl(cursor, i)
    elif cursor.kind.is_declaration():
        if cursor.kind == CursorKind.VAR_DECL:  # with auto, nothing names the type
            declaration = cursor.type.get_canonical().get_declaration()
            if declaration.kind != CursorKind.NO_DECL_FOUND and declaration.semantic_parent:
                yield declaration
        elif cursor.kind == CursorKind.FUNCTION_DECL and cursor.is_definition():
            yield cursor.canonical  # so that the compiler compares the two
    elif cursor.referenced:
        yield cursor.referenced


def uses_of(unit: TranslationUnit, project: Project) -> dict[Path, Uses]:
    """Collect the uses of each file of the project in a unit."""
    uses: dict[Path, Uses] = {}
    for top in unit.cursor.get_children():
        file = top.location.file
        path = project.file(file.name) if file else None
        if path is None:
            continue
        here = uses.setdefault(path, Uses())
        for cursor in top.walk_preorder():
            for target in targets_of(cursor):
                here.add(project, cursor, target)
    return uses


def judge(path: Path, here: Uses, project: Project) -> Iterator[str]:
    """Yield a line for each include of a file that is missing or idle."""
    includes = project.includes(path)
    given = {path, *includes}
    own = None
    if path.suffix != ".h":
        own = next((h for h in includes if h.stem == path.stem.removesuffix("_test")), None)
    if own:
        given |= project.includes(own).keys()
    parts = {folder: header for header, folder in PARTS.items() if header in includes}
    touched = here.touched | {parts[file.parent] for file in here.touched if file.parent in parts}
    for line, name, declared in here.named.values():
        if not declared & given and not any(file.parent in parts for file in declared):
            yield f"{path}:{line}: {name} is declared in {min(declared)}, which is not included"
    text = (project.root / path).read_text()
    for header, line in includes.items():
        macros = (
            re.search(rf"^(?!\s*#\s*include).*\b{m}\b", text, re.M) for m in project.macros(header)
        )
        if (path, header) in project.conditional:
            continue
        if header != own and header not in touched and not any(macros):
            yield f"{path}:{line}: nothing of {header} is used"


def check(name: str, words: list[str], resources: str, project: Project) -> list[str]:
    """Return the complaints about a source and the headers of the project that it includes.

    `words` are the compiler's arguments, `resources` is the folder of clang's own headers.
    """
    unit = Index.create().parse(name, [*words, "-ferror-limit=0", "-resource-dir", resources])
    # libclang may be older than clang's own headers, whose intrinsics it does not know then.
    errors = [
        d
        for d in unit.diagnostics
        if d.severity >= Diagnostic.Error and not str(d.location.file).startswith(resources)
    ]
    if errors:
        return [f"{name}: {errors[0]}"]
    complaints: list[str] = []
    for path, here in uses_of(unit, project).items():
        complaints += judge(path, here, project)
    return complaints
