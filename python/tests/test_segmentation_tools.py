# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""tools/segmentation: from a labelled recording to a network file that the program runs."""
import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import run_program

import adasplats

TOOLS = Path(__file__).resolve().parents[2] / "tools" / "segmentation"
sys.path.insert(0, str(TOOLS))
TINY = {"cell_m": 0.2, "levels": 3, "radius": 2.5, "sigma": 1.2, "kernel": 15, "neighbors": 24,
        "height_unit_m": 4.0, "widths": [16, 24, 32],
        "features": ["one", "height", "intensity", "has_intensity"]}


def needs_products():
    try:
        adasplats.Network().logits(np.zeros((1, 3)), np.zeros((1, 4)))
    except adasplats.UnavailableError:
        pytest.skip("built without OpenBLAS")


def needs_torch():
    if importlib.util.find_spec("torch") is None:
        pytest.skip("PyTorch is not installed")


def tool(name, *arguments, code=0):
    """Runs a script; returns its exit code and output."""
    path = os.pathsep.join([str(Path(adasplats.__file__).parent.parent),
                            os.environ.get("PYTHONPATH", "")])
    result = subprocess.run([sys.executable, "-B", TOOLS / name, *map(str, arguments)],
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8",
                            timeout=250, env={**os.environ, "PYTHONPATH": path})
    assert result.returncode == code, result.stdout
    return result.stdout


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    folder = tmp_path_factory.mktemp("world") / "world"
    run_program("synth", "world", "-o", folder, "--scans", 2, "--length", 80, "--sensor",
                "velodyne-vlp-16")
    return folder / "sequences" / "00"


def random_network(classes, seed=1):
    """Random weights, normalisations as after training."""
    import torch
    from network import Network
    torch.manual_seed(seed)
    network = Network(TINY, len(classes))
    for module in network.modules():
        if isinstance(module, torch.nn.BatchNorm1d):
            torch.nn.init.uniform_(module.running_mean, -0.2, 0.2)
            torch.nn.init.uniform_(module.running_var, 0.5, 2)
            torch.nn.init.uniform_(module.weight, 0.5, 1.5)
            torch.nn.init.uniform_(module.bias, -0.2, 0.2)
    return network.eval()


def saved(network, classes, file):
    import torch
    torch.save({"shape": network.shape, "classes": classes, "network": network.state_dict()}, file)
    return file


def test_default_network():
    network = adasplats.Network()
    assert len(network.classes) == 19 and network.card
    assert network.cell_m == pytest.approx(0.1)
    with pytest.raises(FileNotFoundError):
        adasplats.Network("none.network")
    with pytest.raises(ValueError, match="features: 2 rows, 1 points"):
        network.logits(np.zeros((1, 3)), np.zeros((2, 4)))
    with pytest.raises(ValueError, match="points"):
        network.logits(np.full((1, 3), np.nan), np.zeros((1, 4)))


def test_the_program_gives_the_logits_of_pytorch(tmp_path):
    needs_torch()
    needs_products()
    from export import check, write_network
    classes = ["road", "car", "pole", "kerb"]
    network = random_network(classes)
    write_network(network, classes, "random", tmp_path / "a.network")
    apart, rounded = check(tmp_path / "a.network", network)
    assert apart <= 1e-3
    assert rounded <= 2e-2  # weights have 11 bits
    read = adasplats.Network(tmp_path / "a.network")
    assert read.classes == classes and read.card == "random"


def test_failing_checks_are_reported(tmp_path, monkeypatch):
    needs_torch()
    needs_products()
    import export
    file = saved(random_network(["road"]), ["road"], tmp_path / "a.pt")
    monkeypatch.setattr(sys, "argv", ["export.py", str(file), str(tmp_path / "a.network")])
    monkeypatch.setattr(export, "MAX_DIFFERENCE", -1.0)
    with pytest.raises(SystemExit, match="from PyTorch's"):
        export.main()


