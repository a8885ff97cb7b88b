"""Archives with the same bytes from the same files, and their sums."""

from __future__ import annotations

import gzip
import hashlib
import io
import tarfile
import zipfile
from pathlib import Path

#: Of every file in an archive: the first moment that a ZIP file can name.
DATE = (1980, 1, 1, 0, 0, 0)
SECONDS = 315532800


def _mode(path: Path) -> int:
    runs = path.suffix in {".dll", ".exe"} or ".so" in path.name or path.parent.name == "bin"
    return 0o755 if runs else 0o644


def pack(folder: Path, target: Path, top: str) -> Path:
    """Write all files of a folder into an archive, below `top`; links stay links in a tar file."""
    paths = sorted(path for path in folder.rglob("*") if path.is_symlink() or path.is_file())
    names = [f"{top}/{path.relative_to(folder).as_posix()}" for path in paths]
    if target.suffix == ".zip":
        files = {name: (path.read_bytes(), _mode(path)) for name, path in zip(names, paths)}
        return write_zip(target, files)
    plain = io.BytesIO()
    with tarfile.open(fileobj=plain, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for name, path in zip(names, paths):
            entry = tarfile.TarInfo(name)
            entry.mtime = SECONDS
            if path.is_symlink():
                entry.type, entry.linkname, entry.mode = (
                    tarfile.SYMTYPE,
                    str(path.readlink()),
                    0o777,
                )
                archive.addfile(entry)
                continue
            data = path.read_bytes()
            entry.size, entry.mode = len(data), _mode(path)
            archive.addfile(entry, io.BytesIO(data))
    target.write_bytes(gzip.compress(plain.getvalue(), 9, mtime=0))
    return target


def write_zip(target: Path, files: dict[str, tuple[bytes, int]]) -> Path:
    """Write a ZIP file of names, contents and modes."""
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, (data, mode) in files.items():
            entry = zipfile.ZipInfo(name, DATE)
            entry.create_system = 3  # Unix, which has modes
            entry.external_attr = (0o100000 | mode) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    return target


def sum_of(path: Path) -> str:
    """Return the SHA-256 sum of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def write_sums(folder: Path) -> Path:
    """Write SHA256SUMS of a folder's files, as sha256sum --check reads it."""
    names = sorted(path.name for path in folder.iterdir() if path.is_file())
    listed = folder / "SHA256SUMS"
    lines = [f"{sum_of(folder / name)}  {name}\n" for name in names if name != listed.name]
    listed.write_text("".join(lines))
    return listed
