# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Every script of examples/ runs without arguments, in seconds."""
import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import adasplats

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def run(name, *arguments):
    environment = dict(os.environ, PYTHONPATH=str(Path(adasplats.__file__).parents[1]))
    done = subprocess.run([sys.executable, "-B", EXAMPLES / name, *arguments], timeout=120,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8",
                          env=environment)
    return done.returncode, done.stdout, done.stderr


def test_numpy_cloud_to_scans(tmp_path):
    code, out, errors = run("numpy_cloud_to_scans.py", tmp_path)
    assert (code, errors) == (0, "") and "20 scans" in out
    assert len(list(tmp_path.glob("0000??.npy"))) == 20


def has_only_driven_path_warnings(errors):
    """The street has cars in the driven path; their points are removed with a warning."""
    return errors.count("Warning: ") == errors.count("are in the driven path of the recording vehicle")


def test_sensor_from_csv(tmp_path):
    code, out, errors = run("sensor_from_csv.py")
    assert code == 0 and has_only_driven_path_warnings(errors), errors
    assert "20000 rays in 0.100 s" in out and "road" in out
    rays = tmp_path / "rays.csv"
    rays.write_text("azimuth_deg,elevation_deg\n0,-5\n10,-5\n")
    code, out, errors = run("sensor_from_csv.py", rays)
    assert code == 0 and has_only_driven_path_warnings(errors) and "2 rays" in out, errors


def test_torch_dataset():
    code, out, errors = run("torch_dataset.py")
    if importlib.util.find_spec("torch") is None:
        assert code == 1 and errors.count("\n") == 1 and "python3-torch" in errors
        pytest.skip("PyTorch is not installed")
    assert code == 0, errors
    assert "epoch 1: 32 scans of 16384 points" in out


def test_torch_live_scans():
    code, out, errors = run("torch_live_scans.py")
    if importlib.util.find_spec("torch") is None:
        assert code == 1 and errors.count("\n") == 1 and "python3-torch" in errors
        pytest.skip("PyTorch is not installed")
    assert code == 0, errors
    assert out.startswith("60 batches: ")
    first, last = [int(word[:-1]) for word in out.split() if word.endswith("%")]
    assert last >= first + 10, out  # it learns


def test_code_blocks_of_the_documentation(tmp_path, monkeypatch):
    """The blocks of docs/python.md run, one after the other, in one folder."""
    text = (EXAMPLES.parent / "docs" / "python.md").read_text(encoding="utf-8")
    assert text.count("points=20000") == 1
    text = text.replace("points=20000", "points=8000")  # a shorter street
    blocks = [part.split("```")[0] for part in text.split("```python\n")[1:]]
    assert len(blocks) >= 4
    monkeypatch.chdir(tmp_path)
    program = shutil.which(os.environ.get("ADASPLATS_PROGRAM", "adasplats"))
    monkeypatch.setenv("PATH", str(Path(program).resolve().parent), prepend=os.pathsep)
    names = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)  # noqa: S102
