"""Execute notebooks so that the outputs to commit are the same, byte for byte, in every run.

Usage, from anywhere: python notebooks/execute.py [01_wheel_on_soil.ipynb ...]    (no name: all of them)
"""

import os
import re
import sys
import time
from pathlib import Path

FOLDER = Path(__file__).parent
METADATA = {"kernelspec": {"name": "python3", "display_name": "Python 3 (ipykernel)", "language": "python"},
            "language_info": {"name": "python", "file_extension": ".py"}}  # no patch version, no widget state


def execute(path):
    """Run every cell of the notebook at `path` in a fresh kernel, then write it back without what varies."""
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    client = NotebookClient(notebook, kernel_name="python3", timeout=600, record_timing=False,
                            coalesce_streams=True, store_widget_state=False,
                            resources={"metadata": {"path": str(FOLDER)}})
    client.execute()
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            output.get("data", {}).pop("application/vnd.jupyter.widget-view+json", None)  # a random model id
    describe_pictures(notebook)
    notebook.metadata = METADATA
    nbformat.write(notebook, path)


def describe_pictures(notebook):
    """Give each picture an alternative text: a live picture's own sentence, or the first one after "What to see"."""
    for cell, following in zip(notebook.cells, notebook.cells[1:]):
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            if "image/png" in data:
                words = data.get("text/plain", "")       # of a live picture: its sentence
                if words.startswith(("<Figure", "<matplotlib")):
                    text = re.sub(r"^\*What to see[^*]*\*\s*", "", following.source).partition("\n\n")[0]
                    text = re.sub(r"\[([^\]]*)\]\([^)]*\)|[*`$\\]", r"\1", text)
                    words = re.split(r"(?<=[a-z0-9)°%])\. ", text)[0].rstrip(".") + "."
                output.metadata = {"image/png": {"alt": words[:1].upper() + words[1:]}}


if __name__ == "__main__":
    os.environ["PYTHONHASHSEED"] = "0"  # the kernels inherit it: sets print in the same order
    names = sys.argv[1:] or sorted(p.name for p in FOLDER.glob("[0-9][0-9]_*.ipynb"))
    for name in names:
        start = time.perf_counter()
        execute(FOLDER / Path(name).name)
        print(f"{Path(name).name}: {time.perf_counter() - start:.1f} s")
