# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Metrics of models and scans: dicts with the keys of 'adasplats evaluate --report'."""
from ._adasplats.evaluate import (c2c, echoes, labels, presence, realism, resimulate,
                                  segmentation, truth, unit)

__all__ = ["c2c", "echoes", "labels", "presence", "realism", "resimulate", "segmentation",
           "truth", "unit"]