def test_places_of_labelled_recordings(tmp_path, world):
    tool("prepare.py", tmp_path / "a.npz", world)
    place = np.load(tmp_path / "a.npz")
    count = len(place["positions"])
    assert count > 1000
    assert place["positions"].shape == (count, 3) and place["positions"].dtype == np.int16
    assert all(len(place[key]) == count for key in ("intensities", "rings", "scans", "classes"))
    assert len(place["names"]) == 19
    assert set(place["scans"]) == {0, 1}


MAP = "street = 40 44 60  # road, parking, lane markings\nwall = 50 building\nunlabeled = 0\nunknown = 7\n"


def test_places_of_own_classes(tmp_path, world):
    own = tmp_path / "map.txt"
    own.write_text(MAP)
    tool("prepare.py", tmp_path / "a.npz", world)
    tool("prepare.py", tmp_path / "b.npz", world, "--class-map", own)
    a, b = np.load(tmp_path / "a.npz"), np.load(tmp_path / "b.npz")
    assert b["names"].tolist() == ["street", "wall"]
    names = a["names"][np.minimum(a["classes"], 18)]
    known = a["classes"] != 255
    assert np.array_equal(b["classes"] == 0, known & np.isin(names, ["road", "parking"]))
    assert np.array_equal(b["classes"] == 1, known & (names == "building"))
    own.write_text("road = 40\ncar = 10\n")  # SemanticKITTI's, so the list is, too
    tool("prepare.py", tmp_path / "c.npz", world, "--class-map", own)
    assert np.array_equal(np.load(tmp_path / "c.npz")["names"], a["names"])


@pytest.mark.parametrize("text, message", [
    ("street 40\n", "map.txt:1: expected CLASS = NUMBER"),
    ("\nstreet = wall\n", "map.txt:2: expected numbers"),
    ("street = 70000\n", "map.txt:1: expected numbers"),
    ("street = 40\nstreet = 41\n", "map.txt:2: 'street' for the second time"),
    ("street = 40\nlane = 40\n", "number 40 is 'street' and 'lane'"),
    ("unknown = 3\n", "0 classes"),
])
def test_wrong_class_maps(tmp_path, text, message):
    own = tmp_path / "map.txt"
    own.write_text(text)
    out = tool("prepare.py", tmp_path / "a.npz", tmp_path, "--class-map", own, code=1)
    assert message in out and "Traceback" not in out


def test_fine_tuning_in_one_command(tmp_path, world):
    needs_torch()
    needs_products()
    import torch
    own = tmp_path / "map.txt"
    own.write_text(MAP)
    tool("prepare.py", tmp_path / "a.npz", world, "--class-map", own)
    trained = random_network(["road", "car", "pole"])
    start = saved(trained, ["road", "car", "pole"], tmp_path / "start.pt")
    out = tmp_path / "out"
    said = tool("train.py", out, tmp_path / "a.npz", "--from", start, "--steps", 2, "--test",
                tmp_path / "a.npz")
    assert "a new head for 2 classes" in said and "groups" not in said
    tuned = torch.load(out / "network.pt")
    assert list(tuned["classes"]) == ["street", "wall"]
    assert tuned["shape"] == TINY
    assert tuned["network"]["head.weight"].shape[0] == 2
    ways = (tuned["network"]["stem.weight"] - trained.state_dict()["stem.weight"]).abs().max()
    assert 0 < ways < 0.1
    tool("export.py", out / "network.pt", tmp_path / "own.network")
    labelled = tmp_path / "labelled"
    run_program("segment", world, "-o", labelled, "--network", tmp_path / "own.network",
                "--class-map", own)
    manifest = json.loads((labelled / "adasplats.json").read_text())
    assert [c["id"] for c in manifest["classes"]] == [40, 50]
    tool("prepare.py", tmp_path / "b.npz", world)
    assert "different classes in" in tool("train.py", tmp_path / "no", tmp_path / "a.npz",
                                      tmp_path / "b.npz", code=1)
