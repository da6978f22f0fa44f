"""Copies of the project's folders to write in, whatever the clone's modes."""

import shutil
import stat
from pathlib import Path


def writable_copy(source, target):
    """A copy of a folder, without caches; read-only files and folders become writable."""
    shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__", ".ipynb_checkpoints"))
    for path in (Path(target), *Path(target).rglob("*")):
        path.chmod(path.stat().st_mode | stat.S_IWUSR)
