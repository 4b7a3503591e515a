# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""kernels.cu, built by nvcc when it is first needed, and the gradients that PyTorch asks for.
Without a GPU or nvcc, or with ADASPLATS_PLAIN_TRAINING set, available() is false and the callers
use PyTorch's own operations."""
import ctypes
import functools
import math
import os
import pathlib
import shutil
import subprocess
import tempfile

import torch

KERNEL_POINTS = 15  # as kernels.cu has them
MOST_SLOTS = 32


class _Grid(ctypes.Structure):
    _fields_ = [("low", ctypes.c_float * 3), ("radius", ctypes.c_float),
                ("size_y", ctypes.c_int64), ("size_z", ctypes.c_int64)]


class _Reach(ctypes.Structure):
    _fields_ = [("queries", ctypes.c_void_p), ("supports", ctypes.c_void_p),
                ("table", ctypes.c_void_p), ("kernel", ctypes.c_void_p),
                ("count", ctypes.c_int64), ("supports_count", ctypes.c_int64),
                ("slots", ctypes.c_int), ("sigma", ctypes.c_float)]


@functools.lru_cache(maxsize=None)
def _library():
    nvcc = shutil.which("nvcc") or "/usr/local/cuda/bin/nvcc"
    if os.environ.get("ADASPLATS_PLAIN_TRAINING") or not torch.cuda.is_available() or not pathlib.Path(
            nvcc).exists():
        return None
    built = pathlib.Path(tempfile.mkdtemp(prefix="adasplats-kernels-")) / "kernels.so"
    major, minor = torch.cuda.get_device_capability()
    subprocess.run([nvcc, f"-arch=sm_{major}{minor}", "-O3", "-Xcompiler", "-fPIC", "-shared",
                    pathlib.Path(__file__).with_name("kernels.cu"), "-o", built], check=True)
    return ctypes.CDLL(str(built))


def available(tensor):
    """Whether what is asked of `tensor` can be done here."""
    return tensor.is_cuda and _library() is not None


def _pointer(tensor):
    assert tensor.is_cuda and tensor.is_contiguous()
    return ctypes.c_void_p(tensor.data_ptr())


def _stream():
    return ctypes.c_void_p(torch.cuda.current_stream().cuda_stream)


def _check(status):
    if status != 0:
        raise RuntimeError(f"kernels.cu: CUDA error {status}")


def neighbors_of(queries, supports, radius_m, most, cell_m):
    """(N, most) indices, 32 bits, of the nearest supports within the radius; len(supports): none.
    Supports: at most one in a cube of `cell_m`."""
    low = torch.minimum(queries.min(0).values, supports.min(0).values) - radius_m
    high = torch.maximum(queries.max(0).values, supports.max(0).values)
    sizes = (torch.floor((high - low) / radius_m).long() + 3).tolist()
    grid = _Grid((ctypes.c_float * 3)(*low.tolist()), radius_m, sizes[1], sizes[2])
    queries, supports = queries.contiguous(), supports.contiguous()
    keys = torch.empty(len(supports), dtype=torch.int64, device=supports.device)
    _check(_library().adasplats_keys(_pointer(supports), ctypes.c_int64(len(supports)),
                                     ctypes.byref(grid), _pointer(keys), _stream()))
    keys, order = torch.sort(keys)
    # Cubes that a ball touches have their middles within its radius and half a diagonal.
    reach = radius_m / cell_m + math.sqrt(3) / 2
    capacity = math.ceil(4 / 3 * math.pi * (reach + math.sqrt(3) / 2)**3)
    table = torch.empty(len(queries), most, dtype=torch.int32, device=queries.device)
    _check(_library().adasplats_neighbors(
        _pointer(queries), ctypes.c_int64(len(queries)), _pointer(supports), _pointer(keys),
        _pointer(order), ctypes.c_int64(len(supports)), ctypes.byref(grid), most, capacity,
        _pointer(table), _stream()))
    return table


def _is_bf16(values):
    assert values.dtype in (torch.bfloat16, torch.float32)
    return int(values.dtype == torch.bfloat16)


def _reach_of(reach):
    assert reach.table.dtype == torch.int32 and reach.table.shape[1] <= MOST_SLOTS
    assert reach.kernel.shape == (KERNEL_POINTS, 3)
    return _Reach(_pointer(reach.queries), _pointer(reach.supports), _pointer(reach.table),
                  _pointer(reach.kernel), len(reach.queries), len(reach.supports),
                  reach.table.shape[1], reach.sigma_m)


class Weighted(torch.autograd.Function):
    """(N, 15 * C): what every kernel point takes of the neighbours' values (M, C)."""

    @staticmethod
    def forward(context, values, reach):
        context.reach, context.shape = reach, values.shape
        values = values.contiguous()
        channels = values.shape[1]
        out = torch.empty(len(reach.queries), KERNEL_POINTS * channels, dtype=values.dtype,
                          device=values.device)
        _check(_library().adasplats_weighted(ctypes.byref(_reach_of(reach)), _pointer(values),
                                             channels, _is_bf16(values), _pointer(out), _stream()))
        return out

    @staticmethod
    def backward(context, gradient):
        gradient = gradient.contiguous()
        sums = torch.zeros(context.shape, device=gradient.device)
        _check(_library().adasplats_weighted_back(
            ctypes.byref(_reach_of(context.reach)), _pointer(gradient), context.shape[1],
            _is_bf16(gradient), _pointer(sums), _stream()))
        return sums.to(gradient.dtype), None


def _scatter(indices, gradient, rows, of_rows):
    gradient = gradient.contiguous()
    sums = torch.zeros(rows, gradient.shape[1], device=gradient.device)
    _check(_library().adasplats_scatter(
        _pointer(indices), ctypes.c_int64(len(gradient)), gradient.shape[1], of_rows,
        _pointer(gradient), _is_bf16(gradient), _pointer(sums), _stream()))
    return sums.to(gradient.dtype)


class Largest(torch.autograd.Function):
    """(N, C): the largest values of the neighbours; what is missing counts as zero."""

    @staticmethod
    def forward(context, values, table):
        values = values.contiguous()
        out = torch.empty(len(table), values.shape[1], dtype=values.dtype, device=values.device)
        indices = torch.empty(out.shape, dtype=torch.int32, device=values.device)
        _check(_library().adasplats_largest(
            _pointer(table), ctypes.c_int64(len(table)), ctypes.c_int64(len(values)),
            table.shape[1], _pointer(values), values.shape[1], _is_bf16(values), _pointer(out),
            _pointer(indices), _stream()))
        context.save_for_backward(indices)
        context.rows = len(values)
        return out

    @staticmethod
    def backward(context, gradient):
        return _scatter(context.saved_tensors[0], gradient, context.rows, 0), None


class Rows(torch.autograd.Function):
    """values[indices]; every index is one of a row."""

    @staticmethod
    def forward(context, values, indices):
        context.save_for_backward(indices)
        context.rows = len(values)
        return values.index_select(0, indices)

    @staticmethod
    def backward(context, gradient):
        return _scatter(context.saved_tensors[0], gradient, context.rows, 1), None
