# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""GPU results equal those of the CPU bit for bit and can stay in GPU memory."""
import ctypes
import ctypes.util
import gc

import numpy as np
import pytest
from conftest import unit_rays

import adasplats

pytestmark = pytest.mark.skipif(not adasplats.devices(), reason="no GPU: " + adasplats.why_no_gpu())


@pytest.fixture(scope="module")
def gpu_scene(street):
    scene = adasplats.Scene(street.model, device="cuda")
    assert scene.device.startswith("cuda")
    return scene


def from_gpu(pointer, count):
    """32-bit words at a GPU address, read through the driver, without a CUDA library."""
    driver = ctypes.CDLL(ctypes.util.find_library("cuda") or "libcuda.so.1")
    context = ctypes.c_void_p()
    assert driver.cuInit(0) == 0
    assert driver.cuDevicePrimaryCtxRetain(ctypes.byref(context), 0) == 0
    assert driver.cuCtxPushCurrent_v2(context) == 0
    words = np.empty(count, np.uint32)
    try:
        copied = driver.cuMemcpyDtoH_v2(ctypes.c_void_p(words.ctypes.data),
                                        ctypes.c_uint64(pointer), ctypes.c_size_t(words.nbytes))
        assert copied == 0
    finally:
        driver.cuCtxPopCurrent_v2(ctypes.byref(context))
        driver.cuDevicePrimaryCtxRelease_v2(0)
    return words


def test_the_same_hits(scene, gpu_scene):
    rays = unit_rays(200_000)
    for depth in (1, 3):
        a, b = (s.cast([5.0, 0, 2], rays, depth=depth) for s in (scene, gpu_scene))
        np.testing.assert_array_equal(a.ranges, b.ranges)
        np.testing.assert_array_equal(a.primitives, b.primitives)


def test_the_same_scans(scene, gpu_scene, poses):
    many = poses.resampled(rate_hz=20)
    for a, b in zip(scene.simulate("hdl-64-paper", many), gpu_scene.simulate("hdl-64-paper", many)):
        np.testing.assert_array_equal(a.positions, b.positions)
        np.testing.assert_array_equal(a.classes, b.classes)
    assert len(list(gpu_scene.iter_scans("hdl-64-paper", many))) == len(many)


def test_the_same_pictures_and_layers(scene, gpu_scene, poses):
    camera = adasplats.Camera.from_matrix([[500, 0, 310], [0, 505, 238], [0, 0, 1]], 640, 480,
                                          model="plumb_bob",
                                          coefficients=[-0.3, 0.1, 0.001, -0.002, 0])
    view = {"camera": camera, "trajectory": poses}
    np.testing.assert_array_equal(scene.render(**view), gpu_scene.render(**view))
    layers, on_gpu = scene.layers(**view), gpu_scene.layers(**view)
    assert list(layers) == list(on_gpu)
    for name in layers:
        np.testing.assert_array_equal(layers[name], on_gpu[name])


@pytest.mark.parametrize("method", ["consistent", "semantic"])
def test_the_same_model(street, method):
    gpu, cpu = (adasplats.model(street.cloud, labels="semantickitti", method=method, device=device)
                for device in ("cuda", "cpu"))
    assert len(cpu) > 100
    for name in ("centers", "normals", "radii", "classes", "groups", "intensities"):
        np.testing.assert_array_equal(getattr(gpu, name), getattr(cpu, name), err_msg=name)


class Tensor(ctypes.Structure):
    """DLManagedTensor of the DLPack specification, version 0.x."""

    _fields_ = [("data", ctypes.c_void_p), ("device_type", ctypes.c_int32),
                ("device_id", ctypes.c_int32), ("ndim", ctypes.c_int32), ("code", ctypes.c_uint8),
                ("bits", ctypes.c_uint8), ("lanes", ctypes.c_uint16),
                ("shape", ctypes.POINTER(ctypes.c_int64)),
                ("strides", ctypes.POINTER(ctypes.c_int64)), ("byte_offset", ctypes.c_uint64),
                ("manager", ctypes.c_void_p), ("deleter", ctypes.CFUNCTYPE(None, ctypes.c_void_p))]


