"""A private JupyterLab or Voila and a real Chromium, for test_browser.py and benchmark_browser.py."""

import contextlib
import json
import os
import shutil
import socket
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

from folders import writable_copy
from playwright.sync_api import sync_playwright

REPO = Path(__file__).parents[1]
CHROMIUM = os.environ.get("RDK_CHROMIUM") or next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = ("--no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
         "--disable-component-update --disable-sync").split()
WIDTH, HEIGHT = 1280, 800
RUN_ALL = """async () => { const panel = window.jupyterapp.shell.currentWidget; await panel.sessionContext.ready;
    await window.jupyterapp.commands.execute('notebook:run-all-cells') }"""
READY = """() => { const panel = window.jupyterapp?.shell?.currentWidget;
    return panel?.context?.isReady && panel?.sessionContext?.session?.kernel?.status === 'idle' }"""


@contextlib.contextmanager
def chromium():
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, headless=True, args=FLAGS)
        yield browser
        browser.close()


def new_page(browser):
    """A page of its own session; `page.problems` collects script errors."""
    page = browser.new_context(viewport={"width": WIDTH, "height": HEIGHT}, reduced_motion="reduce").new_page()
    page.set_default_timeout(60_000)
    page.problems = []
    # JupyterLab's own complaint about a kernel that is stopped before it has answered, as these tests stop some
    page.on("pageerror", lambda error: "Canceled future" in str(error) or page.problems.append(str(error)))
    local = "127.0.0.1", "localhost"
    page.route("**/*", lambda route: route.continue_() if route.request.url.split(":")[0] in ("blob", "data")
               or any(f"//{host}" in route.request.url for host in local) else route.abort())
    return page


@contextlib.contextmanager
def served(command, folder, answers):
    """A server process whose home is `folder`; waits until `answers()` gives something, and stops it at the end."""
    env = dict(os.environ, JUPYTER_CONFIG_DIR=str(folder / "config"), JUPYTER_RUNTIME_DIR=str(folder / "runtime"),
               JUPYTERLAB_SETTINGS_DIR=str(folder / "settings"), JUPYTERLAB_WORKSPACES_DIR=str(folder / "spaces"),
               IPYTHONDIR=str(folder / "ipython"), MPLCONFIGDIR=str(folder / "matplotlib"))
    log = folder / "server.log"
    with log.open("w") as file:
        process = subprocess.Popen([sys.executable, "-m", *command], env=env, stdout=file, stderr=file)
        try:
            for _ in range(300):
                if (found := answers()) is not None:
                    break
                if process.poll() is not None:
                    raise RuntimeError(log.read_text())
                time.sleep(0.2)
            else:
                raise TimeoutError(log.read_text())
            yield found
        finally:
            process.terminate()                          # the server shuts its kernels down itself
            try:
                process.wait(15)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def lab(folder):
    """JupyterLab on a copy of the notebooks; gives its address and token."""
    root = folder / "root"
    writable_copy(REPO / "notebooks", root / "notebooks")
    for name, settings in {"apputils-extension/notification": {"fetchNews": "false", "checkForUpdates": False},
                           "notebook-extension/tracker": {"windowingMode": "none"}}.items():
        path = folder / "settings/@jupyterlab" / f"{name}.jupyterlab-settings"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(settings))

    def answers():
        for path in (folder / "runtime").glob("jpserver-*.json"):        # the server writes address and token here
            with contextlib.suppress(OSError, ValueError):
                known = json.loads(path.read_text())
                urllib.request.urlopen(known["url"] + "api", timeout=2)
                return known["url"], known["token"]

    return served(["jupyterlab", "--no-browser", "--allow-root", "--port=0", "--ip=127.0.0.1",
                   "--expose-app-in-browser", f"--ServerApp.root_dir={root}"], folder, answers)


def voila(folder, notebook):
    """Voila serving one notebook as an app; gives its address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]

    def answers():
        with contextlib.suppress(OSError):
            socket.create_connection(("127.0.0.1", port), 1).close()
            return f"http://127.0.0.1:{port}/"

    return served(["voila", "--no-browser", f"--port={port}", str(REPO / "notebooks" / notebook)], folder, answers)


def run_all(page, lab, notebook):
    """Open a notebook of the copy and run all its cells; returns when the last one has ended."""
    url, token = lab
    page.goto(f"{url}lab/tree/notebooks/{notebook}?token={token}&reset")
    page.wait_for_function(READY)
    page.evaluate(RUN_ALL)
