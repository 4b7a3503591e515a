# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Classes of networks: the 19 of SemanticKITTI's single-scan benchmark, or your own."""
import numpy as np

NAMES = ["car", "bicycle", "motorcycle", "truck", "other-vehicle", "person", "bicyclist",
         "motorcyclist", "road", "parking", "sidewalk", "other-ground", "building", "fence",
         "vegetation", "trunk", "terrain", "pole", "traffic-sign"]
IGNORED = 255

# learning_map of semantic-kitti.yaml (Behley et al. 2019); other labels are ignored.
_SEMANTICKITTI = {
    "car": [10, 252], "bicycle": [11], "motorcycle": [15], "truck": [18, 258],
    "other-vehicle": [13, 16, 20, 256, 257, 259], "person": [30, 254], "bicyclist": [31, 253],
    "motorcyclist": [32, 255], "road": [40, 60], "parking": [44], "sidewalk": [48],
    "other-ground": [49], "building": [50], "fence": [51], "vegetation": [70], "trunk": [71],
    "terrain": [72], "pole": [80], "traffic-sign": [81]}

# PandaSet's classes (its classes.csv) mapped to the closest class. Its vegetation includes trunks, its
# ground everything except road and sidewalk; 'other static object', which includes poles, is ignored.
_PANDASET = {
    "car": [13, 14, 22], "bicycle": [26], "motorcycle": [18, 25], "truck": [15, 16],
    "other-vehicle": [17, 19, 20, 21, 23, 27, 28, 29], "person": [30, 31],
    "road": [7, 8, 9, 10], "parking": [12], "sidewalk": [11], "terrain": [6], "building": [41],
    "fence": [35, 39], "vegetation": [5], "traffic-sign": [36, 38]}

# The paper's groups (section "Adaptive Splatting") and movable objects.
GROUPS = {
    "ground": ["road", "parking", "sidewalk", "other-ground", "terrain"],
    "surface": ["building"],
    "linear": ["trunk", "pole", "traffic-sign"],
    "non-surface": ["fence", "vegetation"],
    "movable": ["car", "bicycle", "motorcycle", "truck", "other-vehicle", "person", "bicyclist",
                "motorcyclist"]}


def use(names):
    """Replaces the list of classes."""
    NAMES[:] = names


def group_of(names):
    """Group index of each class; None if a class has no group."""
    groups = [next((g for g, of in enumerate(GROUPS.values()) if name in of), None)
              for name in names]
    return None if None in groups else np.array(groups)


def _table(classes):
    table = np.full(1 << 16, IGNORED, np.uint8)
    for name, ids in classes.items():
        table[ids] = NAMES.index(name)
    return table


TABLES = {"semantickitti": _table(_SEMANTICKITTI), "pandaset": _table(_PANDASET)}