def taken(array):
    """Takes the tensor out of the capsule of __dlpack__, as a consumer does."""
    api = ctypes.pythonapi
    api.PyCapsule_GetPointer.restype = ctypes.c_void_p
    api.PyCapsule_GetPointer.argtypes = [ctypes.py_object, ctypes.c_char_p]
    api.PyCapsule_SetName.argtypes = [ctypes.py_object, ctypes.c_char_p]
    capsule = array.__dlpack__(stream=None)
    address = api.PyCapsule_GetPointer(capsule, b"dltensor")
    name = ctypes.create_string_buffer(b"used_dltensor")
    api.PyCapsule_SetName(capsule, name)
    return Tensor.from_address(address), address, (capsule, name)


@pytest.mark.parametrize("depth", [1, 3])
def test_hits_that_stay_on_the_gpu(scene, gpu_scene, poses, depth):
    sensor = adasplats.Sensor("hdl-32-paper")
    hits = gpu_scene.cast_on_device(sensor, poses, depth=depth)
    shape = (len(poses), sensor.rays_per_scan) + ((depth,) if depth > 1 else ())
    assert hits.ranges.shape == hits.primitives.shape == shape
    assert hits.ranges.__dlpack_device__() == (2, adasplats.devices()[0]["index"])
    ranges, primitives = hits.ranges, hits.primitives
    del hits
    gc.collect()
    tensor, address, kept = taken(ranges)
    assert (tensor.device_type, tensor.code, tensor.bits, tensor.lanes) == (2, 2, 32, 1)
    assert tuple(tensor.shape[:tensor.ndim]) == shape
    steps = (np.cumprod((2,) + shape[:0:-1])[::-1]).tolist()
    assert tensor.strides[:tensor.ndim] == steps
    assert primitives.pointer == ranges.pointer + 4
    words = from_gpu(tensor.data + tensor.byte_offset, 2 * int(np.prod(shape))).reshape(*shape, 2)
    # Oracle: the same rays on the CPU. With depth 1 these are the scans, bit for bit; poses of other
    # rays are rounded once in the library, here in NumPy.
    if depth == 1:
        scan = scene.simulate(sensor, poses[:1], noise=False)[0]
        number = scan.rings.astype(int) * sensor.columns + scan.columns
        np.testing.assert_array_equal(words[0][number, 0].view(np.float32), scan.ranges)
    firings, pose = sensor.firings(), poses.poses[0]
    rays = (values @ pose[:3, :3].T for values in (firings.origins, firings.directions))
    expected = scene.cast(next(rays) + pose[:3, 3], next(rays), depth=depth)
    close = np.isclose(words[0][..., 0].view(np.float32), expected.ranges, rtol=0, atol=1e-3,
                       equal_nan=True)
    assert close.mean() > 0.999
    assert (words[0][..., 1] == expected.primitives).mean() > 0.999
    assert (expected.primitives != adasplats.NO_PRIMITIVE).sum() > len(firings) // 2
    tensor.deleter(address)
    del kept


def test_unused_capsules_are_freed(gpu_scene, poses):
    hits = gpu_scene.cast_on_device("hdl-32-paper", poses)
    for _ in range(100):
        hits.ranges.__dlpack__()
    del hits
    gc.collect()


def test_torch_reads_device_arrays(gpu_scene, poses):
    torch = pytest.importorskip("torch")
    if not torch.cuda.is_available():
        pytest.skip("PyTorch has no CUDA")
    hits = gpu_scene.cast_on_device("hdl-32-paper", poses)
    ranges = torch.from_dlpack(hits.ranges)
    assert ranges.is_cuda and ranges.data_ptr() == hits.ranges.pointer
