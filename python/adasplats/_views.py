# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The type of arrays over memory of the library."""
import numpy as np

# NumPy exports the read-only flag (DLPack 1.0) from this version on.
_HAS_READONLY_FLAG = tuple(int(part) for part in np.__version__.split(".")[:2]) >= (2, 1)


class ArrayView(np.ndarray):
    """A read-only NumPy array over memory of adasplats, which it keeps alive.

    DLPack exports: a consumer of DLPack 1.0 gets the read-only flag (with NumPy 2.1 or later); any
    other one gets a copy, or BufferError if it forbids copies. NumPy before 2.1 cannot export
    read-only arrays. Results of computations are plain arrays.
    """

    def __dlpack__(self, **options):
        version = options.get("max_version")
        shares_memory = _HAS_READONLY_FLAG and version is not None and version[0] >= 1
        if self.flags.writeable or shares_memory:
            return super().__dlpack__(**options)
        if options.pop("copy", None) is False:
            raise BufferError("a read-only array cannot be shared with a library without "
                              "DLPack 1.0's read-only flag: hand over array.copy()")
        options.pop("max_version", None)
        return np.array(self).__dlpack__(**options)

    def __array_wrap__(self, array, context=None, return_scalar=False):
        plain = np.asarray(array)
        return plain[()] if plain.ndim == 0 else plain

    def __reduce__(self):
        return self.view(np.ndarray).__reduce__()

    def __reduce_ex__(self, protocol):
        return self.view(np.ndarray).__reduce_ex__(protocol)
