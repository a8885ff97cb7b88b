"""A bill of materials: an SPDX 2.3 document of what is in an archive."""

from __future__ import annotations

import json
import re
from pathlib import Path

from archive import sum_of
from inputs import PARTS, version_of
from targets import WASM, Target


def write_sbom(stage: Path, target: Target, version: str, kinds: set[str]) -> Path:
    """Write sbom.spdx.json into the folder that is packed.

    `kinds` of parts are in it. The document has no date and no random name: the same files give
    the same document.
    """
    top = "SPDXRef-beltrami"
    ours = _package(top, "beltrami", version, "Apache-2.0", "NOASSERTION")
    packages, relations = [ours], [_relation("SPDXRef-DOCUMENT", "DESCRIBES", top)]
    for part in PARTS:
        if part.where not in kinds:
            continue
        name = "SPDXRef-" + re.sub(r"[^A-Za-z0-9]+", "-", part.name).strip("-")
        upstream = re.sub(r"^\d+:|[-+~].*$|\.dfsg.*$", "", version_of(part.package))
        packages.append(_package(name, part.name, upstream, part.licence, part.url))
        relations.append(_relation(top, "STATIC_LINK", name))
    files = []
    for path in sorted(stage.rglob("*")):
        if path.is_symlink() or not path.is_file() or path.name == "sbom.spdx.json":
            continue
        name = path.relative_to(stage).as_posix()
        identifier = "SPDXRef-File-" + re.sub(r"[^A-Za-z0-9.]+", "-", name)
        sums = [{"algorithm": "SHA256", "checksumValue": sum_of(path)}]
        files.append({"SPDXID": identifier, "fileName": f"./{name}", "checksums": sums})
        relations.append(_relation(top, "CONTAINS", identifier))
    document = {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"beltrami-{version}-{target.name}",
        "documentNamespace": f"https://spdx.org/spdxdocs/beltrami-{version}-{target.name}",
        "creationInfo": {"created": "1980-01-01T00:00:00Z", "creators": ["Tool: beltrami-dist"]},
        "packages": packages,
        "files": files,
        "relationships": relations,
    }
    target_file = stage / "sbom.spdx.json"
    target_file.write_text(json.dumps(document, indent=1) + "\n")
    return target_file


def kinds_of(target: Target) -> set[str]:
    """Return the kinds of parts that an archive of a target has."""
    return {"library", "runtime", "wasm" if target.name == WASM else "program"}


def _package(name: str, title: str, version: str, licence: str, url: str) -> dict[str, object]:
    return {
        "SPDXID": name,
        "name": title,
        "versionInfo": version,
        "licenseDeclared": licence,
        "licenseConcluded": licence,
        "downloadLocation": url,
        "filesAnalyzed": False,
    }


def _relation(one: str, kind: str, other: str) -> dict[str, str]:
    return {"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other}
