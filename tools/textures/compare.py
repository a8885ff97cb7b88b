#!/usr/bin/env python3
"""Whether models look the same once their textures are baked for new UVs.

    compare.py --program BELTRAMI --modules FOLDER [--out FOLDER] [MODEL ...]

Makes ten models, has them unwrapped with --bake, draws both by three.js in Chromium without a
window, and compares the pictures: at least 40 dB over what the model covers. The files that are
written pass the validator of Khronos without errors. FOLDER has node_modules with three and
gltf-validator. The pictures, before and after side by side, go to --out.
"""

from __future__ import annotations

import argparse
import base64
import functools
import json
import shutil
import subprocess
import sys
import tempfile
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from models import MODELS, Model

#: Decibels of the pictures of a model before and after, at least: errors of 2.5 of 255 in the
#: mean, which nobody sees. New textures have about the density of the old ones.
LEAST_PSNR = 40.0
RESOLUTION = 1024
#: Seconds for the browser to draw all; it takes a few.
PATIENCE = 300
VALIDATE = """
const fs = require("fs"), validator = require("gltf-validator");
validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1])))
  .then((report) => process.stdout.write(JSON.stringify(report.issues)));
"""


class Handler(SimpleHTTPRequestHandler):
    """Gives the page its files, and takes what it says."""

    def __init__(self, *arguments: Any, page: Page, **options: Any) -> None:
        """Answer one request."""
        self.page = page
        super().__init__(*arguments, **options)

    def translate_path(self, path: str) -> str:
        """Return the file that a path of the page stands for."""
        name = path.split("?")[0].lstrip("/")
        if name.startswith("three/"):
            return str(self.page.three / name.removeprefix("three/"))
        if name.startswith("models"):
            return str(self.page.folder / name.removeprefix("models/"))
        return str(Path(__file__).parent / "viewer.html")

    def do_POST(self) -> None:
        """Take a result, or the end."""
        said = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.send_response(204)
        self.end_headers()
        if self.path == "/result":
            self.page.results.append(said)
        else:
            self.page.error = said.get("error", "")
            self.page.done.set()

    def log_message(self, *_: Any) -> None:
        """Say nothing of requests."""


class Page:
    """The models of a folder, drawn in a browser."""

    def __init__(self, folder: Path, three: Path) -> None:
        """Begin with nothing drawn."""
        self.folder = folder
        self.three = three
        self.results: list[dict[str, Any]] = []
        self.error = ""
        self.done = threading.Event()

    def draw(self, browser: str) -> None:
        """Have all models drawn; `results` are their pictures."""
        server = ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, page=self))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        # Processes of the browser's own write for a moment after it has ended.
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
            words = [browser, "--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader"]
            words += [
                "--use-angle=swiftshader",
                "--ignore-gpu-blocklist",
                f"--user-data-dir={profile}",
            ]
            words += [f"http://127.0.0.1:{server.server_port}/viewer.html"]
            with subprocess.Popen(
                words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            ) as process:
                finished = self.done.wait(PATIENCE)
                process.terminate()
        server.shutdown()
        if self.error or not finished:
            sys.exit(f"the browser drew nothing: {self.error or 'it took too long'}")


def make(name: str, model: Model, program: Path, folder: Path) -> None:
    """Write a model before and after."""
    before, after = folder / f"{name}.before.glb", folder / f"{name}.after.glb"
    before.write_bytes(model.gltf.glb())
    words = [
        str(program),
        "unwrap",
        str(before),
        str(after),
        "--bake",
        "--effort",
        "quick",
        "--quiet",
    ]
    words += ["--resolution", str(RESOLUTION), *model.options]
    subprocess.run(words, check=True)


def errors_of(path: Path, modules: Path) -> list[str]:
    """Return what the validator of Khronos finds wrong with a file."""
    found = subprocess.run(
        ["node", "-e", VALIDATE, str(path)],
        cwd=modules,
        check=True,
        capture_output=True,
        text=True,
    )
    messages = json.loads(found.stdout)["messages"]
    return [f"{m['code']} {m['pointer']}: {m['message']}" for m in messages if m["severity"] == 0]


def keep(result: dict[str, Any], out: Path) -> None:
    """Write the pictures of a model."""
    for number, view in enumerate(result["views"]):
        for when in ("before", "after"):
            picture = base64.b64decode(view[when].split(",")[1])
            (out / f"{result['name']}.{number}.{when}.png").write_bytes(picture)


def main() -> None:
    """Compare."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--modules", type=Path, required=True)
    parser.add_argument("--out", type=Path)
    parser.add_argument("models", nargs="*", metavar="MODEL", help=", ".join(MODELS))
    arguments = parser.parse_args()
    browser = shutil.which("chromium")
    if browser is None:
        sys.exit("chromium is missing: install the package of this name")
    bad = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        views = []
        about = {}
        for name in arguments.models or MODELS:
            model = MODELS[name]()
            make(name, model, arguments.program, folder)
            views.append({"name": name, "views": model.views})
            about[name] = model.about
            for error in errors_of(folder / f"{name}.after.glb", arguments.modules):
                bad.append(f"{name}: {error}")
        (folder / "models.json").write_text(json.dumps(views))
        page = Page(folder, arguments.modules / "node_modules" / "three")
        page.draw(browser)
        for result in page.results:
            worst = min(view["psnr"] for view in result["views"])
            print(f"{result['name']:12} {worst:5.1f} dB  {about[result['name']]}")
            if worst < LEAST_PSNR:
                bad.append(f"{result['name']}: {worst:.1f} dB, less than {LEAST_PSNR}")
            if arguments.out:
                arguments.out.mkdir(parents=True, exist_ok=True)
                keep(result, arguments.out)
    if bad:
        sys.exit("\n".join(bad))


if __name__ == "__main__":
    main()
