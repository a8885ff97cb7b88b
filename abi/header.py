"""Reads the public header: functions, structs, enumerators and macros, with their comments.

Understands the header's own style only: declarations end at a semicolon, function declarations
begin with BELTRAMI_API, comments are /* */ and stand before what they are about.
"""
import dataclasses
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEADER = ROOT / "include" / "beltrami" / "beltrami.h"

_COMMENT = r"/\*.*?\*/"
_TOKEN = re.compile(
    rf"(?P<comment>{_COMMENT})"
    r"|(?P<directive>^[ \t]*#(?:\\\n|[^\n])*)"
    r"|(?P<block>(?:typedef struct|enum)[^;{]*\{.*?\}[^;]*;)"
    r"|(?P<declaration>(?:BELTRAMI_API|typedef|struct)[^;{]*;)",
    re.DOTALL | re.MULTILINE)
_FUNCTION = re.compile(r"BELTRAMI_API\s+(?P<result>.*?)(?P<name>beltrami_\w+)\s*\((?P<parameters>.*)\)")


@dataclasses.dataclass
class Function:
    name: str
    result: str
    parameters: list  # of texts such as "uint64_t stride"; empty for (void)
    comment: str
    section: str
    declaration: str

    def parameter_names(self):
        return [re.search(r"(\w+)$", text).group(1) for text in self.parameters]


@dataclasses.dataclass
class Item:
    """A struct, an enum, a typedef or a macro."""
    kind: str
    name: str  # "" for enums
    comment: str
    section: str
    declaration: str


@dataclasses.dataclass
class Header:
    functions: list
    items: list
    introduction: str
    sections: list  # (title, introduction)

    def structs(self):
        return [item.name for item in self.items if item.kind == "struct"]

    def enums(self):
        """Per enum its enumerators, in order."""
        return [re.findall(r"\b(BELTRAMI_\w+)\s*=", without_comments(item.declaration))
                for item in self.items if item.kind == "enum"]

    def constants(self):
        """Names of all enumerators, and of all macros that stand for numbers."""
        return [item.name for item in self.items if item.kind == "macro"] + [
            name for enum in self.enums() for name in enum]


def without_comments(text):
    return re.sub(_COMMENT, " ", text, flags=re.DOTALL)


def _plain(comment):
    lines = [re.sub(r"^\s*\*? ?", "", line) for line in comment[2:-2].splitlines()]
    return "\n".join(line.rstrip() for line in lines).strip()


def parse(text):
    header = Header([], [], "", [("", "")])
    comment = shared = ""  # waiting for its declaration; of the function right before
    end = 0

    def belongs_to_section():
        nonlocal comment
        title, introduction = header.sections[-1]
        header.sections[-1] = (title, (introduction + "\n\n" + comment).strip())
        comment = ""

    for match in _TOKEN.finditer(text):
        apart = "\n\n" in text[end:match.start()]
        end = match.end()
        token = match.group()
        section = header.sections[-1][0]
        if comment and (apart or match.lastgroup == "comment"):
            belongs_to_section()
        if apart:
            shared = ""
        if match.lastgroup == "comment":
            title = re.fullmatch(r"/\* ---- (.*?) -+ \*/", token)
            if title:
                header.sections.append((title.group(1), ""))
            elif not header.introduction:
                header.introduction = _plain(token)
            else:
                comment = _plain(token)
            continue
        if match.lastgroup == "directive":
            macro = re.match(r"#define (BELTRAMI_\w+) +\S", token)
            if macro and macro.group(1) != "BELTRAMI_API":
                header.items.append(Item("macro", macro.group(1), comment, section, token))
            comment = ""
            continue
        found = _FUNCTION.match(" ".join(token.split()))
        if found:
            shared = comment = comment or shared
            inside = found["parameters"].strip()
            parameters = [] if inside == "void" else [p.strip() for p in inside.split(",")]
            header.functions.append(Function(found["name"], found["result"].strip(), parameters,
                                             comment, section, token))
        else:
            header.items.append(Item(*_kind_and_name(token), comment, section, token))
        comment = ""
    return header


def _kind_and_name(declaration):
    if declaration.startswith("enum"):
        return "enum", ""
    pointer = re.search(r"\(\*(\w+)\)", declaration)
    name = (pointer or re.search(r"(\w+)\s*;$", declaration)).group(1)
    return ("struct" if "{" in declaration else "typedef"), name


def read(path=HEADER):
    return parse(pathlib.Path(path).read_text(encoding="utf-8"))
